// Links over the gaps that a scan leaves in the wood.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/groups.h"
#include "geometry/point_tree.h"
#include "progress.h"
#include "skeleton/sampling/point_graph.h"

namespace treerec {

// Adds edges until all points are connected. Every part that the edges leave, but the largest, is linked to
// another one, again and again until one part is left (Boruvka's algorithm): not by the shortest edge of all,
// but by one of the shortest that best continues the wood that it comes from, since a branch goes on beyond a
// gap as it did before. tree: over points. groups: who is connected by the edges that there are.
void bridge_parts(const std::vector<Vec3>& points, const PointTree& tree, Groups groups,
                  std::vector<PointEdge>& edges, Progress& progress, PassSet left_out = {});

}  // namespace treerec
