// The thin wood that the slices are too coarse for.
#pragma once

#include <vector>

#include "skeleton/branches/skeleton_branches.h"
#include "skeleton/branches/slices.h"
#include "skeleton/cylinders/axis.h"
#include "skeleton/cylinders/refine.h"
#include "skeleton/geodesics/paths.h"
#include "skeleton/sampling/point_graph.h"

namespace treerec {

struct TwigOptions {
    double minimum_branch = 0.05;  // metres from its parent's axis that a twig is long, at least
    double least_escape = 0.025;   // metres that it must reach out of its parent's surface
    PassSet left_out;
};

// Adds twigs to the branches and their axes until every point that a twig can reach lies on the bark of
// something (the paths are found like TEASAR's, Sato et al. 2000: the farthest point left is followed back
// along the shortest paths to the wood that is already there, and what lies along the way is done with). A
// twig has no slices, only stations; its axis keeps to its points. branches, axes: as from fit_axes(),
// extended in step. Returns which branch each point lies on, blurred ones beside the bark included.
PointPlaces add_twigs(const std::vector<Vec3>& points, const PointGraph& graph, const LocalScale& scale,
                      const PathTree& paths, const Slices& slices, const TwigOptions& options,
                      std::vector<SkeletonBranch>& branches, std::vector<std::vector<Station>>& axes,
                      Progress& progress);

}  // namespace treerec
