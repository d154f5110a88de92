// Where branches end.
#pragma once

#include <vector>

#include "skeleton/branches/skeleton_branches.h"
#include "skeleton/cylinders/axis.h"

namespace treerec {

// Draws the ends of thin branches back along their axes. A branch ends at the farthest of its points, which
// lies on the wood's rounded end and not on its axis, and of many points the farthest is farther out than the
// wood. minimum_branch: metres that stay between the last fork and the tip, if they are there.
void draw_back_tips(std::vector<std::vector<Station>>& axes, const std::vector<SkeletonBranch>& branches,
                    double minimum_branch);

}  // namespace treerec
