// The rings that a branch's tube is hung on. Internal to mesh/.
#pragma once

#include <cstddef>

#include "geometry/vec.h"

namespace treerec {

// Metres, tree space.
struct Ring {
    DVec3 centre;
    DVec3 normal;  // unit, towards the tip
    double radius;
    double along;  // from the branch's start
};

// Two rings must not cross on the inner side of a bend: turns both towards their mean until they clear.
void limit_tilt(Ring* rings, size_t count);

}  // namespace treerec
