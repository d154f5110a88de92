// Trees much smaller than those that lengths in metres were chosen for.
#pragma once

#include <vector>

#include "scan/point_cloud.h"

namespace treerec {

// Twigs, noise and voxels have usual lengths in metres, found on trees of a few metres and more. What is
// smaller than a metre is a bonsai, a seedling or a model without a scale: as on those, its details are as
// much smaller as it is itself, so that it is looked at as if it were a tree of the usual size. Returns by
// how much it has to grow for that: 1 for all larger clouds. points: of a clean cloud, metres.
double enlargement_to_usual(const std::vector<Vec3>& points);

// Grown by the factor about the origin; a cloud's frame follows.
std::vector<Vec3> enlarged(std::vector<Vec3> points, double factor);
PointCloud enlarged(PointCloud cloud, double factor);

}  // namespace treerec
