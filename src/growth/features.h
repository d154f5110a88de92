// Features find their place on the surface, and hollows what decays. Internal to growth/.
#pragma once

#include <vector>

#include "growth/feature.h"
#include "growth/plan.h"
#include "growth/surface.h"

namespace treerec::growth {

// Once its time has come and the tip (apex: of its branch, may be null) has left bark there. longest: T_s,
// metres.
void place_feature(Surface& surface, const GrowthPlan& plan, Vertex apex, double longest, int step,
                   Feature& feature);

// Cambium within the regions of hollows becomes decayed wood (Mizoguchi and Miyata 2014, 7.1).
void decay(Surface& surface, const std::vector<Feature>& features, int step);

// Vertices on the sap link through one, of which none lie nearer than `every` metres along it, over `length`
// metres to both sides together; the vertex itself first.
std::vector<Vertex> along_link(const Surface& surface, Vertex from, double length, double every);

}  // namespace treerec::growth
