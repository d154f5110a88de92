#include "skeleton/branches/thickness.h"
#include "skeleton/stages.h"

namespace treerec {

namespace {

constexpr double kWidestRing = 0.05;  // of the tree's extent

}  // namespace

void find_branches(SkeletonWork& work) {
    const SkeletonOptions& options = work.options;
    const std::vector<Vec3>& points = work.points();
    work.progress.update(0.6, "Thickness");
    work.progress.check();
    work.branch_options.minimum_branch = work.least_branch();
    work.branch_options.widest_loop = kWidestRing * work.extent;
    work.branch_options.left_out = work.axis_options.left_out = options.left_out;
    work.axis_options.fit_radii = options.fit_radii;
    work.axis_options.seed = options.seed;
    work.axis_options.widest_ring = kWidestRing * work.extent;
    work.scale = follow_thickness(work.first_scale, points, work.graph, work.paths, work.root.position,
                                  {work.branch_options, work.axis_options}, work.progress);
    work.clock.stop("Thickness", points.size());

    work.progress.update(0.7, "Branches");
    work.slices = cut_slices(points, work.graph, work.scale, work.paths, work.root.position, work.progress);
    work.progress.check();
    work.branches = branches_of_slices(work.slices, points, work.scale, work.branch_options, work.progress);
    work.clock.stop("Branches", work.branches.size());
}

}  // namespace treerec
