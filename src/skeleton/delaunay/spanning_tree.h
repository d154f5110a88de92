// The initial skeleton: a tree over the edges of the triangulation.
#pragma once

#include <cstdint>

#include "skeleton/geodesics/paths.h"
#include "skeleton/skeleton.h"

namespace treerec {

// kMinimum: the tree of the least sum of edge lengths (Prim 1957, from the root). kShortestPaths: Dijkstra's
// (1959) from the root, where an edge costs the square of its length, so that a path goes from point to point
// along the wood; by plain lengths it would take the triangulation's long edges through the air of the crown.
// Ties are broken by vertex number. graph: connected.
PathTree spanning_tree(const PointGraph& graph, uint32_t root, SpanningTreeKind kind, Progress& progress);

}  // namespace treerec
