// Moving, turning and growing wood. All are linear in the nodes, and throw Misfit for an unknown node and
// Error for a value that is not finite or out of range, before they change anything. They return the nodes
// that changed or were added, in depth-first order.
#pragma once

#include <optional>
#include <vector>

#include "tree/tree.h"

namespace treerec {

struct MoveOptions {
    // Whether what grows from a node goes with it, as it is.
    bool subtree = true;
    // Metres along the wood over which other nodes go with it, less and less; 0: none do.
    double falloff = 0.0;
};

// by: metres. Without subtree and falloff, the nodes alone move.
std::vector<NodeId> move_nodes(Tree& tree, const std::vector<NodeId>& nodes, const DVec3& by,
                               const MoveOptions& options = {});

// These three change a branch from the joint of the segment that ends in `id` on, or the whole tree for its
// root. degrees: counter-clockwise, seen with the axis pointing at the eye.
std::vector<NodeId> turn_branch(Tree& tree, NodeId id, const DVec3& axis, double degrees);
// thickness: what radii are multiplied by.
std::vector<NodeId> scale_branch(Tree& tree, NodeId id, double factor, double thickness);
// normal: of the mirror, which goes through the joint.
std::vector<NodeId> mirror_branch(Tree& tree, NodeId id, const DVec3& normal);

struct GrowNodeOptions {
    // Where to: the wood's own way at a tip; elsewhere out to a side that is still free.
    std::optional<DVec3> direction;
    double length = 0.0;  // metres; 0: as long as the segment that ends in the node
    double radius = 0.0;  // metres; 0: a little thinner than the node
    int nodes = 1;        // the length is divided among them; 1..1000
};

// New wood on a node; the new nodes, the tip last.
std::vector<NodeId> grow_node(Tree& tree, NodeId id, const GrowNodeOptions& options = {});

// Hangs a branch on another node. bring: it moves there, with its joint; else only its first segment
// changes. Throws Misfit for the root, and where `to` grows from the branch itself.
std::vector<NodeId> attach_branch(Tree& tree, NodeId id, NodeId to, bool bring);

// Radii times `factor`, or all to `radius`; these are then no longer measured.
std::vector<NodeId> scale_radii(Tree& tree, const std::vector<NodeId>& nodes, double factor);
std::vector<NodeId> set_radii(Tree& tree, const std::vector<NodeId>& nodes, double radius);

}  // namespace treerec
