// Wood that an edit cut away.
#pragma once

#include <string>
#include <vector>

#include "tree/tree.h"

namespace treerec {

// The nodes as they were, piece by piece, parents first within a piece.
struct Removed {
    struct Wood {
        NodeId id;
        Node node;  // with the links that it had
    };
    struct Piece {
        size_t begin = 0;  // of its nodes in `nodes`
        size_t end = 0;
        DVec3 joint{0.0};       // where its first segment began
        size_t rules = 0;       // of its tree then, in `leaf_rules`
        SectionTable sections;  // of its tree then
    };
    std::vector<Wood> nodes;
    std::vector<Piece> pieces;
    std::vector<std::vector<std::string>> leaf_rules;  // Tree::leaf_rules()

    std::vector<NodeId> ids() const;
    // Makes a piece of the nodes from `begin` on, which are the tree's.
    void add_piece(const Tree& tree, size_t begin, const DVec3& joint);
    // One piece as a tree in the frame of the tree that it comes from: its root is the joint, as thick as the
    // first node, with the leaf rules of its wood. Ids are new.
    Tree piece(size_t index, const ScanFrame& frame) const;
    // Adds another edit's, behind.
    void append(const Removed& other);
};

// Tree::remove_subtree(), adding what goes to `removed`. Throws Misfit for the root: a tree keeps it.
void remove_wood(Tree& tree, NodeId id, Removed& removed);
// The same for many: of nodes that grow from each other, the lowest counts. ids: in any order.
Removed remove_wood(Tree& tree, const std::vector<NodeId>& ids);

}  // namespace treerec
