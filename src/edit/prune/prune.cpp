#include "edit/prune/prune.h"

#include <algorithm>
#include <cmath>

#include "edit/node_sets.h"
#include "tree/branches.h"

namespace treerec {

namespace {

constexpr double kLeastStub = 0.01;  // of the segment

// An end in the segment to `id`, at a share of its way; what is above is not cut off here. It is measured
// wood only where both ends are.
NodeId add_stump(Tree& tree, NodeId id, double share) {
    const Node node = tree.node(id);
    const Node parent = tree.node(node.parent);
    uint8_t flags = node.flags;
    if (!parent.is_measured()) flags &= static_cast<uint8_t>(~kMeasuredRadiusFlag);
    return tree.insert_before(id, glm::mix(parent.position, node.position, share),
                              parent.radius + (node.radius - parent.radius) * share, flags);
}

struct Twig {
    NodeId leaf;
    int nodes;      // from above the fork to the leaf
    double length;  // metres, likewise
};

std::vector<Twig> list_twigs(const Tree& tree) {
    std::vector<Twig> twigs;
    for (const NodeId leaf : tree.depth_first()) {
        if (tree.node(leaf).child_count > 0) continue;
        Twig twig{leaf, 0, 0.0};
        NodeId at = leaf;
        while (tree.node(at).parent != kNoNode) {
            twig.nodes++;
            twig.length += segment_length(tree, at);
            at = tree.node(at).parent;
            if (tree.node(at).child_count < 2) continue;
            twigs.push_back(twig);
            break;
        }
    }
    return twigs;
}

}  // namespace

Removed prune_twigs(Tree& tree, const PruneOptions& options) {
    if (!(options.factor >= 0.0) || !(options.minimum_length >= 0.0))
        throw Error("Neither the factor nor the least length of a twig can be negative.");
    Removed removed;
    const std::vector<Twig> twigs = list_twigs(tree);
    if (twigs.empty()) return removed;
    double total = 0.0;
    for (const Twig& twig : twigs)
        total += options.in_metres ? twig.length : twig.nodes;
    double mean = total / static_cast<double>(twigs.size());
    if (!options.in_metres) mean = std::floor(mean);
    // A mean of equal twigs must not cut them by its rounding.
    const double limit = options.factor * mean * (1.0 + 1e-12);
    for (const Twig& twig : twigs) {
        if ((options.in_metres ? twig.length : twig.nodes) <= limit) continue;
        // Down from the leaf, as long as what is left is too long.
        NodeId lowest = kNoNode;
        int nodes = twig.nodes;
        double length = twig.length;
        for (NodeId at = twig.leaf; nodes > 0; at = tree.node(at).parent) {
            const Node& node = tree.node(at);
            const bool spared = (options.spare_leader && node.is_trunk()) ||
                                node.radius >= options.minimum_radius ||
                                (options.minimum_length > 0.0 && length <= options.minimum_length);
            if (spared || (options.in_metres ? length : nodes) <= limit) break;
            lowest = at;
            length -= segment_length(tree, at);
            nodes--;
        }
        if (lowest == kNoNode) continue;
        // What stays must be as long as was asked: one node more where the cut would go below that.
        if (options.minimum_length > 0.0 && length < options.minimum_length) {
            lowest = tree.node(lowest).first_child;
            if (lowest == kNoNode) continue;
        }
        remove_wood(tree, lowest, removed);
    }
    return removed;
}

Removed prune_below(Tree& tree, NodeId id) {
    require_node(tree, id);
    Removed removed;
    while (tree.node(id).first_child != kNoNode)
        remove_wood(tree, tree.node(id).first_child, removed);
    return removed;
}

Removed cut(Tree& tree, NodeId id, double stub, NodeId* stump) {
    require_node(tree, id);
    if (!(stub >= 0.0) || !std::isfinite(stub)) throw Error("A stub's length must be zero or more metres.");
    if (id == tree.root()) throw Misfit("The root cannot be cut away: no tree would be left.");
    const double length = segment_length(tree, id);
    NodeId end = kNoNode;
    if (length > 0.0 && stub >= length) {
        if (stump) *stump = id;
        return prune_below(tree, id);
    }
    Removed removed;
    if (length > 0.0 && stub >= kLeastStub * length) end = add_stump(tree, id, stub / length);
    remove_wood(tree, id, removed);
    if (stump) *stump = end;
    return removed;
}

void delete_node(Tree& tree, NodeId id) {
    require_node(tree, id);
    if (id == tree.root() && tree.node(id).child_count != 1)
        throw Misfit("The root can be deleted only while exactly one branch grows from it.");
    const bool guess = tree.node(id).is_guess();
    if (guess)
        for (const NodeId child : tree.children(id))
            tree.set_flag(child, kGuessFlag, true);
    tree.dissolve(id);
}

Removed prune_by_order(Tree& tree, int order) {
    if (order < 1) throw Error("Branches are numbered from 1; the trunk, 0, cannot be pruned away.");
    const BranchList list = list_branches(tree);
    Removed removed;
    for (const Branch& branch : list.branches)
        if (branch.order == order) remove_wood(tree, list.nodes[branch.begin], removed);
    return removed;
}

Removed prune_by_radius(Tree& tree, double radius) {
    if (!(radius >= 0.0)) throw Error("A radius must be zero or more metres.");
    const std::vector<NodeId> order = tree.depth_first();
    std::vector<uint8_t> kept(static_cast<size_t>(tree.id_end()), 0);
    for (auto at = order.rbegin(); at != order.rend(); ++at) {
        const Node& node = tree.node(*at);
        if (node.radius >= radius) kept[*at] = 1;
        if (kept[*at] && node.parent != kNoNode) kept[node.parent] = 1;
    }
    Removed removed;
    for (const NodeId id : order)
        if (!kept[id] && id != tree.root() && tree.contains(id)) remove_wood(tree, id, removed);
    return removed;
}

Removed prune_region(Tree& tree, const Region& region, bool exact) {
    if (tree.empty()) throw Misfit("The tree is empty.");
    if (region.contains(tree.node(tree.root()).position))
        throw Misfit("The root lies inside, so no tree would be left.");
    Removed removed;
    for (const NodeId id : tree.depth_first()) {
        if (!tree.contains(id) || !region.contains(tree.node(id).position)) continue;
        const Node& node = tree.node(id);
        const double share = region.entry(tree.node(node.parent).position, node.position);
        if (exact && share >= kLeastStub) add_stump(tree, id, share);
        remove_wood(tree, id, removed);
    }
    return removed;
}

Removed keep_only(Tree& tree, const std::vector<NodeId>& ids) {
    if (ids.empty()) throw Misfit("There is nothing to keep: the selection is empty.");
    std::vector<uint8_t> kept(static_cast<size_t>(tree.id_end()), 0);
    for (NodeId id : ids) {
        require_node(tree, id);
        for (; id != kNoNode && !kept[id]; id = tree.node(id).parent)
            kept[id] = 1;
    }
    Removed removed;
    for (const NodeId id : tree.depth_first())
        if (!kept[id] && tree.contains(id)) remove_wood(tree, id, removed);
    return removed;
}

}  // namespace treerec
