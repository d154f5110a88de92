#include "tree/trunk.h"

#include <cmath>
#include <vector>

#include "geometry/portable_math.h"

namespace treerec {

void mark_trunk(Tree& tree, const TrunkOptions& options) {
    for (NodeId id : tree.depth_first())
        tree.set_flag(id, kTrunkFlag, false);
    if (tree.empty()) return;
    const double cosine_limit = portable::cos(glm::radians(options.angle_degrees));
    tree.set_flag(tree.root(), kTrunkFlag, true);
    std::vector<NodeId> stack{tree.root()};
    while (!stack.empty()) {
        const NodeId id = stack.back();
        stack.pop_back();
        NodeId thickest = kNoNode;
        for (NodeId child : tree.children(id))
            if (thickest == kNoNode || tree.node(child).radius > tree.node(thickest).radius) thickest = child;
        if (thickest == kNoNode) continue;
        const DVec3 here = tree.node(id).position;
        const DVec3 ahead = normalized_or(tree.node(thickest).position - here, DVec3(0.0));
        for (NodeId child : tree.children(id)) {
            const DVec3 direction = normalized_or(tree.node(child).position - here, DVec3(0.0));
            const bool thick = tree.node(child).radius >= options.radius_ratio * tree.node(thickest).radius;
            if (child == thickest || (thick && glm::dot(ahead, direction) >= cosine_limit)) {
                tree.set_flag(child, kTrunkFlag, true);
                stack.push_back(child);
            }
        }
    }
}

}  // namespace treerec
