// Whether a scan is sharp enough for shape to tell leaves from wood. Internal to scan/.
#pragma once

#include <vector>

#include "geometry/vec.h"
#include "progress.h"

namespace treerec {

// 0 for a sharp scan; else the least that its noise can be, in metres (a standard deviation): the points at
// the foot, where wood is always seen, lie on no surface. Noise is as wide as the gaps between points then,
// and makes bare branches look like leaves. points: metres, Y up, distinct, in canonical order.
double blur_of(const std::vector<Vec3>& points, const Progress& progress);

}  // namespace treerec
