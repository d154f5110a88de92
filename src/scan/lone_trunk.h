// A stem without a crown. Internal to scan/.
#pragma once

#include <vector>

#include "geometry/vec.h"
#include "progress.h"

namespace treerec {

// Whether the cloud is nothing but a stem, or a piece of one, as photos of a trunk give it: at nearly all
// heights its points lie around one axis, at one distance. points: metres, Y up.
bool is_lone_trunk(const std::vector<Vec3>& points, const Progress& progress);

}  // namespace treerec
