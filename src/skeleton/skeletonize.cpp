#include <array>
#include <cstdio>
#include <limits>

#include "geometry/covariance.h"
#include "scan/lone_trunk.h"
#include "scan/usual_size.h"
#include "skeleton/assemble.h"
#include "skeleton/axis.h"
#include "skeleton/bark.h"
#include "skeleton/delaunay/delaunay_skeleton.h"
#include "skeleton/flood_skeleton.h"
#include "skeleton/foot.h"
#include "skeleton/known_radii.h"
#include "skeleton/limbs.h"
#include "skeleton/paths.h"
#include "skeleton/point_graph.h"
#include "skeleton/radii.h"
#include "skeleton/refine.h"
#include "skeleton/root.h"
#include "skeleton/skeleton.h"
#include "skeleton/slices.h"
#include "skeleton/stems.h"
#include "skeleton/thickness.h"
#include "skeleton/thin.h"
#include "skeleton/tips.h"
#include "skeleton/twigs.h"
#include "skeleton/wide_gaps.h"
#include "tree/trunk.h"

namespace treerec {

namespace {

constexpr size_t kLeastPoints = 10;
constexpr double kVoxelSpacings = 2.0;  // a stated voxel is at least so many spacings wide
constexpr int kGapRounds = 4;           // wide gaps that are looked at, one behind the other
constexpr double kTwigEscape = 0.02;    // metres that a twig must reach out of the bark,
constexpr double kNoiseEscape = 2.5;    // and times the scan's noise
constexpr double kWidestRing = 0.05;    // of the tree's extent
constexpr double kFlatness = 1e-4;      // depth over width: less is rounding, not a scanned tree
constexpr double kLeastGap = 0.3;       // metres: a gap that the user is told of,
constexpr double kGapShare = 0.04;      // and of the tree's extent

// Whether the points all lie on a plane, or on a line.
bool is_flat(const std::vector<Vec3>& points) {
    const DMat3 covariance = covariance_of(points);
    // The determinant is the product of the squared extents along the three main axes.
    const double widest = (covariance[0][0] + covariance[1][1] + covariance[2][2]) / 3.0;
    return !(glm::determinant(covariance) > kFlatness * kFlatness * widest * widest * widest);
}

// A sentence about the widest gap that was bridged, if it is a remarkable one.
// factor: by how much the cloud was enlarged.
std::vector<std::string> gap_warnings(const std::vector<std::vector<Station>>& axes,
                                      const std::vector<Limb>& limbs, double extent, double factor) {
    double widest = 0.0;
    int gaps = 0;
    const double least = std::max(kLeastGap, kGapShare * extent);
    for (size_t l = 0; l < axes.size(); l++)
        for (size_t i = limbs[l].parent < 0 ? 1 : 0; i < axes[l].size(); i++) {
            if (!axes[l][i].bridged) continue;
            const Station& before = i > 0 ? axes[l][i - 1] : axes[limbs[l].parent][limbs[l].attach];
            const double width = glm::distance(axes[l][i].position, before.position);
            if (width < least) continue;
            gaps++;
            widest = std::max(widest, width);
        }
    if (gaps == 0) return {};
    std::array<char, 200> text;
    std::snprintf(text.data(), text.size(),
                  "The scan has %s of up to %.1f m in the wood; what lies between is a guess.",
                  gaps == 1 ? "a gap" : (std::to_string(gaps) + " gaps").c_str(), widest / factor);
    return {text.data()};
}

// The places of the points that measures are taken from.
PointPlaces places_of_sample(const ThinnedCloud& thinned, PointPlaces& places) {
    if (thinned.sample.empty()) return std::move(places);
    PointPlaces own;
    for (const uint32_t point : thinned.cube) {
        own.limb.push_back(places.limb[point]);
        own.station.push_back(places.station[point]);
    }
    return own;
}

// A stump is one piece of wood: its sections, one after another.
Tree stump_tree(const std::vector<TrunkRing>& rings, const SkeletonOptions& options) {
    std::vector<Station> axis;
    for (const TrunkRing& ring : rings)
        axis.push_back({ring.centre, ring.radius, ring.scatter, options.fit_radii});
    Limb limb;
    limb.slices.resize(axis.size());
    return assemble_tree({axis}, {limb}, options.simplify_distance);
}

// factor: by how much the cloud was enlarged, which the lengths in sentences leave out.
SkeletonResult skeletonize_sized(const PointCloud& cloud, const SkeletonOptions& options, double factor,
                                 Progress* listener) {
    SubProgress progress(listener, 0.0, 1.0);
    SkeletonResult result;
    StageClock clock(result.stages);

    progress.update(0.0, "Thinning");
    result.spacing = options.spacing > 0.0 ? options.spacing : automatic_spacing(cloud.positions, &progress);
    const bool floods = options.method == SkeletonMethod::kFlood;
    if (floods && options.voxel > 0.0 && options.spacing <= 0.0)
        result.spacing = std::min(result.spacing, options.voxel / kVoxelSpacings);
    const ThinnedCloud thinned =
        floods ? ThinnedCloud{thin_points(cloud.positions, result.spacing, progress), {}, {}}
               : thin_with_sample(cloud.positions, result.spacing, progress);
    const std::vector<Vec3>& points = thinned.points;
    if (points.size() < kLeastPoints)
        throw Error(
            "The cloud has only " + std::to_string(points.size()) + " points more than " +
            std::to_string(result.spacing / factor) +
            " m apart, and a tree needs at least 10. Check that the file is complete, that its unit is "
            "right, and that the cleaning steps did not take too much.");
    if (is_flat(points))
        throw Error(
            "All points lie on a plane or on a line, and a tree needs depth: this looks like a photo or a "
            "section of a scan.");
    clock.stop("Thinning", points.size());
    const std::vector<TrunkRing> rings = options.trunk_alone ? trunk_rings(cloud.positions, &progress)
                                                             : stump_rings(cloud.positions, &progress);
    if (!rings.empty()) {
        result.tree = stump_tree(rings, options);
        if (floods) result.voxel = options.voxel > 0.0 ? options.voxel : kVoxelSpacings * result.spacing;
        mark_trunk(result.tree);
        result.tree.set_frame(cloud.frame);
        const DVec3 foot = result.tree.node(result.tree.root()).position;
        result.tree.rebase(foot);
        if (options.keep_raw) result.raw = result.tree;
        clock.stop("Simplification", result.tree.size());
        progress.update(1.0, "Skeleton");
        return result;
    }
    if (floods) {
        flood_skeleton(points, cloud, options, factor, result, clock, listener);
        return result;
    }
    if (options.method == SkeletonMethod::kDelaunay) {
        delaunay_skeleton(points, cloud, options, result, clock, listener);
        return result;
    }

    SubProgress linking(listener, 0.1, 0.55);
    PointGraph graph = neighbour_graph(points, linking);
    LocalScale first_scale = local_scale(graph, result.spacing, &progress);
    const KnownRadii known(cloud, result.spacing, &progress);
    if (known.any()) {
        first_scale.radius = known.at(points, progress);
        link_stout_wood(points, first_scale, result.spacing, graph, progress);
    }
    clock.stop("Neighbours", graph.neighbour.size() / 2);

    progress.update(0.55, "Shortest paths");
    progress.check();
    const RootGuess root = find_root(points, graph, first_scale, options.foot, progress);
    progress.check();
    double extent = 0.0;
    for (const Vec3& p : points)
        extent = std::max(extent, glm::distance(DVec3(p), root.position));
    PathTree paths = shortest_paths(graph, first_scale, root.seeds, progress);
    WideGaps gaps;
    for (int round = 0; round < kGapRounds; round++) {
        const size_t known = gaps.links.size();
        if (!link_over_wide_gap(points, paths, extent, graph, gaps, progress)) break;
        if (gaps.links.size() > known)
            paths = shortest_paths(graph, first_scale, root.seeds, progress, gaps.links);
    }
    if (options.keep_raw) result.raw = path_tree_as_tree(points, paths, root.position);
    clock.stop("Shortest paths", points.size());

    progress.update(0.6, "Thickness");
    progress.check();
    LimbOptions limb_options;
    limb_options.minimum_branch =
        options.minimum_branch > 0.0 ? options.minimum_branch : automatic_branch(extent);
    limb_options.widest_loop = kWidestRing * extent;
    AxisOptions axis_options;
    axis_options.fit_radii = options.fit_radii;
    axis_options.seed = options.seed;
    axis_options.widest_ring = kWidestRing * extent;
    const LocalScale scale = follow_thickness(first_scale, points, graph, paths, root.position,
                                              {limb_options, axis_options}, progress);
    clock.stop("Thickness", points.size());

    progress.update(0.7, "Branches");

    const Slices slices = cut_slices(points, graph, scale, paths, root.position, progress);
    progress.check();
    std::vector<Limb> limbs = find_limbs(slices, points, scale, limb_options, progress);
    clock.stop("Branches", limbs.size());

    progress.update(0.8, "Radii");
    axis_options.long_windows = true;
    std::vector<std::vector<Station>> axes = fit_axes(limbs, slices, points, scale, axis_options, progress);
    if (options.one_stem) {
        limbs.resize(1);
        axes.resize(1);
    }
    straighten_stems(limbs, axes);
    if (!root.lying && std::none_of(limbs.begin(), limbs.end(),
                                    [](const Limb& limb) { return limb.parent == 0 && limb.attach == 0; }))
        plant_foot(axes.front());
    straighten_bases(limbs, axes);
    if (!root.lying) limit_foot(axes.front());
    infer_radii(axes, limbs);
    drop_strips(limbs, axes, limb_options.least_escape);
    clock.stop("Radii", limbs.size());

    TwigOptions twig_options;
    twig_options.minimum_branch = limb_options.minimum_branch;
    twig_options.least_escape = std::max(kTwigEscape, kNoiseEscape * std::max(noise_of(axes), options.noise));
    if (options.one_stem) twig_options.least_escape = std::numeric_limits<double>::max();
    PointPlaces places =
        add_twigs(points, graph, first_scale, paths, slices, twig_options, limbs, axes, progress);
    clock.stop("Twigs", limbs.size());

    progress.update(0.9, "Refinement");
    infer_radii(axes, limbs);
    refine_axes(axes, limbs, places_of_sample(thinned, places), thinned.measured(), progress, options.noise);
    if (options.fit_radii) known.tell(axes);
    seat_root(limbs, axes);
    if (!root.lying) limit_foot(axes.front());
    infer_radii(axes, limbs, true);
    if (options.one_stem) keep_width(axes.front());
    // Twigs that now lie on the bark of others were none.
    drop_strips(limbs, axes, 0.5 * twig_options.least_escape);
    draw_back_tips(axes, limbs, limb_options.minimum_branch);
    clock.stop("Refinement", limbs.size());

    result.warnings = gap_warnings(axes, limbs, extent, factor);

    progress.update(0.95, "Simplification");
    result.tree = assemble_tree(axes, limbs, options.simplify_distance);
    mark_trunk(result.tree);
    result.tree.set_frame(cloud.frame);
    const DVec3 base = result.tree.node(result.tree.root()).position;
    result.tree.rebase(base);
    if (options.keep_raw) {
        result.raw.set_frame(cloud.frame);
        result.raw.rebase(base);
    }
    clock.stop("Simplification", result.tree.size());
    progress.update(1.0, "Skeleton");
    return result;
}

// All lengths back to those of the cloud that was enlarged, whose frame is given.
void shrink(SkeletonResult& result, const ScanFrame& frame, double factor) {
    const double back = 1.0 / factor;
    for (Tree* tree : {&result.tree, &result.raw}) {
        if (tree->size() == 0) continue;
        tree->scale(back);
        tree->set_frame({tree->frame().origin, frame.metres_per_unit, frame.up, frame.tilt});
    }
    result.spacing *= back;
    result.voxel *= back;
    for (FloodStep& step : result.steps) {
        step.position *= back;
        for (Vec3& voxel : step.voxels)
            voxel = Vec3(DVec3(voxel) * back);
        for (FloodDirection& direction : step.directions) {
            direction.length *= back;
            direction.radius *= back;
        }
    }
}

}  // namespace

SkeletonResult skeletonize(const PointCloud& cloud, const SkeletonOptions& options, Progress* listener) {
    const double factor = enlargement_to_usual(cloud.positions);
    if (factor == 1.0) return skeletonize_sized(cloud, options, factor, listener);
    SkeletonOptions sized = options;
    sized.voxel *= factor;
    sized.spacing *= factor;
    sized.minimum_branch *= factor;
    sized.simplify_distance *= factor;
    sized.noise *= factor;
    if (sized.foot) *sized.foot *= factor;
    SkeletonResult result = skeletonize_sized(enlarged(cloud, factor), sized, factor, listener);
    shrink(result, cloud.frame, factor);
    // As they were stated.
    if (options.spacing > 0.0) result.spacing = options.spacing;
    if (options.voxel > 0.0) result.voxel = options.voxel;
    return result;
}

}  // namespace treerec
