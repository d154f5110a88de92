// Links from the ends of pieces of wood.
#pragma once

#include <vector>

#include "geometry/point_tree.h"
#include "progress.h"
#include "skeleton/sampling/point_graph.h"

namespace treerec {

// A piece of wood that a scan shows between two gaps goes on at both of its ends, but the graph may know one
// of them alone, or neither, only some lone points beside it. Adds, for both ends of every piece that is
// longer than the gap, the link to the other wood that best continues it; which of them is a path's is for
// the path to find out. points: metres. tree: over them. Throws Cancelled.
void link_piece_ends(const std::vector<Vec3>& points, const PointTree& tree, const LocalScale& scale,
                     PointGraph& graph, const Progress& progress);

}  // namespace treerec
