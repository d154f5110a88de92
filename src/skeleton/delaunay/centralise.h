// AdTree's centralisation: points move from the bark to the axis.
#pragma once

#include <vector>

#include "skeleton/delaunay/initial_skeleton.h"
#include "skeleton/delaunay/trunk_cylinder.h"

namespace treerec {

// Moves the points to where the mean shift (Fukunaga and Hostetler 1975) of the points around them leads, in
// a ball as wide as their wood is by allometry (Chen 2025, 2.2.2, step 1; Du et al. 2019, 3.1): that of a
// ring of bark is its centre. The papers move those of the main branches alone; in wood thinner than the
// points are apart, where the ball is a few spacings wide, it straightens the zigzag of points on either side
// of a twig. spacing: between the points, metres. Returns the places by point, metres. Throws Cancelled.
std::vector<Vec3> centralise_points(const std::vector<Vec3>& points, const InitialSkeleton& skeleton,
                                    const TrunkCylinder& trunk, double spacing, Progress& progress);

}  // namespace treerec
