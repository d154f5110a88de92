// All leaves of a tree as one mesh whose vertices know what a MultiMesh knows per leaf: for whole trees in a
// MultiMesh, and for scenes without one.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "foliage/leaves.h"
#include "mesh/mesh.h"
#include "progress.h"

namespace treerec {

struct JoinedLeaves {
    // In the tree's frame. colors: the way out of the crown (rgb * 2 - 1, unit), occlusion in a. custom0:
    // where the petiole leaves the bark, and the leaf's phase 0..1.
    Mesh mesh;
    // By vertex, in 1/127: the way along the leaf, unit, and the stiffness of its branch; the way across it,
    // and its hue.
    MeshArray<std::array<int8_t, 4>> lengthwise, across;
    // By vertex, halves: WindGroups::codes() of limb and bough.
    MeshArray<std::array<uint16_t, 2>> wind;
};

// The card at every leaf. Empty without leaves. Throws Error for more vertices than an index can count, or
// Cancelled.
JoinedLeaves join_leaves(const std::vector<LeafPlacement>& leaves, const Mesh& card,
                         const Progress* progress = nullptr);

}  // namespace treerec
