// The initial skeleton as a tree of vertices, and how much each of them carries.
#pragma once

#include <cstdint>
#include <vector>

#include "skeleton/delaunay/spanning_tree.h"

namespace treerec {

// By vertex: the points, in their order.
struct InitialSkeleton {
    PathTree tree;
    std::vector<double> weight;  // metres of all edges above it (Du et al. 2019, 3.2: a vertex's importance)
    std::vector<double> reach;   // metres to the farthest tip above it, along the edges

    size_t size() const { return weight.size(); }
};

// Delaunay triangulation, spanning tree, weights. root: the vertex nearest to it is the tree's. Throws as
// delaunay_graph() does.
InitialSkeleton initial_skeleton(const std::vector<Vec3>& points, const DVec3& root, SpanningTreeKind kind,
                                 Progress& progress);

}  // namespace treerec
