#include "completion/complete.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

#include "geometry/capsule_tree.h"
#include "geometry/portable_math.h"
#include "skeleton/cylinders/bark.h"
#include "skeleton/cylinders/radii.h"
#include "skeleton/flood/flood_branches.h"
#include "skeleton/sampling/thin.h"
#include "skeleton/simplify/assemble.h"
#include "tree/wood_segments.h"

namespace treerec {

namespace {

constexpr double kTolerance = 0.02;   // metres
constexpr double kReachShare = 0.1;   // of the tree's size
constexpr double kMostAngle = 1.5;    // radians
constexpr double kAside = 2.0;        // a place straight aside counts as so many times farther, and once
constexpr double kGapVoxels = 6.0;    // the flood crosses gaps so wide,
constexpr double kStartVoxels = 4.0;  // and a first step so long over nothing is a guess
constexpr double kStripVoxels = 1.5;  // what reaches less far out of the new bark is bark,
constexpr double kShortest = 0.1;     // metres: a shorter side branch is noise
constexpr size_t kLeastPoints = 4;
constexpr size_t kGrain = 2048;  // points between two looks at the cancel flag

std::vector<Vec3> in_tree(const Tree& tree, const PointCloud& cloud, const std::vector<uint8_t>& wood,
                          const Progress& progress) {
    std::vector<Vec3> points;
    points.reserve(cloud.size());
    for (size_t i = 0; i < cloud.size(); i++) {
        if (i % kGrain == 0) progress.check();
        const Vec3& p = cloud.positions[i];
        if (!wood.empty() && wood[i] == 0) continue;
        const DVec3 place = tree.frame().to_tree(cloud.frame.to_scan(DVec3(p)));
        if (std::isfinite(place.x + place.y + place.z)) points.emplace_back(place);
    }
    return points;
}

std::vector<Vec3> outside_of(const Tree& tree, const std::vector<Vec3>& points, double tolerance,
                             const Progress& progress) {
    const CapsuleTree wood(wood_segments(tree));
    if (wood.empty()) return points;
    std::vector<Vec3> left;
    int32_t hint = -1;
    for (size_t i = 0; i < points.size(); i++) {
        if (i % kGrain == 0) progress.check();
        const DVec3 p(points[i]);
        const CapsuleTree::Hit axis = wood.nearest_axis(p, hint);
        hint = axis.segment;
        if (axis.distance <= wood.segment(axis.segment).radius + tolerance) continue;
        int32_t nearest = hint;
        if (wood.surface_distance(p, nearest) > tolerance) left.push_back(points[i]);
    }
    return left;
}

std::string nothing_there(double reach) {
    std::array<char, 200> text;
    std::snprintf(
        text.data(), text.size(),
        "No points that the tree does not explain lie within %.2f m of this node in that direction. "
        "Point closer to the missing branch, or choose a node nearer to it.",
        reach);
    return text.data();
}

// The voxel where the flood starts: the nearest to the node along the direction; the grid's size for none.
size_t start_of(const FloodGrid& grid, const DVec3& from, const DVec3& direction, double reach,
                double angle) {
    size_t best = grid.size();
    double least = 0.0;
    for (size_t v = 0; v < grid.size(); v++) {
        const DVec3 way = DVec3(grid.means[v]) - from;
        const double distance = glm::length(way);
        if (distance > reach) continue;
        const double along = distance > 0.0 ? glm::dot(way, direction) / distance : 1.0;
        if (along < portable::cos(angle)) continue;
        const double cost = distance * (1.0 + kAside * (1.0 - along));
        if (best < grid.size() && cost >= least) continue;
        best = v;
        least = cost;
    }
    return best;
}

void require(const CompleteOptions& options) {
    for (const double value : {options.tolerance, options.voxel, options.reach})
        if (!(value >= 0.0) || !std::isfinite(value))
            throw Error("The lengths of a completion must be finite and not negative.");
    if (!(options.angle > 0.0) || options.angle > kMostAngle)
        throw Error("The angle of a completion must lie above 0 and be at most 1.5 radians.");
}

// How far outside of all bark p lies, metres.
double outside(const Tree& tree, const DVec3& p) {
    const CapsuleTree wood(wood_segments(tree));
    int32_t hint = -1;
    return wood.empty() ? std::numeric_limits<double>::max() : wood.surface_distance(p, hint);
}

}  // namespace

Completer::Completer(const Tree& tree, const PointCloud& cloud, const CompleteOptions& options,
                     const std::vector<uint8_t>& wood, Progress* listener)
    : options_(options) {
    require(options);
    if (!wood.empty() && wood.size() != cloud.size())
        throw Error("There must be one mark of wood for each of the cloud's points.");
    SubProgress progress(listener, 0.0, 1.0);
    progress.update(0.0, "Unexplained points");
    left_ = in_tree(tree, cloud, wood, progress);
    if (left_.empty()) throw Error("The cloud has no points of wood.");
    if (options_.tolerance <= 0.0) options_.tolerance = kTolerance;
    const double spacing = automatic_spacing(left_, &progress);
    left_ =
        thin_points(left_, options.voxel > 0.0 ? std::min(spacing, 0.5 * options.voxel) : spacing, progress);
    voxel_ = options.voxel > 0.0 ? options.voxel : automatic_voxel(left_, spacing, false, progress);
    if (!(voxel_ > 0.0)) throw Error("The cloud's points all lie in one place.");
    left_ = outside_of(tree, left_, options_.tolerance, progress);
}

Completion Completer::complete(Tree& tree, NodeId node, const DVec3& direction, double reach,
                               Progress* listener) {
    if (!tree.contains(node)) throw Error("The tree has no node " + std::to_string(node) + ".");
    if (!(glm::length(direction) > 1e-9) || !std::isfinite(glm::length(direction)))
        throw Error("The direction of the missing branch has no length.");
    SubProgress progress(listener, 0.0, 1.0);
    progress.check();
    if (reach <= 0.0) reach = options_.reach;
    if (reach <= 0.0) reach = std::max(kReachShare * tree.bounds().diagonal(), 2.0 * voxel_);
    left_ = outside_of(tree, left_, options_.tolerance, progress);
    const std::vector<Vec3>& points = left_;
    const double voxel = voxel_;
    const double tolerance = options_.tolerance;
    if (points.size() < kLeastPoints) throw Error(nothing_there(reach));

    progress.update(0.5, "Flooding");
    const FloodGrid grid = FloodGrid::any_size(points, voxel, progress);
    const DVec3 from = tree.node(node).position;
    const DVec3 along = glm::normalize(direction);
    const size_t start = start_of(grid, from, along, reach, options_.angle);
    if (start == grid.size()) throw Error(nothing_there(reach));
    FloodOptions flood_options;
    flood_options.seed = options_.seed;
    flood_options.longest_gap = kGapVoxels * voxel;
    const FloodResult flooded =
        flood(grid, points, from, {static_cast<uint32_t>(start)}, flood_options, progress);

    progress.update(0.9, "Joining");
    FloodBranches made = flood_branches(flooded, grid, points.size());
    const bool guessed = outside(tree, DVec3(grid.means[start])) > std::max(tolerance, kStartVoxels * voxel);
    infer_radii(made.axes, made.branches);
    refine_axes(made.axes, made.branches, made.places, points, progress);
    infer_radii(made.axes, made.branches, true);
    Completion done;
    for (const int32_t place : made.places.branch)
        done.points += place >= 0;
    drop_strips(made.branches, made.axes, std::max(kTolerance, kStripVoxels * voxel));
    drop_short(made, std::max(kShortest, kGapVoxels * voxel));
    if (made.axes.front().size() < 2 || done.points < kLeastPoints) throw Error(nothing_there(reach));
    const Tree branch = assemble_tree(made.axes, made.branches, 0.0);
    progress.check();

    std::vector<NodeId> now(static_cast<size_t>(branch.id_end()), kNoNode);
    now[static_cast<size_t>(branch.root())] = node;
    for (const NodeId id : branch.depth_first()) {
        if (id == branch.root()) continue;
        const Node& grown = branch.node(id);
        const NodeId parent = now[static_cast<size_t>(grown.parent)];
        uint8_t flags = grown.flags;
        if (guessed && parent == node) flags |= kGuessFlag;
        const double radius = std::min(grown.radius, tree.node(parent).radius);
        done.length += glm::distance(grown.position, tree.node(parent).position);
        now[static_cast<size_t>(id)] = tree.add_child(parent, grown.position, radius, flags);
        done.added.push_back(now[static_cast<size_t>(id)]);
    }
    progress.update(1.0, "Joining");
    return done;
}

Completion complete_branch(Tree& tree, const PointCloud& cloud, NodeId node, const DVec3& direction,
                           const CompleteOptions& options, const std::vector<uint8_t>& wood,
                           Progress* listener) {
    SubProgress looking(listener, 0.0, 0.5);
    SubProgress flooding(listener, 0.5, 1.0);
    return Completer(tree, cloud, options, wood, &looking).complete(tree, node, direction, 0.0, &flooding);
}

std::string completion_script(const Tree& grown, const Completion& completion) {
    std::string script;
    for (const NodeId id : completion.added) {
        const Node& node = grown.node(id);
        const DVec3 way = node.position - grown.node(node.parent).position;
        std::array<char, 240> line;
        std::snprintf(line.data(), line.size(),
                      "grow node=%d direction=%.9f,%.9f,%.9f length=%.9f radius=%.9f\n", node.parent, way.x,
                      way.y, way.z, glm::length(way), node.radius);
        script += line.data();
    }
    return script;
}

}  // namespace treerec
