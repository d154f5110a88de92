// Where a stem stands on the ground.
#pragma once

#include <vector>

#include "skeleton/axis.h"

namespace treerec {

// The lowest points of a stem are those of one root spur, or what is left of the ground beside it, and its
// axis bends towards them. Puts the lowest stations of an upright stem, the root too, on the straight line of
// the stem above, each at its own height, if they lie off it by more than half the stem's radius. Does
// nothing where the stem is not upright or not straight, or too short to tell. stem: metres, Y up, from the
// root.
void plant_foot(std::vector<Station>& stem);

}  // namespace treerec
