// Whether a cloud can be a tree at all.
#pragma once

#include <string>
#include <vector>

#include "progress.h"
#include "scan/point_cloud.h"

namespace treerec {

// Throws Error for a cloud that has no room for a tree: fewer than 10 different places, all points on a line
// or a plane (to 1/10000 of the extent, however it is tilted). Returns a sentence for a cloud that a tree
// would be a surprise in: flat surfaces (walls, a floor, the rooms of a house), points evenly spread (noise),
// the surface of a ball. cloud: oriented and clean.
std::vector<std::string> check_shape(const PointCloud& cloud, const Progress* progress = nullptr);

// The share of the points on surfaces that are flat, wide and filled. points: some thousands.
double share_on_surfaces(const std::vector<Vec3>& points, const Progress* progress = nullptr);

}  // namespace treerec
