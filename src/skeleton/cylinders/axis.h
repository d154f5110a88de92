// Moves the branches from the bark into the wood and measures how thick it is.
#pragma once

#include <cstdint>
#include <vector>

#include "progress.h"
#include "skeleton/branches/skeleton_branches.h"

namespace treerec {

// A station of a branch: where the axis passes a slice.
struct Station {
    DVec3 position{0.0};
    double radius = 0.0;    // metres; 0 where no points told anything
    double scatter = 0.0;   // metres: median deviation of the points from the radius; 0 where unknown
    bool measured = false;  // by a circle fit; otherwise `radius` is the points' median distance to the axis
    bool bridged = false;   // the way from the station before crosses a gap
};

struct AxisOptions {
    bool fit_radii = true;
    uint64_t seed = 1;
    double widest_ring = 0.25;  // metres: a wider closed section is a hollow crown unless it is a true circle
    size_t confirmations = 1;   // alike circles within three stations, without which one is an accident
    bool long_windows = false;  // a sparse stem may be measured over a longer piece
    int rounds = 2;             // fit, then fit again across the better axis
    PassSet left_out;
};

// One list of stations per branch. The axis runs through the centres of circles fitted to the cross-sections
// wherever the points surround it well enough (AdTree, Du et al. 2019, 2.4, fits cylinders to the trunk
// alone), in between through the slices' centres moved by as much as their fitted neighbours, smoothed.
// Also moves each branch's `attach` along its parent to where the branch, continued backwards, meets the
// axis.
std::vector<std::vector<Station>> fit_axes(std::vector<SkeletonBranch>& branches, const Slices& slices,
                                           const std::vector<Vec3>& points, const LocalScale& scale,
                                           const AxisOptions& options, Progress& progress);

// Moves the branch's `attach` back along its parent to where the branch, continued backwards, meets the axis
// most nearly straight. own, parent: the stations of the branch and of its parent.
void move_attach(SkeletonBranch& branch, const std::vector<Station>& own, const std::vector<Station>& parent);

}  // namespace treerec
