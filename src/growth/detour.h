// Tips that go around obstacles, beside the paper, whose branches end at them. Internal to growth/.
#pragma once

#include "growth/obstacles.h"
#include "growth/plan.h"

namespace treerec::growth {

// Moves the pith of branches aside where an obstacle stands in its way, as little as it takes, if within the
// wood there is room beside: the tip comes by, and the bark grows around the obstacle from both sides.
// Where there is none, tips stop at it. shortest: T_m, metres.
void go_around(GrowthPlan& plan, const Obstacles& obstacles, double shortest);

}  // namespace treerec::growth
