// From photos whose cameras are known to a cloud.
#pragma once

#include <string>
#include <vector>

#include "photos/densify.h"
#include "photos/sky_mask.h"
#include "photos/thin_wood.h"
#include "progress.h"

namespace treerec {

struct MakeCloudOptions {
    size_t least_track = 3;   // photos that saw a point that stays
    double most_error = 2.0;  // pixels: the reprojection error of a point that stays
    size_t hold_out = 0;      // photos/colmap_model.h, held_out(): of these nothing but the cameras is used
    bool dense = true;  // match the photos pixel by pixel (photos/densify.h), else the model's own points
    DensifyOptions densify;
    CarveOptions carve;
    ThinWoodOptions thin_wood;
};

struct MadeCloud {
    size_t points = 0;
    size_t left_out = 0;  // of the model's, that too few photos saw, or that fit these badly
    size_t pairs = 0;  // of photos that were matched pixel by pixel; 0: the cloud has the model's own points
    DVec3 sky{0.0};    // its colour, 0 to 255; zeros where no photo shows it
    size_t thin = 0;   // places of thin wood
    size_t outlines = 0;  // places of wood whose thickness the photos' outlines told (wood_outlines.h)
    bool leafy = false;   // its points are labelled as leaves or wood, likewise
    double cell = 0.0;    // of the dense points, in the model's unit; 0 without
    std::vector<std::string> warnings;
};

// Writes the cloud of a COLMAP model (PLY, with colours, in the model's coordinates) to `out`: dense points,
// or where the photos give none, the model's own. photos: their folder. Throws Error with a sentence, or
// Cancelled.
MadeCloud make_cloud(const std::string& model, const std::string& photos, const std::string& out,
                     const MakeCloudOptions& options, Progress* progress = nullptr);

}  // namespace treerec
