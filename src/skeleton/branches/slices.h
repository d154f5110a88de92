// Cuts the cloud across its branches: the level sets of the distance from the root.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "progress.h"
#include "skeleton/geodesics/paths.h"
#include "skeleton/sampling/point_graph.h"

namespace treerec {

// A slice is a linked group of points at about the same distance along the wood: a ring around a branch, or
// what the scanner saw of it. Slices are numbered so that parents come before children; 0 is the root's.
struct Slices {
    std::vector<int32_t> parent;   // -1 for slice 0 only
    std::vector<DVec3> centre;     // mean of the slice's points
    std::vector<uint8_t> bridged;  // 1 where the way to the parent crosses a gap
    std::vector<uint32_t> begin;   // points of slice s: vertices[begin[s]] .. vertices[begin[s + 1])
    std::vector<uint32_t> vertices;
    // The slices side by side with slice s that are neither its parent nor its child:
    // beside[beside_begin[s]] .. beside[beside_begin[s + 1]).
    std::vector<uint32_t> beside_begin;
    std::vector<uint32_t> beside;

    size_t size() const { return parent.size(); }
    std::span<const uint32_t> points_of(size_t slice) const {
        return {vertices.data() + begin[slice], begin[slice + 1] - begin[slice]};
    }
    std::span<const uint32_t> slices_beside(size_t slice) const {
        return {beside.data() + beside_begin[slice], beside_begin[slice + 1] - beside_begin[slice]};
    }
};

// Merges the vertices of the shortest-path tree that lie side by side (AdTree, Du et al. 2019, 2.3, merges
// them pair by pair; taking whole level sets of the path length, as Verroust and Lazarus 2000 do, needs no
// order and no angle threshold). The thickness of a slice follows the local spacing of the points. A slice
// hangs on the slice that most of its paths come from. root: the tree's base point, the centre of slice 0.
// Throws Cancelled.
Slices cut_slices(const std::vector<Vec3>& points, const PointGraph& graph, const LocalScale& scale,
                  const PathTree& paths, const DVec3& root, const Progress& progress);

}  // namespace treerec
