#include "tree/wood_segments.h"

namespace treerec {

std::vector<WoodSegment> wood_segments(const Tree& tree) {
    std::vector<WoodSegment> segments;
    segments.reserve(tree.size());
    for (NodeId id : tree.depth_first()) {
        const Node& node = tree.node(id);
        if (node.parent == kNoNode) continue;
        const Node& parent = tree.node(node.parent);
        segments.push_back({parent.position, node.position, node.radius, id, parent.radius});
    }
    return segments;
}

}  // namespace treerec
