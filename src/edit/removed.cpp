#include "edit/removed.h"

#include "edit/address.h"

namespace treerec {

std::vector<NodeId> Removed::ids() const {
    std::vector<NodeId> all;
    all.reserve(nodes.size());
    for (const Wood& wood : nodes)
        all.push_back(wood.id);
    return all;
}

Tree Removed::piece(size_t index, const ScanFrame& frame) const {
    const Piece& piece = pieces.at(index);
    Tree tree;
    tree.set_frame(frame);
    tree.add_root(piece.joint, nodes[piece.begin].node.radius);
    // Depth-first: the parent of a node is the last one before it that lies one less deep.
    std::vector<NodeId> path{tree.root()};
    for (size_t i = piece.begin; i < piece.end; i++) {
        const Node& node = nodes[i].node;
        path.resize(static_cast<size_t>(node.depth - nodes[piece.begin].node.depth) + 1);
        path.push_back(tree.add_child(path.back(), node.position, node.radius, node.flags));
    }
    return tree;
}

void Removed::append(const Removed& other) {
    const size_t offset = nodes.size();
    nodes.insert(nodes.end(), other.nodes.begin(), other.nodes.end());
    for (Piece piece : other.pieces) {
        piece.begin += offset;
        piece.end += offset;
        pieces.push_back(piece);
    }
}

void remove_wood(Tree& tree, NodeId id, Removed& removed) {
    if (!tree.contains(id)) throw Misfit("There is no node " + std::to_string(id) + " in this tree.");
    if (id == tree.root()) throw Misfit("The root cannot be cut away: no tree would be left.");
    Removed::Piece piece;
    piece.begin = removed.nodes.size();
    piece.joint = tree.node(tree.node(id).parent).position;
    for (const NodeId gone : tree.depth_first(id))
        removed.nodes.push_back({gone, tree.node(gone)});
    piece.end = removed.nodes.size();
    removed.pieces.push_back(piece);
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
