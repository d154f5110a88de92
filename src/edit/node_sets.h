// Small things that the edits share. Internal to edit/.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "edit/commands/address.h"
#include "edit/delta.h"
#include "geometry/portable_math.h"
#include "tree/tree.h"

namespace treerec {

inline void require_node(const Tree& tree, NodeId id) {
    if (!tree.contains(id)) throw Misfit("There is no node " + std::to_string(id) + " in this tree.");
}

// By id: 1 for those named. Throws Misfit for an unknown one.
inline std::vector<uint8_t> mask_of(const Tree& tree, const std::vector<NodeId>& nodes) {
    std::vector<uint8_t> mask(static_cast<size_t>(tree.id_end()), 0);
    for (const NodeId id : nodes) {
        require_node(tree, id);
        mask[id] = 1;
    }
    return mask;
}

inline double segment_length(const Tree& tree, NodeId id) {
    const Node& node = tree.node(id);
    return node.parent == kNoNode ? 0.0 : glm::distance(node.position, tree.node(node.parent).position);
}

// v turned about the unit axis by an angle in radians (Rodrigues 1840).
inline DVec3 turned(const DVec3& v, const DVec3& axis, double angle) {
    const double c = portable::cos(angle), s = portable::sin(angle);
    return v * c + glm::cross(axis, v) * s + axis * (glm::dot(axis, v) * (1.0 - c));
}

// Positions that a tree cannot have are refused before any is set.
inline void require_places(const std::vector<DVec3>& places) {
    for (const DVec3& place : places)
        if (!is_finite(place)) throw Error("That would take nodes further away than numbers can tell.");
}

}  // namespace treerec
