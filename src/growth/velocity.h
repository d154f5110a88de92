// How fast and where to each vertex grows (Mizoguchi and Miyata 2014, 5.1, 6.1, 7.1, 7.2, 8). Internal to
// growth/.
#pragma once

#include <vector>

#include "growth/feature.h"
#include "growth/lips.h"
#include "growth/plan.h"
#include "growth/surface.h"

namespace treerec::growth {

// Fills Cell::velocity, speed and extra for the step from `step` to step + 1, and Feature::reach. Returns the
// largest velocity of all that are not apical, metres a step.
double set_velocities(Surface& surface, const GrowthPlan& plan, std::vector<Feature>& features,
                      const Lips& lips, int step);

}  // namespace treerec::growth
