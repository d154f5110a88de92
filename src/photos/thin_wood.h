// Boughs and twigs that are only a few pixels wide: matched as lines over many photos, which is what they are
// against the sky, where matching pixel by pixel finds nothing.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "geometry/vec.h"
#include "photos/colmap_model.h"
#include "photos/ridges.h"
#include "progress.h"
#include "scan/point_cloud.h"

namespace treerec {

struct ThinWoodOptions {
    int most_pixels = 2400;  // of the longer side: larger photos are made smaller
    RidgeOptions ridges;
    size_t neighbours = 8;     // photos that each is compared with
    double least_angle = 2.0;  // degrees between their ways to what they show
    double most_angle = 50.0;
    double tolerance = 1.2;    // pixels between a line and where it should be
    double least_score = 2.2;  // photos that agree, the nearer the more
    size_t least_seen = 3;     // photos beside its own that see a place
    size_t every = 8;  // places of a line, about a pixel apart, from one that is looked for to the next
};

// A place on the axis of thin wood.
struct ThinPlace {
    DVec3 position{0.0};          // in the model
    DVec3 way{0.0};               // along the wood, a unit vector
    double radius = 0.0;          // in the model's unit
    double pixel = 0.0;           // what a pixel of the photo is there
    uint32_t photo = 0;           // index of the model's photo that it was found from
    Color8 color{128, 128, 128};  // there, as find_thin_wood() tells
    bool before_sky = false;      // photos show the sky right beside it (SkyCarver::is_before_sky)
};

// What a photo may see of the tree: from the camera, in its own z.
struct DepthRange {
    double least = 0.0, most = 0.0;
};

// Lines that photos have in common. ridges: of each photo, in the pixels of its picture, `scales` of the
// camera's. range_of: where along a ray (in the photo's own depth) the tree can be; least >= most where it
// can't. Each place is found from one photo, and seen by at least options.least_seen others; neighbours along
// a line are found together, by dynamic programming. The same wood is found from many photos. Throws
// Cancelled.
std::vector<ThinPlace> match_lines(
    const PhotoModel& model, const std::vector<std::vector<std::vector<Ridge>>>& ridges,
    std::span<const double> scales, const DVec3& subject,
    const std::function<DepthRange(const DVec3& from, const DVec3& along)>& range_of,
    const ThinWoodOptions& options, Progress* progress = nullptr);

// One place for each stretch of wood, from those of all photos: their mean across the wood. Places that too
// few photos agree on go.
std::vector<ThinPlace> merged_places(std::span<const ThinPlace> places, Progress* progress = nullptr);

}  // namespace treerec
