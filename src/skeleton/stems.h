// Stems that share one root.
#pragma once

#include <vector>

#include "skeleton/axis.h"
#include "skeleton/limbs.h"

namespace treerec {

// The paths of several stems bend towards their common root. Each stem goes straight on to the ground
// instead, as its measured part above does, and joins the root down there. Stems are the first limb and those
// that grow out of its first station. limbs, axes: as from fit_axes(); stations are moved in place.
void straighten_stems(const std::vector<Limb>& limbs, std::vector<std::vector<Station>>& axes);

}  // namespace treerec
