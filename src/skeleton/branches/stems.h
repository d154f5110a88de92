// Where stems and limbs begin.
#pragma once

#include <vector>

#include "skeleton/branches/limbs.h"
#include "skeleton/cylinders/axis.h"

namespace treerec {

// The paths of several stems bend towards their common root. Each stem goes straight on to the ground
// instead, as its measured part above does, and joins the root down there. Stems are the first limb and those
// that grow out of its first station. limbs, axes: as from fit_axes(); stations are moved in place.
void straighten_stems(const std::vector<Limb>& limbs, std::vector<std::vector<Station>>& axes);

// A limb's first slices are parts of rings, cut off by its parent's bark, and lie beside its axis. Each limb
// goes straight back from its first measured stretch to its parent's bark instead, if that leads to the
// parent's axis. Moves stations in place, and the limbs' `attach`; a limb that hangs on the base of another
// one that leaves the same fork may change its `parent`. limbs, axes: as from fit_axes().
void straighten_bases(std::vector<Limb>& limbs, std::vector<std::vector<Station>>& axes);

}  // namespace treerec
