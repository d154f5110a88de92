// Tells points of thin wood from points of leaves by how they lie in their neighbourhood.
#pragma once

#include <vector>

#include "progress.h"
#include "skeleton/point_graph.h"

namespace treerec {

// For each point how much its neighbourhood (about 32 points, found along the graph) looks like a line: (l1 -
// l2) / l1 of the covariance's eigenvalues l1 >= l2 >= l3, 0..1 (the linearity of Weinmann et al. 2015). Bare
// twigs lie around 0.6, leaf clusters around 0.35. Bark of a stem is a plane, so this says nothing about
// thick wood.
std::vector<float> neighbourhood_linearity(const std::vector<Vec3>& points, const PointGraph& graph,
                                           Progress& progress);

}  // namespace treerec
