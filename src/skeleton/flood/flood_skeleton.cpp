#include "skeleton/flood/flood_skeleton.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <string>

#include "skeleton/cylinders/bark.h"
#include "skeleton/cylinders/radii.h"
#include "skeleton/cylinders/stem_base.h"
#include "skeleton/cylinders/tips.h"
#include "skeleton/flood/flood_branches.h"
#include "skeleton/flood/flood_paper.h"
#include "skeleton/flood/flood_twigs.h"
#include "skeleton/simplify/assemble.h"

namespace treerec {

namespace {

constexpr double kBranchVoxels = 1.5;   // what reaches less far out of the bark is bark
constexpr double kLeastEscape = 0.02;   // metres,
constexpr double kNoiseEscape = 2.5;    // and times the scan's noise, likewise
constexpr double kFineVoxel = 0.4;      // of the automatic size: the user is told of finer voxels
constexpr double kResolved = 2.0;       // points in a voxel
constexpr int kPasses = 2;              // the flood's nodes lie farther from the axis than slices do
constexpr double kThinnest = 0.001;     // metres
constexpr double kFewestPrinted = 8.0;  // voxels along an axis of the printed flood
constexpr double kCoarser = 1.3;        // times fewer in the next try
constexpr double kMostReached = 0.9;    // of the points: the user is told that the printed flood left more

// The flood's own tree, before anything is smoothed or left out.
Tree raw_tree(const std::vector<FloodNode>& nodes) {
    std::vector<NodeId> parents;
    std::vector<DVec3> positions;
    std::vector<double> radii;
    std::vector<uint8_t> flags;
    for (const FloodNode& node : nodes) {
        parents.push_back(node.parent);
        positions.push_back(node.position);
        radii.push_back(std::max(kThinnest, node.radius));
        flags.push_back(node.bridged ? kGuessFlag : 0);
    }
    return Tree::from_arrays(parents, positions, radii, flags);
}

std::vector<uint32_t> vertices_of(const std::vector<PathSeed>& seeds) {
    std::vector<uint32_t> vertices;
    for (const PathSeed& seed : seeds)
        vertices.push_back(seed.vertex);
    return vertices;
}

// A solid's points tell its radius, but lie on no surface that could be fitted.
void trust_radii(std::vector<std::vector<Station>>& axes, double voxel) {
    for (std::vector<Station>& line : axes)
        for (Station& station : line)
            station.measured = station.radius > voxel;
}

// The tree that the printed flood makes of the points, which the wood found so far fills where they are its
// skin. Nothing of it is fitted again or left out.
Tree printed_tree(const std::vector<Vec3>& points, const DVec3& root, const SkeletonOptions& options,
                  SkeletonResult& result, std::vector<FloodStep>& steps, Progress& progress) {
    const std::vector<Vec3> filled =
        result.kind == CloudKind::kSolid
            ? points
            : filled_solid(points, result.tree, result.spacing, result.voxel, options.seed);
    Bounds bounds;
    for (const Vec3& p : filled)
        bounds.add(DVec3(p));
    const DVec3 size = bounds.size();
    const double extent = std::max({size.x, size.y, size.z});
    // As small as continuity allows (5.1), where the user says nothing: a slender tree's are far narrower
    // across.
    PaperFlood found;
    for (double dimension = std::ceil(extent / result.voxel); dimension >= kFewestPrinted;
         dimension = std::floor(dimension / kCoarser)) {
        PaperFloodOptions printed;
        printed.dimension = static_cast<int>(dimension);
        printed.keep_steps = options.keep_steps;
        PaperFlood tried = flood_as_printed(filled, root, printed, progress);
        if (found.flooded.nodes.empty() || tried.reached > found.reached) {
            found = std::move(tried);
            result.voxel = extent / dimension;
        }
        if (found.reached >= kMostReached || options.voxel > 0.0) break;
    }
    std::vector<FloodNode>& nodes = found.flooded.nodes;
    if (nodes.size() < 2)
        throw Error(
            "The flood as printed finds no point beside the root: the voxels around it are empty. Take "
            "larger "
            "ones, or our own flood.");
    nodes[0].radius = nodes[1].radius;
    if (found.reached < kMostReached)
        result.warnings.push_back("The flood as printed ended early: it reached " +
                                  std::to_string(std::lround(100.0 * found.reached)) +
                                  " % of the points. It goes over no gap, and not on where a node lies "
                                  "beside the wood.");
    steps = std::move(found.flooded.steps);
    return raw_tree(nodes);
}

std::string fine_voxel_warning(double fitting) {
    std::array<char, 200> text;
    std::snprintf(
        text.data(), text.size(),
        "The voxels are finer than the scan's points are apart, so that wood falls to pieces and its "
        "thickness cannot be told; take about %.0f mm.",
        1e3 * fitting);
    return text.data();
}

// The voxels that are flooded, of the stated size or one that fits.
FloodGrid make_grid(SkeletonWork& work, Progress& progress) {
    SkeletonResult& result = work.result;
    const double fitting = automatic_voxel(work.points(), result.spacing, work.options.one_stem, progress);
    result.voxel = work.options.voxel > 0.0 ? work.options.voxel : fitting;
    if (result.voxel < kFineVoxel * fitting)
        result.warnings.push_back(fine_voxel_warning(fitting / work.factor));
    FloodGrid grid(work.points(), result.voxel, progress);
    progress.check();
    return grid;
}

// Finer branches, better axes and radii, and none of the branches that are bark or noise.
void refine_branches(SkeletonWork& work, const FloodGrid& grid, bool solid, FloodBranches& made,
                     Progress& progress) {
    const std::vector<Vec3>& points = work.points();
    const SkeletonOptions& options = work.options;
    const double voxel = work.result.voxel;
    const double least_branch = work.least_branch();
    if (solid) trust_radii(made.axes, voxel);
    infer_radii(made.axes, made.branches);
    const double noise = std::max(noise_of(made.axes), options.noise);
    const double escape = std::max({kLeastEscape, kBranchVoxels * voxel, kNoiseEscape * noise});
    double least_escape = escape;
    // Voxels that hold several points are fine enough for the wood.
    const bool sparse = static_cast<double>(points.size()) < kResolved * static_cast<double>(grid.size());
    if (sparse && !options.one_stem) {
        // Voxels are too coarse to tell a short branch from a strip of bark, but what is left over then is
        // finer.
        drop_flood_strips(made, escape);
        work.twig_options.minimum_branch = least_branch;
        work.twig_options.least_escape = std::max(kLeastEscape, kNoiseEscape * noise);
        add_flood_twigs(points, grid, work.scale, work.root, work.twig_options, made, progress);
        infer_radii(made.axes, made.branches);
        least_escape = 0.5 * work.twig_options.least_escape;
    }
    if (options.fit_radii && !solid) {
        for (int pass = 0; pass < kPasses; pass++) {
            refine_axes(made.axes, made.branches, made.places, points, progress, options.noise);
            infer_radii(made.axes, made.branches);
        }
        KnownRadii(work.cloud, work.result.spacing, &progress).tell(made.axes);
        if (!work.root.lying) limit_stem_base(made.axes.front());
        infer_radii(made.axes, made.branches, true);
    }
    drop_strips(made.branches, made.axes, least_escape);
    // Around wood that is thicker than a voxel, the flood's first lines lie too far from the axis for that.
    drop_beside_stout(made, voxel, escape);
    drop_short(made, least_branch);
    draw_back_tips(made.axes, made.branches, least_branch);
}

}  // namespace

void flood_skeleton(SkeletonWork& work) {
    const std::vector<Vec3>& points = work.points();
    const SkeletonOptions& options = work.options;
    SkeletonResult& result = work.result;
    SubProgress gridding(work.listener, 0.1, 0.4);
    gridding.update(0.0, "Voxels");
    const FloodGrid grid = make_grid(work, gridding);
    work.scale = local_scale(grid.graph, result.voxel);
    work.root = find_root(grid.means, grid.graph, work.scale, options.stem_base, gridding);
    work.clock.stop("Voxels", grid.size());

    SubProgress flooding(work.listener, 0.4, 0.8);
    flooding.update(0.0, "Flooding");
    FloodOptions flood_options;
    flood_options.seed = options.seed;
    flood_options.keep_steps = options.keep_steps;
    FloodResult flooded =
        flood(grid, points, work.root.position, vertices_of(work.root.seeds), flood_options, flooding);
    if (options.keep_raw) result.raw = raw_tree(flooded.nodes);
    result.kind = flooded.kind;
    result.kind_told = flooded.kind_told;
    work.clock.stop("Flooding", flooded.nodes.size());

    SubProgress fitting(work.listener, 0.8, 0.95);
    fitting.update(0.0, "Refinement");
    FloodBranches made = flood_branches(flooded, grid, points.size());
    if (options.one_stem) {
        made.branches.resize(1);
        made.axes.resize(1);
        for (int32_t& branch : made.places.branch)
            if (branch > 0) branch = -1;
    }
    work.extent = extent_from(points, work.root.position);
    refine_branches(work, grid, flooded.kind == CloudKind::kSolid, made, fitting);
    work.clock.stop("Refinement", made.branches.size());

    fitting.update(1.0, "Simplification");
    result.tree = assemble_tree(made.axes, made.branches, options.simplify_distance);
    if (options.flood == FloodKind::kPaper) {
        result.tree = printed_tree(points, work.root.position, options, result, flooded.steps, fitting);
        if (options.keep_raw) result.raw = result.tree;
    }
    result.steps = std::move(flooded.steps);
    const DVec3 base = finish(work);
    for (FloodStep& step : result.steps) {
        step.position -= base;
        for (Vec3& voxel : step.voxels)
            voxel = Vec3(DVec3(voxel) - base);
    }
}

}  // namespace treerec
