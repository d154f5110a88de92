// Lighter levels of bark that grew. Internal to growth/.
#pragma once

#include "mesh/grown_bark.h"
#include "progress.h"

namespace treerec::growth {

// Brings the vertices into the order in which lighter levels keep them, and fills `parents`. The surface
// stays as it is: closed, and every level of it is, too. Where bark meets wood, and which branch a vertex
// belongs to, is kept in all levels. Deterministic; n log n in the vertices. Throws Cancelled.
void order_levels(GrownBark& bark, const Progress* progress = nullptr);

}  // namespace treerec::growth
