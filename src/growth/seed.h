// What the surface starts from: figure 4's prism, or any closed mesh (Mizoguchi and Miyata 2014, 4.1).
// Internal to growth/.
#pragma once

#include "growth/plan.h"
#include "growth/surface.h"

namespace treerec::growth {

// Returns the apical vertex that becomes the trunk. longest: T_s, metres.
Vertex plant_prism(Surface& surface, const GrowthPlan& plan, double longest);

// The plan's own mesh, whose apical vertex is where the trunk's axis comes out of it. Throws Error for a mesh
// that is not closed, not one manifold surface, meets itself, or that the trunk does not begin in. shortest:
// T_m, metres.
Vertex plant_mesh(Surface& surface, const GrowthPlan& plan, double shortest);

}  // namespace treerec::growth
