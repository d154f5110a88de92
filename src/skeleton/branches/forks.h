// Where branches leave their parents.
#pragma once

#include <vector>

#include "progress.h"
#include "skeleton/branches/skeleton_branches.h"
#include "skeleton/branches/slices.h"
#include "skeleton/cylinders/axis.h"

namespace treerec {

// Until a branch is separate from its parent, its slices are parts of rings and its axis is drawn into the
// parent's: a V becomes an L. There its base is laid anew: back from where it is separate, along the tangent
// it has there, or on an arc that ends in that tangent, to its parent's axis. Of the bases that leave the
// parent at no wider angle than the branch has later, the one that the bark around the fork keeps to best is
// taken, if it does so as well as to the base that was found: a branch that does leave at an elbow keeps it.
// Moves stations in place, and the branches' `attach`. branches, axes: with radii.
void lay_forks(std::vector<SkeletonBranch>& branches, std::vector<std::vector<Station>>& axes,
               const Slices& slices, const std::vector<Vec3>& points, const Progress& progress);

}  // namespace treerec
