#include "skeleton/delaunay/delaunay_skeleton.h"

#include <algorithm>

#include "skeleton/cylinders/foot.h"
#include "skeleton/delaunay/centralise.h"
#include "skeleton/delaunay/initial_skeleton.h"
#include "skeleton/delaunay/simplify.h"
#include "skeleton/delaunay/trunk_cylinder.h"
#include "skeleton/flood/flood_skeleton.h"
#include "skeleton/geodesics/paths.h"
#include "skeleton/geodesics/root.h"
#include "skeleton/sampling/thin.h"
#include "skeleton/simplify/assemble.h"
#include "tree/trunk.h"

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

void delaunay_skeleton(const std::vector<Vec3>& points, const PointCloud& cloud,
                       const SkeletonOptions& options, SkeletonResult& result, StageClock& clock,
                       Progress* listener) {
    // The root is where the other method finds it, so that the two differ in nothing but what they are.
    SubProgress rooting(listener, 0.1, 0.2);
    rooting.update(0.0, "Neighbours");
    const PointGraph near = neighbour_graph(points, rooting);
    const LocalScale scale = local_scale(near, result.spacing, &rooting);
    const RootGuess root = find_root(points, near, scale, options.foot, rooting);
    const double apart = median_of(scale.spacing);
    clock.stop("Neighbours", near.neighbour.size() / 2);

    SubProgress linking(listener, 0.2, 0.5);
    linking.update(0.0, "Delaunay triangulation");
    const InitialSkeleton first = initial_skeleton(points, root.position, options.spanning_tree, linking);
    const std::optional<TrunkCylinder> trunk =
        fit_trunk_cylinder(points, first, options.fit_radii, options.seed);
    if (!trunk)
        throw Error(
            "Too few points stand where the trunk should be. Take the skeleton method geodesic, which needs "
            "none.");
    if (options.keep_raw) result.raw = path_tree_as_tree(points, first.tree, root.position);
    clock.stop("Delaunay triangulation", points.size());

    SubProgress centring(listener, 0.5, 0.85);
    centring.update(0.0, "Centralisation");
    const std::vector<Vec3> moved =
        thin_points(centralise_points(points, first, *trunk, apart, centring), result.spacing, centring);
    centring.update(0.5, "Centralisation");
    const InitialSkeleton second = initial_skeleton(moved, root.position, options.spanning_tree, centring);
    clock.stop("Centralisation", moved.size());

    SubProgress simplifying(listener, 0.85, 1.0);
    simplifying.update(0.0, "Simplification");
    double extent = 0.0;
    for (const Vec3& p : points)
        extent = std::max(extent, glm::distance(DVec3(p), root.position));
    const double shortest = options.minimum_branch > 0.0 ? options.minimum_branch : automatic_branch(extent);
    const std::vector<DelaunayVertex> vertices =
        simplify_skeleton(moved, second, root.position, *trunk, apart, shortest, simplifying);
    std::vector<Limb> limbs;
    std::vector<std::vector<Station>> axes;
    branches_of(vertices, *trunk, kGap * apart, limbs, axes);
    if (options.one_stem) {
        limbs.resize(1);
        axes.resize(1);
    }
    seat_root(limbs, axes);
    result.tree = assemble_tree(
        axes, limbs, options.simplify_distance > 0.0 ? options.simplify_distance : kStraight * apart);
    mark_trunk(result.tree);
    result.tree.set_frame(cloud.frame);
    const DVec3 base = result.tree.node(result.tree.root()).position;
    result.tree.rebase(base);
    if (options.keep_raw) {
        result.raw.set_frame(cloud.frame);
        result.raw.rebase(base);
    }
    if (options.fit_radii && !trunk->measured)
        result.warnings.emplace_back(
            "The points around the foot lie on no cylinder, so all radii are guesses by how far the tree "
            "reaches.");
    clock.stop("Simplification", result.tree.size());
    if (listener) listener->update(1.0, "Skeleton");
}

}  // namespace treerec
