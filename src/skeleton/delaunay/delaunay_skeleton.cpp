#include "skeleton/delaunay/delaunay_skeleton.h"

#include <algorithm>

#include "skeleton/cylinders/stem_base.h"
#include "skeleton/delaunay/centralise.h"
#include "skeleton/delaunay/initial_skeleton.h"
#include "skeleton/delaunay/simplify.h"
#include "skeleton/delaunay/trunk_cylinder.h"
#include "skeleton/simplify/assemble.h"

namespace treerec {

namespace {

constexpr double kGap = 8.0;       // times as far apart as the points: a longer edge crosses a gap,
constexpr double kStraight = 0.3;  // and how far Douglas and Peucker may move a branch

double median_of(std::vector<float> values) {
    const auto middle = values.begin() + static_cast<ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

}  // namespace

void delaunay_skeleton(SkeletonWork& work) {
    const std::vector<Vec3>& points = work.points();
    const SkeletonOptions& options = work.options;
    SkeletonResult& result = work.result;
    // The root is where the other method finds it, so that the two differ in nothing but what they are.
    SubProgress rooting(work.listener, 0.1, 0.2);
    rooting.update(0.0, "Neighbours");
    work.graph = neighbour_graph(points, rooting);
    work.first_scale = local_scale(work.graph, result.spacing, &rooting);
    work.root = find_root(points, work.graph, work.first_scale, options.stem_base, rooting);
    const DVec3& root = work.root.position;
    const double apart = median_of(work.first_scale.spacing);
    work.clock.stop("Neighbours", work.graph.neighbour.size() / 2);

    SubProgress linking(work.listener, 0.2, 0.5);
    linking.update(0.0, "Delaunay triangulation");
    const InitialSkeleton first = initial_skeleton(points, root, options.spanning_tree, linking);
    const std::optional<TrunkCylinder> trunk =
        fit_trunk_cylinder(points, first, options.fit_radii, options.seed);
    if (!trunk)
        throw Error(
            "Too few points stand where the trunk should be. Take the skeleton method geodesic, which needs "
            "none.");
    if (options.keep_raw) result.raw = path_tree_as_tree(points, first.tree, root);
    work.clock.stop("Delaunay triangulation", points.size());

    SubProgress centring(work.listener, 0.5, 0.85);
    centring.update(0.0, "Centralisation");
    const std::vector<Vec3> moved =
        thin_points(centralise_points(points, first, *trunk, apart, centring), result.spacing, centring);
    centring.update(0.5, "Centralisation");
    const InitialSkeleton second = initial_skeleton(moved, root, options.spanning_tree, centring);
    work.clock.stop("Centralisation", moved.size());

    SubProgress simplifying(work.listener, 0.85, 1.0);
    simplifying.update(0.0, "Simplification");
    work.extent = extent_from(points, root);
    const std::vector<DelaunayVertex> vertices =
        simplify_skeleton(moved, second, root, *trunk, apart, work.least_branch(), simplifying);
    branches_of(vertices, *trunk, kGap * apart, work.branches, work.axes);
    if (options.one_stem) {
        work.branches.resize(1);
        work.axes.resize(1);
    }
    seat_root(work.branches, work.axes);
    result.tree =
        assemble_tree(work.axes, work.branches,
                      options.simplify_distance > 0.0 ? options.simplify_distance : kStraight * apart);
    if (options.fit_radii && !trunk->measured)
        result.warnings.emplace_back(
            "The points around the base lie on no cylinder, so all radii are guesses by how far the tree "
            "reaches.");
    finish(work);
}

}  // namespace treerec
