// All leaves of a tree as one mesh whose vertices know what a MultiMesh knows per leaf: for whole trees in a
// MultiMesh, and for scenes without one.
#pragma once

#include <vector>

#include "foliage/leaves.h"
#include "mesh/mesh.h"
#include "progress.h"

namespace treerec {

struct JoinedLeaves {
    // In the tree's frame. colors: the way out of the crown (rgb * 2 - 1, unit), occlusion in a. custom0:
    // where the petiole leaves the bark, and the leaf's phase 0..1.
    Mesh mesh;
    // By vertex: the way along the leaf, unit, and the wind code of its primary branch (WindGroups::codes());
    // the way across it, unit, and its hue; the wind code of its secondary branch. They are floats, since
    // Godot's Compatibility renderer reads all but the first of four bytes, or the first two of four halves,
    // as (0, 0, 1).
    MeshArray<Vec4> lengthwise, across;
    MeshArray<float> secondary;
};

// The card at every leaf. Empty without leaves. Throws Error for more vertices than an index can count, or
// Cancelled.
JoinedLeaves join_leaves(const std::vector<LeafPlacement>& leaves, const Mesh& card,
                         const Progress* progress = nullptr);

}  // namespace treerec
