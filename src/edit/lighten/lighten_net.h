// The tree while it is made lighter: links without depths, so that taking a node out costs nothing more.
// Internal to edit/lighten*.
#pragma once

#include <vector>

#include "edit/lighten/lighten.h"
#include "tree/tree.h"

namespace treerec {

struct LooseTree {
    std::vector<Node> nodes;     // by id; depth 0 marks what is gone
    std::vector<uint8_t> marks;  // by id: 1 changed

    explicit LooseTree(const Tree& tree);

    // A node that has one child or none and is not the root; its child takes its place.
    void drop(NodeId id);
    void mark_changed(NodeId id) { marks[id] = 1; }
    void set_flag(NodeId id, NodeFlag flag) {
        nodes[id].flags = static_cast<uint8_t>(nodes[id].flags | flag);
        mark_changed(id);
    }
    // The cosine of the angle by which the wood turns at a node with one child; 1 where two of the three
    // nodes coincide.
    double turn_cosine(NodeId id) const;

    // Does the same to `tree`, from which this was made, and tells of it; tip_distance is left at 0.
    // continues: continuing_nodes() of the tree.
    Lightened hand_over(Tree& tree, const std::vector<uint8_t>& continues) const;
};

// How far the bark of the wood below `child` moves if its parent becomes `parent`, a node further down: over
// the nodes between the two in `tree`, the distance from the axis plus the difference of the radii. area:
// square metres by which the silhouette of the wood changes, roughly. `continues`: by id, whether the node
// continues its parent's branch; a branch that does not begins with its own first radius.
struct RunError {
    double deviation = 0.0;
    double area = 0.0;
    int32_t count = 0;  // nodes between
};
RunError run_error(const std::vector<Node>& original, const std::vector<uint8_t>& continues, NodeId parent,
                   NodeId child, const DVec3& parent_position, const DVec3& child_position);

// By id: 1 where the node continues the branch of its parent.
std::vector<uint8_t> continuing_nodes(const Tree& tree);

}  // namespace treerec
