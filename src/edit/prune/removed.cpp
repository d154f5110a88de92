#include "edit/prune/removed.h"

#include "edit/commands/address.h"

namespace treerec {

std::vector<NodeId> Removed::ids() const {
    std::vector<NodeId> all;
    all.reserve(nodes.size());
    for (const Wood& wood : nodes)
        all.push_back(wood.id);
    return all;
}

void Removed::add_piece(const Tree& tree, size_t begin, const DVec3& joint) {
    if (leaf_rules.empty() || leaf_rules.back() != tree.leaf_rules()) leaf_rules.push_back(tree.leaf_rules());
    pieces.push_back({begin, nodes.size(), joint, leaf_rules.size() - 1, tree.section_table()});
}

Tree Removed::piece(size_t index, const ScanFrame& frame) const {
    const Piece& piece = pieces.at(index);
    Tree tree;
    tree.set_frame(frame);
    tree.add_root(piece.joint, nodes[piece.begin].node.radius);
    const auto rule_of = [&](const Node& node) {
        return node.leaf_rule > 0 ? tree.name_leaf_rule(leaf_rules.at(piece.rules).at(node.leaf_rule - 1u))
                                  : uint8_t{0};
    };
    tree.set_leaf_rule(tree.root(), rule_of(nodes[piece.begin].node));
    tree.set_section_table(piece.sections);
    // Depth-first: the parent of a node is the last one before it that lies one less deep.
    std::vector<NodeId> path{tree.root()};
    for (size_t i = piece.begin; i < piece.end; i++) {
        const Node& node = nodes[i].node;
        path.resize(static_cast<size_t>(node.depth - nodes[piece.begin].node.depth) + 1);
        path.push_back(tree.add_child(path.back(), node.position, node.radius, node.flags));
        tree.set_leaf_rule(path.back(), rule_of(node));
        tree.set_section(path.back(), node.section);
    }
    tree.drop_unused_sections();
    return tree;
}

void Removed::append(const Removed& other) {
    const size_t offset = nodes.size(), rules = leaf_rules.size();
    leaf_rules.insert(leaf_rules.end(), other.leaf_rules.begin(), other.leaf_rules.end());
    nodes.insert(nodes.end(), other.nodes.begin(), other.nodes.end());
    for (Piece piece : other.pieces) {
        piece.begin += offset;
        piece.end += offset;
        piece.rules += rules;
        pieces.push_back(piece);
    }
}

void remove_wood(Tree& tree, NodeId id, Removed& removed) {
    if (!tree.contains(id)) throw Misfit("There is no node " + std::to_string(id) + " in this tree.");
    if (id == tree.root()) throw Misfit("The root cannot be cut away: no tree would be left.");
    const size_t begin = removed.nodes.size();
    for (const NodeId gone : tree.depth_first(id))
        removed.nodes.push_back({gone, tree.node(gone)});
    removed.add_piece(tree, begin, tree.node(tree.node(id).parent).position);
    tree.remove_subtree(id);
}

Removed remove_wood(Tree& tree, const std::vector<NodeId>& ids) {
    Removed removed;
    std::vector<uint8_t> chosen(static_cast<size_t>(tree.id_end()), 0);
    for (const NodeId id : ids) {
        if (!tree.contains(id)) throw Misfit("There is no node " + std::to_string(id) + " in this tree.");
        if (id == tree.root()) throw Misfit("The root cannot be cut away: no tree would be left.");
        chosen[id] = 1;
    }
    // In the tree's order, so that the result does not depend on that of the ids.
    for (const NodeId id : tree.depth_first())
        if (chosen[id] && tree.contains(id)) remove_wood(tree, id, removed);
    return removed;
}

}  // namespace treerec
