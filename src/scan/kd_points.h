// Points as nanoflann wants them. Internal to scan/.
#pragma once

#include <cstdint>
#include <nanoflann.hpp>
#include <vector>

#include "geometry/vec.h"

namespace treerec {

struct KdPoints {
    const std::vector<Vec3>& points;

    size_t kdtree_get_point_count() const { return points.size(); }
    float kdtree_get_pt(size_t index, size_t axis) const { return points[index][static_cast<int>(axis)]; }
    template <typename Box>
    bool kdtree_get_bbox(Box&) const {
        return false;
    }
};

using KdTree =
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, KdPoints>, KdPoints, 3, uint32_t>;

}  // namespace treerec
