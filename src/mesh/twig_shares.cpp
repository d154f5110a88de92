#include "mesh/twig_shares.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "geometry/portable_math.h"
#include "geometry/random.h"
#include "mesh/levels.h"

namespace treerec {

namespace {

constexpr double kGolden = 0.61803398874989485;
constexpr double kMeanRadius = 0.6;  // of a twig, over that of its base
constexpr double kLength = 0.005;    // over the tree's height, doubled per level: shorter twigs are fewer
constexpr double kWidest = 1.5;      // over level_width(): as wide on average a twig is drawn at most,
constexpr double kStubbiest = 0.15;  // and over its own length
constexpr double kHidden = 0.5;      // of what bears it: how wide a twig starts
constexpr double kPointed = 0.004;   // metres: thinner twigs run out in a point
constexpr double kThin = 0.006,
                 kThinSides = 0.87;  // metres; how wide a tube of so few sides looks, beside one
constexpr double kSlim = 0.012, kSlimSides = 0.94;  // of many
constexpr double kEnds = 1.4, kLeastEnds = 0.4;     // nodes of a branch whose width its two ends lose
constexpr int kRounds = 8;                          // of handing on what is too much for one
constexpr uint64_t kSeed = 0x7e1f;

// Which of the branches stay: standing[i] is 1, else 0.
void choose(const Tree& tree, const BranchList& list, double width, double length,
            std::vector<float>& standing) {
    const size_t count = list.branches.size();
    // No larger than those of what bears it, so that no share rises with the coarseness.
    std::vector<double> radius(count), reach(count), share(count, 1.0);
    std::vector<uint32_t> borne(count, 0);  // branches on it that were met so far
    for (size_t i = 0; i < count; i++) {
        const Branch& branch = list.branches[i];
        radius[i] = kMeanRadius * tree.node(list.nodes[branch.begin]).radius;
        reach[i] = branch.length;
        if (branch.attach == kNoNode) {
            radius[i] = reach[i] = std::numeric_limits<double>::max();
            continue;
        }
        const size_t host = static_cast<size_t>(branch.parent);
        radius[i] = std::min(radius[i], radius[host]);
        reach[i] = std::min(reach[i], reach[host]);
        if (standing[host] == 0.0f) {
            standing[i] = 0.0f;
            continue;
        }
        share[i] = std::min(2.0 * radius[i] / width, 1.0) * std::min(reach[i] / length, 1.0);
        // Multiples of the golden ratio spread evenly, so that every stretch of a branch keeps its share.
        const NodeId tip = list.nodes[list.branches[host].end - 1];
        const double start =
            static_cast<double>(hash_seed(kSeed, static_cast<uint64_t>(tip)) >> 11) * 0x1p-53;
        const double turn = start + kGolden * borne[host]++;
        if (turn - std::floor(turn) >= share[i] / share[host]) standing[i] = 0.0f;
    }
}

// By branch that stands: how many times the area of all on it, where that of its siblings that don't stand is
// shared out to those that are nearest along what bears them all.
std::vector<double> gather(const BranchList& list, const std::vector<float>& standing,
                           const std::vector<double>& all) {
    const size_t count = list.branches.size();
    std::vector<int32_t> place(list.branch_of.size(), 0);  // by node id: its place along its branch
    for (size_t i = 0; i < list.nodes.size(); i++)
        place[list.nodes[i]] = static_cast<int32_t>(i);
    std::vector<size_t> order;
    for (size_t i = 0; i < count; i++)
        if (list.branches[i].parent >= 0) order.push_back(i);
    const auto place_of = [&](size_t i) { return place[list.branches[i].attach]; };
    // Each branch's nodes are one range, so this brings siblings together, too.
    std::sort(order.begin(), order.end(), [&](size_t a, size_t b) {
        return place_of(a) != place_of(b) ? place_of(a) < place_of(b) : a < b;
    });
    std::vector<double> gathered(all);
    for (size_t begin = 0; begin < order.size();) {
        size_t end = begin;
        const int32_t host = list.branches[order[begin]].parent;
        while (end < order.size() && list.branches[order[end]].parent == host)
            end++;
        size_t before = end, after = begin;
        for (size_t i = begin; i < end; i++) {
            if (standing[order[i]] != 0.0f) {
                before = i;
                continue;
            }
            after = std::max(after, i);
            while (after < end && standing[order[after]] == 0.0f)
                after++;
            const bool has_before = before != end, has_after = after != end;
            if (!has_before && !has_after) break;
            const bool to_before =
                has_before && (!has_after || place_of(order[i]) - place_of(order[before]) <=
                                                 place_of(order[after]) - place_of(order[i]));
            gathered[order[to_before ? before : after]] += all[order[i]];
        }
        begin = end;
    }
    for (size_t i = 0; i < count; i++)
        gathered[i] = all[i] > 0.0 ? gathered[i] / all[i] : 1.0;
    return gathered;
}

}  // namespace

double drawn_area(const Tree& tree, const BranchList& list, const Branch& branch) {
    double area = 0.0;
    NodeId before = branch.attach;
    const std::span<const NodeId> nodes = list.nodes_of(branch);
    for (const NodeId id : nodes) {
        if (before != kNoNode) {
            const Node& node = tree.node(id);
            double below = tree.node(before).radius, above = node.radius;
            if (before == branch.attach) below = std::min(kHidden * below, above);
            if (id == nodes.back() && above < kPointed) above = 0.0;
            area += (below + above) * glm::distance(tree.node(before).position, node.position);
        }
        before = id;
    }
    const double radius = tree.node(nodes.front()).radius;
    const double sides = radius < kThin ? kThinSides : radius < kSlim ? kSlimSides : 1.0;
    if (branch.attach == kNoNode) return area * sides;
    return area * sides * std::max(1.0 - kEnds / static_cast<double>(nodes.size()), kLeastEnds);
}

std::vector<float> share_twigs(const Tree& tree, const BranchList& list, const Crown& crown,
                               double coarseness) {
    const size_t count = list.branches.size();
    std::vector<float> standing(count, 1.0f);
    if (coarseness <= 0.0) return standing;
    const double begun = std::min(coarseness, 1.0);  // so that the first twigs that go are the thinnest
    const double width = begun * level_width(crown.height, coarseness);
    choose(tree, list, width, begun * kLength * crown.height * portable::pow(2.0, coarseness), standing);

    // What goes is drawn by what stays beside it, or else by what bore it: nothing is lost.
    std::vector<double> area(count), all(count), borne(count, 0.0), kept(count, 0.0);
    for (size_t i = count; i-- > 0;) {  // children before parents
        area[i] = drawn_area(tree, list, list.branches[i]);
        all[i] = area[i] + borne[i];
        if (list.branches[i].parent < 0) continue;
        const size_t host = static_cast<size_t>(list.branches[i].parent);
        borne[host] += all[i];
        if (standing[i] != 0.0f) kept[host] += all[i];
    }
    const std::vector<double> gathered = gather(list, standing, all);
    std::vector<double> factor(count, 1.0);
    for (size_t i = 0; i < count; i++) {
        if (standing[i] == 0.0f) continue;
        if (list.branches[i].parent >= 0)
            factor[i] = factor[static_cast<size_t>(list.branches[i].parent)] * gathered[i];
        const bool alone = kept[i] == 0.0 && area[i] > 0.0;
        standing[i] = static_cast<float>(factor[i] * (alone ? all[i] / area[i] : 1.0));
    }
    // What would be too wide hands on to all others that stand for more than themselves.
    std::vector<double> most(count, 0.0);
    for (size_t i = 0; i < count; i++) {
        const double reach = list.branches[i].length;
        if (area[i] > 0.0)
            most[i] = std::max(std::min(kWidest * width, kStubbiest * reach) * reach / area[i], 1.0);
    }
    for (int round = 0; round < kRounds; round++) {
        double over = 0.0, room = 0.0;
        for (size_t i = 0; i < count; i++) {
            if (standing[i] <= 1.0f) continue;
            if (standing[i] >= most[i]) {
                over += (standing[i] - most[i]) * area[i];
                standing[i] = static_cast<float>(most[i]);
            } else {
                room += standing[i] * area[i];
            }
        }
        if (!(over > 0.0) || !(room > 0.0)) break;
        for (size_t i = 0; i < count; i++)
            if (standing[i] > 1.0f && standing[i] < most[i])
                standing[i] = static_cast<float>(standing[i] * (1.0 + over / room));
    }
    for (size_t i = 0; i < count; i++)
        if (standing[i] > 1.0f) standing[i] = std::min(standing[i], static_cast<float>(most[i]));
    return standing;
}

}  // namespace treerec
