// Branches removed from grown trees and drawn anew over their scans: for the tests, and ./dev bench
// --branches.
#pragma once

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include "edit/commands/commands.h"
#include "geometry/quantile.h"
#include "geometry/random.h"
#include "geometry/segment.h"
#include "skeleton/skeleton.h"
#include "sketch/branch_statistics.h"
#include "sketch/sketch_branch.h"
#include "synth/grow.h"
#include "synth/scan.h"

namespace treerec::branch_trials {

struct Trial {
    Tree truth;
    Tree tree;                     // without the branch
    PointCloud cloud;              // of the whole
    PointCloud cloud_cut;          // without the branch's points
    NodeId side_branch = kNoNode;  // its lowest node, of the truth
    NodeId attach = kNoNode;
    std::vector<DVec3> axis;    // from the host's node on
    std::vector<uint8_t> seen;  // of each place of the axis but the first, whether the cloud has points there
    BranchStroke stroke;
    bool reconstructed = false;
};

inline double distance_to_line(const DVec3& p, const std::vector<DVec3>& line) {
    double least = 1e300;
    for (size_t i = 1; i < line.size(); i++)
        least = std::min(least, distance_to_segment(p, line[i - 1], line[i]));
    return least;
}

// A camera `distance` away that looks at the middle of the tree, 1000 pixels high, which the tree about fills
// from 1.2 heights away.
inline PinholeView camera_at(const Tree& tree, double azimuth, double elevation, double distance) {
    const Bounds box = tree.bounds();
    const double height = box.max.y - box.min.y;
    const DVec3 middle(0.0, 0.5 * (box.min.y + box.max.y), 0.0);
    PinholeView view;
    const DVec3 back(std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
                     std::cos(elevation) * std::cos(azimuth));
    const DVec3 right = glm::normalize(glm::cross(DVec3(0.0, 1.0, 0.0), back));
    view.turn = DMat3(right, glm::cross(back, right), back);
    view.centre = middle + back * (distance * height);
    view.focal = 1000.0;
    view.width = view.height = 1000;
    view.principal = DVec2(500.0, 500.0);
    return view;
}

// One of the trunk's stouter branches; nothing where the tree has none. reconstructed: the tree that lacks it
// is made from the scan without it, instead of cut from the true one.
inline std::optional<Trial> make_trial(Habit habit, uint64_t seed, double jitter = 3.0, size_t points = 60000,
                                       bool reconstructed = false) {
    Trial trial;
    trial.truth = grow_tree({habit, 0.0, seed});
    const BranchList list = list_branches(trial.truth);
    std::vector<size_t> side_branches;
    double longest = 0.0;
    for (const Branch& branch : list.branches)
        if (branch.order == 1) longest = std::max(longest, branch.length);
    for (size_t i = 0; i < list.branches.size(); i++)
        if (list.branches[i].order == 1 && list.branches[i].length > 0.4 * longest)
            side_branches.push_back(i);
    if (side_branches.empty()) return std::nullopt;
    Random random(hash_seed(seed, 5), 9);
    const Branch& branch =
        list.branches[side_branches[random.below(static_cast<uint32_t>(side_branches.size()))]];
    trial.side_branch = list.nodes_of(branch)[0];
    trial.attach = branch.attach;
    trial.axis.push_back(trial.truth.node(branch.attach).position);
    for (const NodeId id : list.nodes_of(branch))
        trial.axis.push_back(trial.truth.node(id).position);

    VirtualScanOptions scanning = scan_options_for(habit);
    scanning.points = points;
    scanning.seed = seed;
    const VirtualScan scan = scan_tree(trial.truth, scanning);
    trial.cloud = scan.cloud;
    trial.tree = trial.truth;
    std::vector<uint8_t> gone(static_cast<size_t>(trial.truth.id_end()), 0);
    for (const NodeId id : trial.tree.remove_subtree(trial.side_branch))
        gone[static_cast<size_t>(id)] = 1;
    trial.cloud_cut.frame = scan.cloud.frame;
    std::vector<DVec3> own;
    std::vector<uint8_t> on_axis(static_cast<size_t>(trial.truth.id_end()), 0);
    for (const NodeId id : list.nodes_of(branch))
        on_axis[static_cast<size_t>(id)] = 1;
    for (size_t i = 0; i < scan.cloud.size(); i++) {
        const NodeId id = scan.node[i];
        if (id != kNoNode && gone[static_cast<size_t>(id)]) {
            if (on_axis[static_cast<size_t>(id)]) own.emplace_back(scan.cloud.positions[i]);
        } else {
            trial.cloud_cut.positions.push_back(scan.cloud.positions[i]);
        }
    }
    trial.reconstructed = reconstructed;
    if (reconstructed) {
        // In the frame of the truth, so that places can be compared.
        trial.tree = skeletonize(trial.cloud_cut, {}).tree;
        for (const NodeId id : trial.tree.depth_first()) {
            const DVec3 place = trial.tree.frame().to_scan(trial.tree.node(id).position);
            trial.tree.set_position(id, trial.truth.frame().to_tree(place));
        }
        trial.tree.set_frame(trial.truth.frame());
    }
    for (size_t i = 1; i < trial.axis.size(); i++) {
        size_t near = 0;
        for (const DVec3& p : own)
            near += glm::distance(p, trial.axis[i]) < 0.12 ? 1 : 0;
        trial.seen.push_back(near >= 2 ? 1 : 0);
    }

    trial.stroke.view = camera_at(trial.truth, random.uniform(0.0, 2.0 * kPi),
                                  random.uniform(0.0, 40.0) * kPi / 180.0, random.uniform(1.2, 2.5));
    // As a mouse reports it: every few pixels.
    double left = 0.0;
    for (size_t i = 1; i < trial.axis.size(); i++) {
        const auto a = trial.stroke.view.project(trial.axis[i - 1]);
        const auto b = trial.stroke.view.project(trial.axis[i]);
        const double length = glm::length(*b - *a);
        for (; left <= length; left += 5.0)
            trial.stroke.points.push_back(*a + (*b - *a) * (left / length) +
                                          jitter * DVec2(random.normal(), random.normal()));
        left -= length;
    }
    if (random.below(2) == 1) std::reverse(trial.stroke.points.begin(), trial.stroke.points.end());
    return trial;
}

struct Spread {
    double mean = 0.0, median = 0.0;
    size_t count = 0;
};

inline Spread spread_of(std::vector<double> values) {
    Spread spread;
    spread.count = values.size();
    if (values.empty()) return spread;
    spread.mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
    spread.median = quantile(values, 0.5);
    return spread;
}

inline double off(double value, double reference) {
    return reference > 0.0 ? std::abs(value / reference - 1.0) : 0.0;
}

struct Figures {
    bool host = false;      // the branch that it hangs on is the right one,
    double host_off = 0.0;  // and the node so many metres off
    double within = 0.0;    // share of the axis where points are that was drawn within 5 cm
    double measured_right =
        0.0;  // share of what was said to be measured that is within 5 cm of the true axis
    double measured = 0.0;
    double angle = 0.0;  // degrees between the chords
    double length_ratio = 0.0;
    double radius_ratio = 0.0;
    Spread angles, angles_own, internodes, internodes_own;
};

inline Figures judge(const Trial& trial, const SketchedBranch& side_branch) {
    Figures figures;
    std::vector<DVec3> drawn;
    for (const BranchPlace& place : side_branch.axis)
        drawn.push_back(place.position);
    const BranchList list = list_branches(trial.tree);
    figures.host_off = glm::distance(trial.tree.node(side_branch.host).position, trial.axis.front());
    figures.host = trial.reconstructed ? figures.host_off < 0.3
                                       : list.branch_of[static_cast<size_t>(side_branch.host)] ==
                                             list.branch_of[static_cast<size_t>(trial.attach)];
    size_t seen = 0, within = 0;
    for (size_t i = 0; i < trial.seen.size(); i++) {
        if (!trial.seen[i]) continue;
        seen++;
        within += distance_to_line(trial.axis[i + 1], drawn) <= 0.05 ? 1 : 0;
    }
    figures.within = seen > 0 ? static_cast<double>(within) / static_cast<double>(seen) : 1.0;
    size_t told = 0, right = 0;
    for (const BranchPlace& place : side_branch.axis) {
        if (!place.measured) continue;
        told++;
        right += distance_to_line(place.position, trial.axis) <= 0.05 ? 1 : 0;
    }
    figures.measured_right = told > 0 ? static_cast<double>(right) / static_cast<double>(told) : 1.0;
    figures.measured = side_branch.measured;
    const DVec3 a = trial.axis.back() - trial.axis.front();
    const DVec3 b = drawn.back() - drawn.front();
    figures.angle =
        std::acos(std::clamp(glm::dot(a, b) / (glm::length(a) * glm::length(b)), -1.0, 1.0)) * 180.0 / kPi;
    double length = 0.0;
    for (size_t i = 1; i < trial.axis.size(); i++)
        length += glm::distance(trial.axis[i], trial.axis[i - 1]);
    figures.length_ratio = side_branch.length / length;
    figures.radius_ratio = side_branch.axis.front().radius / trial.truth.node(trial.side_branch).radius;

    // Twigs of the branch as it stands in the tree, beside those of its kindred.
    Tree grown = trial.tree;
    const Edit edit = perform(grown, side_branch.command);
    const BranchStatistics after(grown);
    const int32_t branch = after.list().branch_of[static_cast<size_t>(edit.outcome.nodes.front())];
    const BranchStatistics before(trial.tree);
    const int32_t order = after.list().branches[static_cast<size_t>(branch)].order;
    std::vector<double> angles, internodes, angles_own, internodes_own;
    for (const SideBranch& side : after.sides(branch)) {
        angles.push_back(side.angle);
        if (!side.first) internodes.push_back(side.internode);
    }
    for (const int32_t kin : before.kindred(order, side_branch.axis.front().radius))
        for (const SideBranch& side : before.sides(kin)) {
            angles_own.push_back(side.angle);
            if (!side.first) internodes_own.push_back(side.internode);
        }
    figures.angles = spread_of(angles);
    figures.angles_own = spread_of(angles_own);
    figures.internodes = spread_of(internodes);
    figures.internodes_own = spread_of(internodes_own);
    return figures;
}

}  // namespace treerec::branch_trials
