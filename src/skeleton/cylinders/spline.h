// Axes as smooth as wood grows.
#pragma once

#include <vector>

#include "skeleton/branches/skeleton_branches.h"
#include "skeleton/cylinders/axis.h"

namespace treerec {

// Each axis becomes the cubic smoothing spline of its stations (Reinsch 1967), which is what is likeliest
// where headings drift as a random walk along the wood (Wahba 1978), and a station is as sure as its points
// scatter. Thin twigs, whose stations noise puts to this side and that, lose their elbows; stations that were
// measured, stout wood, the ends of gaps and the places where branches begin stay. axes: with radii.
void smooth_axes(const std::vector<SkeletonBranch>& branches, std::vector<std::vector<Station>>& axes);

}  // namespace treerec
