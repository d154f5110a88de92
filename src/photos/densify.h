// A dense cloud from photos whose cameras are known, without a graphics card: semi-global matching of
// neighbouring photos, and what several pairs agree on.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "photos/colmap_model.h"
#include "progress.h"
#include "scan/point_cloud.h"

namespace treerec {

struct DensifyOptions {
    double megapixels = 0.27;  // photos are made smaller to about so many
    int neighbours = 4;        // each photo is matched with, at least
    int agreeing = 3;          // pairs see a point that stays
    double cell = 0.0;         // in the model's unit: one point in each; 0: two of the pictures' pixels
};

struct Densified {
    PointCloud cloud;   // in the model's axes and unit, with colours
    size_t photos = 0;  // that were used
    size_t pairs = 0;
    double cell = 0.0;  // that was used
    std::vector<std::string> warnings;
};

// sparse: the model's own points, which tell how far away things are. folder: of the photos, by their names
// in the model. Only what lies nearer to what was photographed than the cameras do is kept, where the photos
// were taken around it (subject_of). Some 0.5 s of one core per pair. Throws Error where no two photos can be
// matched, or Cancelled; a photo that can't be read is a warning.
Densified densify(const PhotoModel& model, std::span<const DVec3> sparse, const std::string& folder,
                  const DensifyOptions& options, Progress* progress = nullptr);

}  // namespace treerec
