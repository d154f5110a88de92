#include "tree/branches.h"

#include <algorithm>

namespace treerec {

namespace {

double segment_length(const Tree& tree, NodeId id) {
    const Node& node = tree.node(id);
    return node.parent == kNoNode ? 0.0 : glm::distance(node.position, tree.node(node.parent).position);
}

}  // namespace

std::vector<double> subtree_lengths(const Tree& tree) {
    std::vector<double> length(static_cast<size_t>(tree.id_end()), 0.0);
    const std::vector<NodeId> order = tree.depth_first();
    for (auto at = order.rbegin(); at != order.rend(); ++at) {
        const Node& node = tree.node(*at);
        if (node.parent != kNoNode) length[node.parent] += length[*at] + segment_length(tree, *at);
    }
    return length;
}

std::vector<double> longest_paths(const Tree& tree) {
    std::vector<double> length(static_cast<size_t>(tree.id_end()), 0.0);
    const std::vector<NodeId> order = tree.depth_first();
    for (auto at = order.rbegin(); at != order.rend(); ++at) {
        const Node& node = tree.node(*at);
        if (node.parent != kNoNode)
            length[node.parent] = std::max(length[node.parent], length[*at] + segment_length(tree, *at));
    }
    return length;
}

NodeId main_child(const Tree& tree, NodeId id, const std::vector<double>& subtree_length) {
    int trunk_children = 0;
    for (NodeId child : tree.children(id))
        trunk_children += tree.node(child).is_trunk();
    NodeId best = kNoNode;
    for (NodeId child : tree.children(id)) {
        if (trunk_children > 0 && !tree.node(child).is_trunk()) continue;
        if (best == kNoNode) {
            best = child;
            continue;
        }
        const double ratio = tree.node(child).radius / tree.node(best).radius;
        if (ratio > 1.05 || (ratio > 1.0 / 1.05 && subtree_length[child] > subtree_length[best]))
            best = child;
    }
    return best;
}

BranchList list_branches(const Tree& tree) {
    BranchList list;
    list.branch_of.assign(static_cast<size_t>(tree.id_end()), -1);
    if (tree.empty()) return list;
    list.nodes.reserve(tree.size());
    const std::vector<double> lengths = subtree_lengths(tree);
    struct Start {
        NodeId first;
        int32_t parent_branch;
    };
    std::vector<Start> pending{{tree.root(), -1}};
    for (size_t i = 0; i < pending.size(); i++) {
        const Start start = pending[i];
        Branch branch;
        branch.parent = start.parent_branch;
        branch.order = start.parent_branch < 0 ? 0 : list.branches[start.parent_branch].order + 1;
        branch.attach = tree.node(start.first).parent;
        branch.begin = static_cast<int32_t>(list.nodes.size());
        const int32_t index = static_cast<int32_t>(list.branches.size());
        for (NodeId at = start.first; at != kNoNode;) {
            list.nodes.push_back(at);
            list.branch_of[at] = index;
            branch.length += segment_length(tree, at);
            const NodeId next = main_child(tree, at, lengths);
            for (NodeId child : tree.children(at))
                if (child != next) pending.push_back({child, index});
            at = next;
        }
        branch.end = static_cast<int32_t>(list.nodes.size());
        list.branches.push_back(branch);
    }
    return list;
}

}  // namespace treerec
