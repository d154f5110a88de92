// A scan's points as the engine has them.
#pragma once

#include <cmath>
#include <cstring>
#include <godot_cpp/variant/packed_vector3_array.hpp>

#include "error.h"
#include "scan/point_cloud.h"

// Points in the space of the tree whose frame is given, metres, as a cloud. Throws treerec::Error for one
// that is no finite place.
inline treerec::PointCloud to_cloud(const treerec::ScanFrame& p_frame,
                                    const godot::PackedVector3Array& p_points) {
    treerec::PointCloud cloud;
    cloud.frame = p_frame;
    cloud.positions.resize(size_t(p_points.size()));
    static_assert(sizeof(treerec::Vec3) == sizeof(godot::Vector3));
    if (!p_points.is_empty()) {
        std::memcpy(static_cast<void*>(cloud.positions.data()), p_points.ptr(),
                    cloud.positions.size() * sizeof(godot::Vector3));
    }
    for (const treerec::Vec3& p : cloud.positions) {
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
            throw treerec::Error("The cloud has a point that is nowhere: a coordinate is no finite number.");
        }
    }
    return cloud;
}
