#include "foliage/snags.h"

#include <algorithm>
#include <array>

#include "geometry/bounds.h"
#include "geometry/vec.h"

namespace treerec {

namespace {

constexpr double kShortRadii = 6.0;   // of the host
constexpr double kHugRadii = 3.0;     // of the host, from its axis
constexpr double kLowRadii = 12.0;    // of the host
constexpr double kThinShare = 0.5;    // of the host's radius: thicker wood is a branch or a stem
constexpr double kBelowCrown = 0.1;   // of the thin wood's length lies below the crown's base
constexpr size_t kHeightSteps = 256;  // the crown's base is found to such a share of the height

// What a twig and all that grows on it span.
struct Span {
    double reach = 0.0;   // metres from where it starts
    double aside = 0.0;   // metres from the host's axis
    double top = -1e300;  // y
};

// The height below which a tenth of the thin wood's length lies, `skipped` branches not counted.
double crown_base(const Tree& tree, const BranchList& list, double thin_radius,
                  const std::vector<uint8_t>& skipped) {
    const Bounds box = tree.bounds();
    const double step = std::max((box.max.y - box.min.y) / static_cast<double>(kHeightSteps), 1e-12);
    std::array<double, kHeightSteps> length{};
    double total = 0.0;
    for (size_t i = 0; i < list.branches.size(); i++) {
        if (skipped[i]) continue;
        for (const NodeId id : list.nodes_of(list.branches[i])) {
            const Node& node = tree.node(id);
            if (node.parent == kNoNode || node.radius > thin_radius) continue;
            const DVec3& below = tree.node(node.parent).position;
            const double along = glm::distance(node.position, below);
            const double y = 0.5 * (node.position.y + below.y) - box.min.y;
            length[std::min(static_cast<size_t>(std::max(y / step, 0.0)), kHeightSteps - 1)] += along;
            total += along;
        }
    }
    double below = 0.0;
    size_t at = 0;
    while (at < kHeightSteps && below + length[at] <= kBelowCrown * total)
        below += length[at++];
    return box.min.y + step * static_cast<double>(at);
}

}  // namespace

std::vector<uint8_t> find_snags(const Tree& tree, const BranchList& list, double stout_radius) {
    const size_t count = list.branches.size();
    std::vector<uint8_t> snag(count, 0);
    std::vector<int32_t> twig(count, -1);  // by branch: the twig on stout wood that it is part of
    std::vector<Span> spans(count);
    for (size_t i = 0; i < count; i++) {
        const Branch& branch = list.branches[i];
        if (branch.attach == kNoNode) continue;
        const double host = tree.node(branch.attach).radius;
        snag[i] = snag[branch.parent] || (host > stout_radius && branch.length < kShortRadii * host);
        twig[i] = twig[branch.parent];
        const double own = tree.node(list.nodes[branch.begin]).radius;
        if (host > stout_radius && own < std::min(stout_radius, kThinShare * host))
            twig[i] = static_cast<int32_t>(i);
        if (twig[i] < 0) continue;
        const Branch& first = list.branches[static_cast<size_t>(twig[i])];
        const Node& attach = tree.node(first.attach);
        DVec3 axis(0.0, 1.0, 0.0);
        if (attach.parent != kNoNode)
            axis = normalized_or(attach.position - tree.node(attach.parent).position, axis);
        Span& span = spans[static_cast<size_t>(twig[i])];
        for (const NodeId id : list.nodes_of(branch)) {
            const DVec3 off = tree.node(id).position - attach.position;
            span.reach = std::max(span.reach, glm::length(off));
            span.aside = std::max(span.aside, glm::length(off - axis * glm::dot(off, axis)));
            span.top = std::max(span.top, tree.node(id).position.y);
        }
    }
    const double base = crown_base(tree, list, stout_radius, snag);
    for (size_t i = 0; i < count; i++) {
        const Branch& branch = list.branches[i];
        if (branch.attach == kNoNode || snag[i]) continue;
        snag[i] = snag[branch.parent];
        if (twig[i] != static_cast<int32_t>(i)) continue;
        const double host = tree.node(branch.attach).radius;
        const Span& span = spans[i];
        if (span.aside < kHugRadii * host || (span.reach < kLowRadii * host && span.top < base)) snag[i] = 1;
    }
    return snag;
}

}  // namespace treerec
