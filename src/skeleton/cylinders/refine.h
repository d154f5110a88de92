// The last look at the points: every axis and radius again, now that all branches are known.
#pragma once

#include <vector>

#include "progress.h"
#include "skeleton/cylinders/axis.h"

namespace treerec {

// By point: the branch that it lies on, -1 for none, and the station that it is near.
struct PointPlaces {
    std::vector<int32_t> branch;
    std::vector<int32_t> station;
};

// Moves stations and radii (metres) so that each branch's surface runs through the points that are nearer to
// it than to the branches it grows from and carries: Gauss-Newton steps on the distances to the surface, with
// Tukey's biweights (Holland and Welsch 1977) and a ridge that keeps what the points do not tell, over
// windows about as long as the branch is thick. Measured radii become those of the fit, unmeasured ones the
// points' median distance to the axis, or what one side of the bark tells (radius_across()); `scatter` is the
// median deviation from either. Points that surround an unmeasured station at one distance are bark, and it
// counts as measured too. axes: from fit_axes(), with infer_radii() behind it. The first station of the first
// branch stays, as do both ends of bridges. least_noise: metres, the points' standard deviation where more is
// known than the axes show. Throws Cancelled on request.
void refine_axes(std::vector<std::vector<Station>>& axes, const std::vector<SkeletonBranch>& branches,
                 const PointPlaces& places, const std::vector<Vec3>& points, Progress& progress,
                 double least_noise = 0.0, PassSet left_out = {});

}  // namespace treerec
