// The cloud of wood that is thin in the photos, for the rest to be matched pixel by pixel (densify.h).
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "photos/colmap_model.h"
#include "photos/thin_wood.h"
#include "progress.h"
#include "scan/point_cloud.h"

namespace treerec {

struct ThinPoints {
    std::vector<ThinPlace> places;               // on the axes, in the model
    std::vector<std::array<uint8_t, 3>> colors;  // of each
    std::vector<uint8_t> before_sky;  // whether the sky is seen right beside it; empty where nobody knows
    std::vector<std::string> warnings;

    void remove_if(const std::function<bool(const ThinPlace&)>& wrong);
};

// Looks for thin wood between the cameras and the upright line through what was photographed, as subject_of()
// and sky_of() know it; nothing where they know nothing. sparse: the model's own points. folder: of the
// photos. Some 2 s of one core per photo. Throws Cancelled.
ThinPoints find_thin_points(const PhotoModel& model, std::span<const DVec3> sparse, const std::string& folder,
                            const ThinWoodOptions& options = {}, Progress* progress = nullptr);

// Puts thin wood into a cloud, as rings of points on its bark. What has no sky beside it, and is matched
// pixel by pixel all around, is a surface, whose lines are furrows: they are left out. Where thin wood stays,
// the cloud's own points on it, which are as coarse as its cells, go. cell: of the cloud, in its unit. How
// many places were put in.
size_t add_thin_points(PointCloud& cloud, double cell, const ThinPoints& thin,
                       const Progress* progress = nullptr);

}  // namespace treerec
