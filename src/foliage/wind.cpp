#include "foliage/wind.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "foliage/crown.h"

namespace treerec {

namespace {

constexpr double kMostOut = 1023.0 / 1024.0;  // a half's mantissa rounds to no more
constexpr double kLeastSine = 0.3;            // of the angle at which a branch leaves its parent
constexpr double kSettling = 3.0;             // radii past the bark until a branch goes its own way
// Of the tree's height: tips of longer primary and secondary branches swing no further than those of such a
// length.
constexpr double kLongest[2] = {0.35, 0.15};

}  // namespace

float wind_code(int phase, double out) {
    const auto mantissa = static_cast<uint32_t>(std::clamp(out, 0.0, kMostOut) * 0x1p23);
    return std::bit_cast<float>((static_cast<uint32_t>(113 + phase) << 23) | mantissa);
}

uint16_t half_code(float code) {
    const auto bits = std::bit_cast<uint32_t>(code);
    return bits == 0 ? uint16_t{0}
                     : static_cast<uint16_t>((((bits >> 23) - 112) << 10) | ((bits >> 13) & 0x3ff));
}

WindGroups::WindGroups(const Tree& tree, const BranchList& list, double height)
    : runs_(list.branches.size()) {
    const size_t count = list.branches.size();
    std::vector<double> way(static_cast<size_t>(tree.id_end()), 0.0);
    std::vector<double> reach(count, 0.0);  // the longest way to a tip that the branch bears
    for (size_t i = 0; i < count; i++) {
        const Branch& branch = list.branches[i];
        const std::span<const NodeId> nodes = list.nodes_of(branch);
        NodeId last = branch.attach != kNoNode ? branch.attach : nodes[0];
        double along = 0.0;
        for (const NodeId id : nodes) {
            along += glm::distance(tree.node(id).position, tree.node(last).position);
            way[static_cast<size_t>(id)] = along;
            last = id;
        }
        reach[i] = along;
    }
    for (size_t i = count; i-- > 1;) {
        const Branch& branch = list.branches[i];
        double& below = reach[static_cast<size_t>(branch.parent)];
        below = std::max(below, way[static_cast<size_t>(branch.attach)] + reach[i]);
    }
    for (size_t i = 0; i < count; i++) {  // parents before children
        const Branch& branch = list.branches[i];
        if (branch.attach == kNoNode) continue;
        Run& run = runs_[i];
        const Node& attach = tree.node(branch.attach);
        const Node& next = tree.node(list.nodes[static_cast<size_t>(branch.begin)]);
        DVec3 before(0.0);
        if (attach.parent != kNoNode) before = attach.position - tree.node(attach.parent).position;
        run.parent_direction = normalized_or(before, DVec3(0.0, 1.0, 0.0));
        const DVec3 own = normalized_or(next.position - attach.position, run.parent_direction);
        run.cosine = glm::dot(own, run.parent_direction);
        const double sine = std::sqrt(std::max(0.0, 1.0 - run.cosine * run.cosine));
        run.exit = std::min(attach.radius / std::max(sine, kLeastSine), 0.7 * reach[i]);
        run.settled = run.exit + kSettling * next.radius;
        const Run& parent = runs_[static_cast<size_t>(branch.parent)];
        for (int group = 0; group < 2; group++) {
            if (branch.order == group + 1) {
                run.first[group] = true;
                const double length = std::max(reach[i], 1e-30), tall = std::max(height, 1e-30);
                run.scale[group] =
                    1.0 / std::sqrt(std::max(length * tall, length * length / kLongest[group]));
                run.phase[group] =
                    std::min(static_cast<int>(kWindPhases *
                                              branch_phase(list.nodes[static_cast<size_t>(branch.begin)])),
                             kWindPhases - 1);
            } else if (branch.order > group + 1) {
                const double at = way[static_cast<size_t>(branch.attach)];
                run.scale[group] = parent.scale[group];
                run.phase[group] = parent.phase[group];
                run.start[group] = std::max(at - parent.exit, 0.0);
                if (!parent.first[group])
                    run.start[group] += parent.start[group] + parent.cosine * std::min(at, parent.exit);
            }
        }
    }
}

Vec2 WindGroups::codes(size_t branch, double way, const DVec3& off) const {
    const Run& run = runs_[branch];
    // In its parent's bark, and about where it comes out, a branch moves as its parent does beside it.
    const double beside = (1.0 - glm::smoothstep(run.exit, std::max(run.settled, run.exit + 1e-30), way)) *
                          glm::dot(off, run.parent_direction);
    Vec2 codes;
    for (int group = 0; group < 2; group++) {
        double metres = std::max(way - run.exit, 0.0);
        if (!run.first[group]) metres += run.start[group] + run.cosine * std::min(way, run.exit) + beside;
        codes[group] = wind_code(run.phase[group], metres * run.scale[group]);
    }
    return codes;
}

}  // namespace treerec
