// Bends that no wood has.
#pragma once

#include <vector>

#include "progress.h"
#include "skeleton/branches/skeleton_branches.h"
#include "skeleton/branches/slices.h"
#include "skeleton/cylinders/axis.h"

namespace treerec {

// Where an axis bends tighter than its wood is thick - at forks whose slices still held both arms, and where
// a slice is half a ring - it is laid anew, on the curve that goes on smoothly at both ends, if the points
// there keep to that about as well. Moves stations in place. branches, axes: with radii.
void lay_bends(const std::vector<SkeletonBranch>& branches, std::vector<std::vector<Station>>& axes,
               const Slices& slices, const std::vector<Vec3>& points, const Progress& progress);

// Without points: evens out the stations around what still bends tighter than the wood is thick, or by more
// than 60 degrees. What turns back from its parent leaves it before that (its `attach`). No station goes far,
// and the ends of gaps stay.
void smooth_bends(std::vector<SkeletonBranch>& branches, std::vector<std::vector<Station>>& axes);

}  // namespace treerec
