// Whether a scan is sharp enough for shape to tell leaves from wood. Internal to scan/.
#pragma once

#include <vector>

#include "geometry/vec.h"
#include "progress.h"

namespace treerec {

// Whether the points at the foot, where wood is always seen, lie on no surface: then noise is as wide as the
// gaps between points, and makes bare branches look like leaves. points: metres, Y up, distinct, in canonical
// order.
bool is_blurred(const std::vector<Vec3>& points, const Progress& progress);

}  // namespace treerec
