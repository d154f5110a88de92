// Where stems and branches begin.
#pragma once

#include <vector>

#include "skeleton/branches/skeleton_branches.h"
#include "skeleton/cylinders/axis.h"

namespace treerec {

// The paths of several stems bend towards their common root. Each stem goes straight on to the ground
// instead, as its measured part above does, and joins the root down there. Stems are the first branch and
// those that grow out of its first station. branches, axes: as from fit_axes(); stations are moved in place.
void straighten_stems(const std::vector<SkeletonBranch>& branches, std::vector<std::vector<Station>>& axes);

// A branch's first slices are parts of rings, cut off by its parent's bark, and lie beside its axis. Each
// branch goes straight back from its first measured stretch to its parent's bark instead, if that leads to
// the parent's axis. Moves stations in place, and the branches' `attach`; a branch that hangs on the base of
// another one that leaves the same fork may change its `parent`. branches, axes: as from fit_axes().
void straighten_bases(std::vector<SkeletonBranch>& branches, std::vector<std::vector<Station>>& axes);

}  // namespace treerec
