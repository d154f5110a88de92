// Regular polygons: what a tube's rings are. Internal to mesh/.
#pragma once

#include <cstdint>

#include "geometry/vec.h"

namespace treerec {

inline constexpr uint32_t kMostSides = 64;

// Cosine and sine of every corner's angle, one after another from 0; the first corner stands once more at the
// end. sides: 3 .. kMostSides.
const DVec2* polygon(uint32_t sides);

// How near its sides come to the middle, over its corners' distance: cos(pi / sides).
double polygon_flat(uint32_t sides);

}  // namespace treerec
