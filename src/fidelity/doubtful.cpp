#include "fidelity/doubtful.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "error.h"
#include "geometry/portable_math.h"
#include "tree/branches.h"

namespace treerec {

namespace {

constexpr double kSupportedCoverage = 0.4;  // share of the bark with points from which it has enough of them
constexpr double kBridgedShare = 0.3;       // of the length from which a bridge is long
constexpr double kSharpTurn = 120.0;        // degrees from which a fork is improbable
constexpr double kThicker = 1.25;           // than the parent
constexpr double kLook = 0.1;               // metres over which a direction is taken
constexpr double kDoubtful = 0.3;           // what is less is not worth looking at

// From `start` along the chain, as far as kLook.
DVec3 direction_up(const Tree& tree, const DVec3& start, std::span<const NodeId> chain) {
    DVec3 end = start;
    for (NodeId id : chain) {
        end = tree.node(id).position;
        if (glm::distance(start, end) >= kLook) break;
    }
    return end - start;
}

// To `node` from kLook below it.
DVec3 direction_below(const Tree& tree, NodeId node) {
    const DVec3 end = tree.node(node).position;
    DVec3 start = end;
    for (NodeId at = tree.node(node).parent; at != kNoNode; at = tree.node(at).parent) {
        start = tree.node(at).position;
        if (glm::distance(start, end) >= kLook) break;
    }
    return end - start;
}

double angle_between(const DVec3& a, const DVec3& b) {
    const double lengths = glm::length(a) * glm::length(b);
    if (!(lengths > 0.0)) return 0.0;
    return portable::acos(std::clamp(glm::dot(a, b) / lengths, -1.0, 1.0)) * 180.0 / kPi;
}

// 0 at `from`, 1 at `to` and beyond.
double ramp(double value, double from, double to) {
    return std::clamp((value - from) / (to - from), 0.0, 1.0);
}

}  // namespace

std::vector<DoubtfulBranch> find_doubtful(const Tree& tree, const Fidelity& fidelity) {
    const BranchList list = list_branches(tree);
    if (list.branches.size() != fidelity.branches.size() ||
        fidelity.node_points.size() != static_cast<size_t>(tree.id_end()))
        throw Error("The fidelity was measured with another tree.");
    std::vector<DoubtfulBranch> found;
    for (size_t b = 0; b < list.branches.size(); b++) {
        const Branch& branch = list.branches[b];
        const std::span<const NodeId> chain = list.nodes_of(branch);
        if (branch.attach == kNoNode || chain.empty()) continue;
        const Node& attach = tree.node(branch.attach);
        if (branch.length < 2.0 * attach.radius) continue;
        const FidelityPart& part = fidelity.branches[b];
        DoubtfulBranch doubt;
        doubt.node = chain.front();
        doubt.attach = branch.attach;
        doubt.length = branch.length;
        doubt.points = part.points;
        for (NodeId id : chain) {
            const Node& node = tree.node(id);
            if (node.is_guess())
                doubt.bridged += glm::distance(node.position, tree.node(node.parent).position);
        }
        doubt.angle =
            angle_between(direction_up(tree, attach.position, chain), direction_below(tree, branch.attach));
        doubt.thickness = tree.node(chain.front()).radius / attach.radius;
        const double unsupported = 1.0 - ramp(part.coverage, 0.0, kSupportedCoverage);
        const double bridge = ramp(doubt.bridged / branch.length, kBridgedShare, 0.8);
        const double turn = ramp(doubt.angle, kSharpTurn, 170.0);
        const double thick = ramp(doubt.thickness, kThicker, 3.0);
        if (part.coverage < kSupportedCoverage) doubt.reasons |= kFewPoints;
        if (doubt.bridged > kBridgedShare * branch.length) doubt.reasons |= kLongBridge;
        if (doubt.angle > kSharpTurn) doubt.reasons |= kImprobableAngle;
        if (doubt.thickness > kThicker) doubt.reasons |= kThickerThanParent;
        // As independent witnesses; an odd shape alone is weaker than no points.
        doubt.doubt = 1.0 - (1.0 - unsupported) * (1.0 - bridge) * (1.0 - 0.6 * turn) * (1.0 - 0.6 * thick);
        if (doubt.reasons != 0 && doubt.doubt >= kDoubtful) found.push_back(doubt);
    }
    std::sort(found.begin(), found.end(), [](const DoubtfulBranch& a, const DoubtfulBranch& b) {
        const double first = a.doubt * a.length, second = b.doubt * b.length;
        return first != second ? first > second : a.node < b.node;
    });
    return found;
}

std::string doubt_text(uint8_t reasons) {
    std::string text;
    const auto add = [&](DoubtReason reason, const char* words) {
        if (reasons & reason) text += (text.empty() ? "" : ", ") + std::string(words);
    };
    add(kFewPoints, "few points");
    add(kLongBridge, "a long bridge");
    add(kImprobableAngle, "an improbable angle");
    add(kThickerThanParent, "thicker than its parent");
    return text;
}

}  // namespace treerec
