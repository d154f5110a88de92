// The graph that AdTree starts from: which points the Delaunay triangulation links.
#pragma once

#include <vector>

#include "progress.h"
#include "skeleton/sampling/point_graph.h"

namespace treerec {

// The edges of the Delaunay triangulation in space (CGAL), with their lengths in metres (Chen 2025, 2.2.2,
// step 1; Du et al. 2019, 3.1). It is connected, and the same whatever the order of the points: of points on
// one sphere CGAL's symbolic perturbation decides. points: distinct, finite, metres. Throws Error where all
// lie on a plane or a line, and in a build without CGAL; Cancelled.
PointGraph delaunay_graph(const std::vector<Vec3>& points, Progress& progress);

}  // namespace treerec
