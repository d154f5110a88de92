// Short shoots that are bark of the stout wood beside them.
#pragma once

#include <vector>

#include "skeleton/branches/skeleton_branches.h"
#include "skeleton/cylinders/axis.h"

namespace treerec {

// Takes away thin branches that bear nothing and hug wood at least three times as thick: those whose tip lies
// inside the smooth union of such wood, enlarged by 1.3 (in the crotch of a fork, bark is farther from both
// axes than anywhere else), and those near it that run along its bark rather than away from it: these follow
// points that noise has put beside the bark. branches, axes: with radii.
void drop_hugging_shoots(std::vector<SkeletonBranch>& branches, std::vector<std::vector<Station>>& axes);

}  // namespace treerec
