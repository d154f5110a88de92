// Gives a cloud that was made of photos what their outlines tell of the wood's thickness.
#pragma once

#include <cstddef>
#include <string>

#include "photos/colmap_model.h"
#include "progress.h"
#include "scan/point_cloud.h"
#include "tree/tree.h"

namespace treerec {

// Sets the radii of the points that lie on wood whose outline the photos agree on (photos/outline_radii.h).
// cloud: in the model's coordinates; tree: a first one made of it, which tells where to look. folder: of the
// photos. How many places of the wood were measured. Throws Cancelled.
size_t measure_outlines(PointCloud& cloud, const Tree& tree, const PhotoModel& model,
                        const std::string& folder, Progress* progress = nullptr);

}  // namespace treerec
