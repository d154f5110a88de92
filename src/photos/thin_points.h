// The cloud of wood that is thin in the photos, for the rest to be matched pixel by pixel (densify.h).
#pragma once

#include <span>
#include <string>
#include <vector>

#include "photos/colmap_model.h"
#include "photos/sky_mask.h"
#include "photos/thin_wood.h"
#include "progress.h"
#include "scan/point_cloud.h"

namespace treerec {

// Looks for thin wood between the cameras and the upright line through what was photographed, as subject_of()
// and sky_of() know it; nothing where they know nothing. sparse: the model's own points. folder: of the
// photos; of those that can't be read, densify() says so. What shows the sky is left out. Some 3 s of one
// core per photo. Throws Cancelled.
std::vector<ThinPlace> find_thin_wood(const PhotoModel& model, std::span<const DVec3> sparse,
                                      const std::string& folder, const SkyCarver& sky,
                                      const ThinWoodOptions& options = {}, Progress* progress = nullptr);

// Puts thin wood into a cloud with colours, as rings of points on its bark. What has no sky beside it, and is
// matched pixel by pixel all around, is a surface, whose lines are furrows: they are left out. Where thin
// wood stays, the cloud's own points on it, which are as coarse as its cells, go. cell: of the cloud, in its
// unit. How many places were put in.
size_t add_thin_wood(PointCloud& cloud, double cell, std::vector<ThinPlace> places,
                     const Progress* progress = nullptr);

}  // namespace treerec
