#include "skeleton/cylinders/radius_rules.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "error.h"
#include "geometry/portable_math.h"

namespace treerec {

namespace {

constexpr std::array<const char*, 3> kRules = {"measured", "linear", "davinci"};
constexpr double kClearHeight = 1.3;  // metres above the base: there no stem is flared,
constexpr double kClearShare = 0.1;   // or so much of a small tree's height
constexpr double kThinnest = 0.0001;  // metres
constexpr double kUsualShare = 0.7;   // of the parent's radius, where there is no fork that tells it
constexpr double kLeastShare = 0.05;  // what a damaged tree may say
constexpr double kMostShare = 0.99;

// Along the stem, which is where the most tips are.
double radius_of_base(const Tree& tree, const std::vector<double>& tips) {
    const Bounds bounds = tree.bounds();
    const double clear = std::min(kClearHeight, kClearShare * bounds.size().y);
    NodeId at = tree.root();
    const double low = tree.node(at).position.y;
    while (tree.node(at).position.y - low < clear && tree.node(at).child_count > 0) {
        NodeId next = kNoNode;
        for (const NodeId child : tree.children(at))
            if (next == kNoNode || tips[child] > tips[next]) next = child;
        at = next;
    }
    return tree.node(at).radius;
}

double usual_share(const Tree& tree, const std::vector<NodeId>& order) {
    double sum = 0.0;
    size_t count = 0;
    for (const NodeId id : order) {
        if (tree.node(id).child_count < 2) continue;
        for (const NodeId child : tree.children(id)) {
            sum += portable::log(tree.node(child).radius / tree.node(id).radius);
            count++;
        }
    }
    if (count == 0) return kUsualShare;
    return std::clamp(portable::exp(sum / static_cast<double>(count)), kLeastShare, kMostShare);
}

}  // namespace

RadiusRule parse_radius_rule(const std::string& word) {
    for (size_t r = 0; r < kRules.size(); r++)
        if (word == kRules[r]) return static_cast<RadiusRule>(r);
    throw Error("There is no rule for radii " + quote_word(word) + "; take measured, linear or davinci.");
}

const char* radius_rule_name(RadiusRule rule) {
    return kRules[static_cast<size_t>(rule)];
}

void apply_radius_rule(Tree& tree, RadiusRule rule) {
    if (rule == RadiusRule::kMeasured || tree.empty()) return;
    const std::vector<NodeId> order = tree.depth_first();
    std::vector<double> tips(static_cast<size_t>(tree.id_end()), 0.0);
    for (size_t i = order.size(); i-- > 0;) {
        const Node& node = tree.node(order[i]);
        if (node.child_count == 0) tips[order[i]] = 1.0;
        if (node.parent != kNoNode) tips[node.parent] += tips[order[i]];
    }
    const double base = radius_of_base(tree, tips);
    const double share = usual_share(tree, order);
    std::vector<double> radius(tips.size(), base);
    for (const NodeId id : order) {
        const NodeId parent = tree.node(id).parent;
        if (rule == RadiusRule::kDaVinci)
            radius[id] = base * std::sqrt(tips[id] / tips[tree.root()]);
        else if (parent != kNoNode)
            radius[id] = radius[parent] * (tree.node(parent).child_count > 1 ? share : 1.0);
    }
    for (const NodeId id : order) {
        tree.set_radius(id, std::max(kThinnest, radius[id]));
        tree.set_flag(id, kMeasuredRadiusFlag, false);
    }
}

}  // namespace treerec
