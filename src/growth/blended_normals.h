// Touching bark looks fused (Mizoguchi and Miyata 2014, 5.3). Internal to growth/.
#pragma once

#include "mesh/grown_bark.h"

namespace treerec::growth {

// Where bark faces other bark within so many metres, with nothing but air between, their normals lean to one
// another, the nearer the more, until they are the same where the two touch: no crease is seen. What is
// bare wood, and bark beside it alone, stays.
void blend_normals(GrownBark& bark, double within);

}  // namespace treerec::growth
