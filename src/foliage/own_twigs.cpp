#include "foliage/own_twigs.h"

#include <algorithm>
#include <vector>

#include "geometry/quantile.h"

namespace treerec {

namespace {

constexpr size_t kLeastSeen = 20;  // forks or tips to learn from
constexpr double kThinTips = 0.1;  // quantile: thicker ones end where the scan lost them

// Twigs leave at 25 to 70 degrees, and are thinner than what they leave.
constexpr double kLeastAgreement = 0.35, kMostAgreement = 0.9;
constexpr double kLeastThinning = 0.5, kMostThinning = 0.95;
constexpr double kLeastRadius = 0.0006;  // metres: a birch's; times the scale

}  // namespace

OwnTwigs measure_twigs(const Tree& tree, double slender, double scale) {
    OwnTwigs own;
    own.thinnest *= scale;
    own.thickest *= scale;
    std::vector<float> cosines, shares, tips;
    for (const NodeId id : tree.depth_first()) {
        const Node& node = tree.node(id);
        if (node.parent == kNoNode || node.is_guess() || node.radius > slender) continue;
        if (node.child_count == 0) tips.push_back(static_cast<float>(node.radius));
        const Node& fork = tree.node(node.parent);
        if (fork.parent == kNoNode || fork.child_count < 2 || fork.radius > slender) continue;
        // The straightest of the children continues the wood.
        const DVec3 before = normalized_or(fork.position - tree.node(fork.parent).position, DVec3(0.0));
        const auto cosine = [&](NodeId child) {
            return glm::dot(before, normalized_or(tree.node(child).position - fork.position, DVec3(0.0)));
        };
        NodeId straightest = fork.first_child;
        for (const NodeId child : tree.children(node.parent))
            if (cosine(child) > cosine(straightest)) straightest = child;
        if (straightest == id) continue;
        cosines.push_back(static_cast<float>(cosine(id)));
        if (fork.radius > 0.0) shares.push_back(static_cast<float>(node.radius / fork.radius));
    }
    if (cosines.size() >= kLeastSeen)
        own.agreement = std::clamp<double>(quantile(cosines, 0.5), kLeastAgreement, kMostAgreement);
    if (shares.size() >= kLeastSeen)
        own.thinning = std::clamp<double>(quantile(shares, 0.5), kLeastThinning, kMostThinning);
    if (tips.size() >= kLeastSeen)
        own.thinnest = std::clamp<double>(quantile(tips, kThinTips), kLeastRadius * scale, own.thickest);
    return own;
}

}  // namespace treerec
