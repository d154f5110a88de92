#include "tree/measure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "geometry/portable_math.h"
#include "tree/branches.h"

namespace treerec {

namespace {

// A stem must be at least this thick beside the main one: a low branch is no stem.
constexpr double kStemShare = 0.5;
constexpr int kCrownDirections = 36;

double lerp(double a, double b, double t) {
    return a + (b - a) * t;
}

// The radii of all wood at `distance` metres from the root along the wood; the main path's comes first.
std::vector<double> radii_at_distance(const Tree& tree, const BranchList& list, double distance) {
    std::vector<double> along(static_cast<size_t>(tree.id_end()), 0.0);
    std::vector<double> found;
    // Branch by branch: the first branch is the main path.
    for (const Branch& branch : list.branches) {
        for (NodeId id : list.nodes_of(branch)) {
            const Node& node = tree.node(id);
            if (node.parent == kNoNode) continue;
            const Node& parent = tree.node(node.parent);
            const double from = along[node.parent];
            const double to = from + glm::distance(parent.position, node.position);
            along[id] = to;
            if (from > distance || to <= distance) continue;
            // A side branch starts with its own thickness, not with that of the wood it grows from.
            const bool starts_branch = node.parent == branch.attach;
            const double start = starts_branch ? node.radius : parent.radius;
            found.push_back(lerp(start, node.radius, (distance - from) / (to - from)));
        }
    }
    return found;
}

void measure_stems(const Tree& tree, const BranchList& list, Measurements& result) {
    const std::vector<double> radii = radii_at_distance(tree, list, kBreastHeight);
    if (radii.empty()) return;
    const double thickest = *std::max_element(radii.begin(), radii.end());
    result.dbh = 2.0 * thickest;
    for (double radius : radii)
        result.stems += radius >= kStemShare * thickest;
}

// The mean over directions of how far the crown reaches from its vertical axis, which goes through the
// middle of the wood above the first fork (weighted by length).
void measure_crown(const Tree& tree, const BranchList& list, Measurements& result) {
    const DVec3 base = tree.node(tree.root()).position;
    for (NodeId id : list.nodes_of(list.branches.front())) {
        result.crown_base = tree.node(id).position.y - base.y;
        if (tree.node(id).child_count > 1) break;
    }
    const double crown_y = base.y + result.crown_base;
    DVec2 axis(0.0);
    double weight = 0.0;
    std::vector<DVec2> crown;
    crown.reserve(tree.size());
    for (NodeId id : list.nodes) {
        const Node& node = tree.node(id);
        if (node.position.y < crown_y) continue;
        const DVec2 flat(node.position.x, node.position.z);
        crown.push_back(flat);
        if (node.parent == kNoNode) continue;
        const double length = glm::distance(node.position, tree.node(node.parent).position);
        axis += length * flat;
        weight += length;
    }
    if (weight <= 0.0) return;
    axis /= weight;
    std::array<double, kCrownDirections> x, y, reach{};
    for (int i = 0; i < kCrownDirections; i++) {
        const double angle = 2.0 * kPi * i / kCrownDirections;
        x[i] = portable::cos(angle);
        y[i] = portable::sin(angle);
    }
    // All directions for one point after another: none waits for the one before.
    for (const DVec2& p : crown) {
        const DVec2 off = p - axis;
        for (int i = 0; i < kCrownDirections; i++) {
            const double along = off.x * x[i] + off.y * y[i];
            reach[i] = reach[i] < along ? along : reach[i];
        }
    }
    result.crown_radius = std::accumulate(reach.begin(), reach.end(), 0.0) / kCrownDirections;
}

}  // namespace

Measurements measure(const Tree& tree) {
    Measurements result;
    if (tree.empty()) return result;
    const BranchList list = list_branches(tree);
    result.nodes = tree.size();
    double lowest = tree.node(tree.root()).position.y;
    double highest = lowest;
    double measured = 0.0, measured_volume = 0.0;
    for (const Branch& branch : list.branches) {
        if (static_cast<size_t>(branch.order) >= result.by_order.size())
            result.by_order.resize(static_cast<size_t>(branch.order) + 1);
        result.by_order[branch.order].branches++;
        result.by_order[branch.order].length += branch.length;
        for (NodeId id : list.nodes_of(branch)) {
            const Node& node = tree.node(id);
            lowest = std::min(lowest, node.position.y);
            highest = std::max(highest, node.position.y);
            result.tips += node.child_count == 0;
            if (node.parent == kNoNode) continue;
            const Node& parent = tree.node(node.parent);
            const double length = glm::distance(node.position, parent.position);
            const double start = node.parent == branch.attach ? node.radius : parent.radius;
            result.total_length += length;
            const double volume =
                kPi / 3.0 * length * (start * start + start * node.radius + node.radius * node.radius);
            result.volume += volume;
            if (!node.is_measured()) continue;
            measured += length;
            measured_volume += volume;
        }
    }
    result.height = highest - lowest;
    result.measured_volume_share = result.volume > 0.0 ? measured_volume / result.volume : 0.0;
    result.measured_share = result.total_length > 0.0 ? measured / result.total_length : 0.0;
    const double base = tree.node(tree.root()).position.y;
    if (highest - base >= kBreastHeight) measure_stems(tree, list, result);
    measure_crown(tree, list, result);
    return result;
}

}  // namespace treerec
