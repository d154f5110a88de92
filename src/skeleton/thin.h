// Thins a cloud to an even density, so that nothing superlinear sees a dense one.
#pragma once

#include <vector>

#include "geometry/vec.h"
#include "progress.h"

namespace treerec {

// At most one point per cube of edge `spacing` (metres): the one nearest to the mean of its cube, so that
// every result is a scanned point. Sorted along the cubes; the result depends neither on the order of the
// points nor on repeated points. Points that are not finite are dropped.
std::vector<Vec3> thin_points(const std::vector<Vec3>& points, double spacing, Progress& progress);

// The spacing to use when the user gives none: 1/2000 of the cloud's diagonal, between 1 mm and 2 cm, and
// coarser where the cloud would keep more than kMostPoints.
inline constexpr size_t kMostPoints = 120000;
double automatic_spacing(const std::vector<Vec3>& points, const Progress* progress = nullptr);

}  // namespace treerec
