#include "edit/lighten/lighten_net.h"

#include <algorithm>
#include <cmath>

#include "tree/branches.h"

namespace treerec {

LooseTree::LooseTree(const Tree& tree) : marks(static_cast<size_t>(tree.id_end()), 0) {
    nodes.reserve(marks.size());
    for (NodeId id = 0; id < tree.id_end(); id++)
        nodes.push_back(tree.node(id));
}

void LooseTree::drop(NodeId id) {
    Node& gone = nodes[id];
    Node& host = nodes[gone.parent];
    const NodeId child = gone.first_child;
    const NodeId heir = child != kNoNode ? child : gone.next_sibling;
    if (gone.previous_sibling != kNoNode)
        nodes[gone.previous_sibling].next_sibling = heir;
    else
        host.first_child = heir;
    const NodeId last = child != kNoNode ? child : gone.previous_sibling;
    if (gone.next_sibling != kNoNode)
        nodes[gone.next_sibling].previous_sibling = last;
    else
        host.last_child = last;
    if (child != kNoNode) {
        nodes[child].parent = gone.parent;
        nodes[child].previous_sibling = gone.previous_sibling;
        nodes[child].next_sibling = gone.next_sibling;
    } else {
        host.child_count--;
    }
    gone.depth = 0;
}

double LooseTree::turn_cosine(NodeId id) const {
    const Node& node = nodes[id];
    const DVec3 u = node.position - nodes[node.parent].position;
    const DVec3 v = nodes[node.first_child].position - node.position;
    const double lengths = std::sqrt(glm::dot(u, u) * glm::dot(v, v));
    return lengths > 0.0 ? std::min(glm::dot(u, v) / lengths, 1.0) : 1.0;
}

Lightened LooseTree::hand_over(Tree& tree, const std::vector<uint8_t>& continues) const {
    Lightened result;
    result.before = tree.size();
    std::vector<Node> original;
    original.reserve(nodes.size());
    for (NodeId id = 0; id < tree.id_end(); id++)
        original.push_back(tree.node(id));
    for (NodeId id = 0; id < tree.id_end(); id++) {
        if (original[id].depth == 0) continue;
        if (nodes[id].depth == 0) {
            result.removed.push_back(id);
            continue;
        }
        if (marks[id]) result.changed.push_back(id);
        const NodeId parent = nodes[id].parent;
        if (parent != kNoNode && (parent != original[id].parent || marks[id] || marks[parent]))
            result.deviation = std::max(
                result.deviation,
                run_error(original, continues, parent, id, nodes[parent].position, nodes[id].position)
                    .deviation);
    }
    tree.dissolve_all(result.removed);
    for (NodeId id : result.changed) {
        tree.set_position(id, nodes[id].position);
        tree.set_radius(id, nodes[id].radius);
        for (NodeFlag flag : {kTrunkFlag, kMeasuredRadiusFlag, kGuessFlag})
            tree.set_flag(id, flag, (nodes[id].flags & flag) != 0);
    }
    result.after = tree.size();
    return result;
}

RunError run_error(const std::vector<Node>& original, const std::vector<uint8_t>& continues, NodeId parent,
                   NodeId child, const DVec3& parent_position, const DVec3& child_position) {
    RunError error;
    const DVec3 chord = child_position - parent_position;
    const double square = glm::dot(chord, chord);
    const double end_radius = original[child].radius;
    // From the child downwards; the piece is the wood between `above` and the node under it.
    NodeId above = child;
    double above_off = 0.0, above_thicker = 0.0;
    bool continued = false;
    double base_radius = end_radius;
    for (NodeId at = child; original[at].parent != parent; at = original[at].parent)
        above = original[at].parent;
    continued = continues[above] != 0;
    if (continued) base_radius = original[parent].radius;
    const double first_radius = continued ? base_radius : original[above].radius;
    for (above = child; above != parent;) {
        const NodeId below = original[above].parent;
        double off = 0.0, thicker = std::abs(first_radius - base_radius);
        if (below != parent) {
            const DVec3 p = original[below].position;
            const double t =
                square > 0.0 ? std::clamp(glm::dot(p - parent_position, chord) / square, 0.0, 1.0) : 0.0;
            off = glm::distance(p, parent_position + t * chord);
            thicker = std::abs(original[below].radius - (base_radius + t * (end_radius - base_radius)));
            error.deviation = std::max(error.deviation, off + thicker);
            error.count++;
        } else if (error.count > 0) {
            error.deviation = std::max(error.deviation, thicker);
        }
        // Of a tube that is moved aside both edges change, until the old and the new no longer overlap.
        const double length = glm::distance(original[above].position, original[below].position);
        error.area +=
            length * std::min(off + above_off + thicker + above_thicker, 4.0 * original[above].radius);
        above_off = off;
        above_thicker = thicker;
        above = below;
    }
    return error;
}

std::vector<uint8_t> continuing_nodes(const Tree& tree) {
    std::vector<uint8_t> continues(static_cast<size_t>(tree.id_end()), 0);
    const BranchList list = list_branches(tree);
    for (const Branch& branch : list.branches)
        for (NodeId id : list.nodes_of(branch).subspan(1))
            continues[id] = 1;
    return continues;
}

}  // namespace treerec
