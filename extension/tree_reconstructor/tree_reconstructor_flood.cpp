// What TreeReconstructor tells of a flood.
#include <godot_cpp/variant/packed_float64_array.hpp>
#include <godot_cpp/variant/packed_int32_array.hpp>

#include "convert.h"
#include "tree_reconstructor/tree_reconstructor.h"

using namespace godot;

int64_t TreeReconstructor::get_flood_step_count() const {
    const std::lock_guard lock(mutex_);
    return int64_t(steps_.size());
}

Dictionary TreeReconstructor::get_flood_step(int64_t p_index) const {
    const std::lock_guard lock(mutex_);
    Dictionary told;
    if (p_index < 0 || p_index >= int64_t(steps_.size())) {
        return told;
    }
    const treerec::FloodStep& step = steps_[size_t(p_index)];
    PackedVector3Array voxels;
    for (const treerec::Vec3& voxel : step.voxels) {
        voxels.push_back(Vector3(voxel.x, voxel.y, voxel.z));
    }
    PackedVector3Array directions;
    PackedFloat64Array lengths;
    PackedFloat64Array radii;
    PackedFloat64Array shares;
    PackedInt32Array children;
    for (const treerec::FloodDirection& direction : step.directions) {
        directions.push_back(to_godot(direction.direction));
        lengths.push_back(direction.length);
        radii.push_back(direction.radius);
        shares.push_back(direction.share);
        children.push_back(direction.child);
    }
    told["node"] = step.node;
    told["parent"] = step.parent;
    told["generation"] = step.generation;
    told["position"] = to_godot(step.position);
    told["voxel_size"] = voxel_;
    told["voxels"] = voxels;
    told["directions"] = directions;
    told["lengths"] = lengths;
    told["radii"] = radii;
    told["shares"] = shares;
    told["children"] = children;
    return told;
}
