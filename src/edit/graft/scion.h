// A branch taken from a tree, in its own frame, and put onto another.
//
// A scion is a plain Tree: its root stands at (0,0,0), the wood that it grew from pointed along +Y there (so
// that its first segment leans off +Y by its own branching angle), and +Z is the side that was up. The root's
// radius is that of its wood at the joint. Metres. A scion with leaf rules (Tree::leaf_rules()) keeps them
// for its wood; one without bears the leaves of its host. Measured sections (Tree::sections()) go along.
#pragma once

#include <vector>

#include "tree/tree.h"

namespace treerec {

// The rotation whose columns are the axes of a frame that looks along `forward` (unit, tree space): +Y is
// forward, +Z the side nearest to up. Within 20 degrees of the vertical no side is up: +Z stays nearest to
// the tree's own +Z, so that a scion from a standing trunk keeps its compass direction.
DMat3 frame_about(const DVec3& forward);

// The direction in which the wood arrives at `joint`: of its segment, else of the nearest one below it that
// has a length, else up. Unit. Precondition: tree.contains(joint).
DVec3 direction_at(const Tree& tree, NodeId joint);

// The smallest rotation that turns unit vector `from` into unit vector `to`.
DMat3 turn_between(const DVec3& from, const DVec3& to);

// The rotation about unit vector `axis` by `radians`, counter-clockwise as seen from its tip.
DMat3 turn_about(const DVec3& axis, double radians);

// The subtree that hangs on the segment from joint_child's parent, with that joint as its root: ids 0.. in
// depth-first order, flags and leaf rules kept, no frame. The tree's root gives the whole tree, upright as it
// stands. Throws Error for an unknown id, or for a root without children, which is no branch.
Tree take_scion(const Tree& tree, NodeId joint_child);

// The unit direction in which the scion leaves its root, in its own frame: to the first node of its main
// branch that is clear of the joint, else of its tip; +Y where it has no extent.
DVec3 scion_direction(const Tree& scion);

// Metres from the root to the farthest tip, along the wood.
double scion_length(const Tree& scion);

// Throws Error, with a sentence that names `scion` as the culprit, unless it has a root and wood on it.
void require_scion(const Tree& scion);

// Throws Error where so many nodes more would be too many for a tree.
void require_room(const Tree& tree, size_t nodes);

// Where a scion is put: p becomes position-of-joint + axes * (scale * p), a radius r becomes scale * r.
struct ScionPlacement {
    DMat3 axes{1.0};
    double scale = 1.0;
};

// Hangs the scion's nodes (all but its root, which the joint stands for) under `joint` as last children and
// returns their ids, in the scion's depth-first order. Of the flags only kGuessFlag stays: nothing of it was
// measured here, and the trunk is the tree's own affair. Throws Error, before anything changes, for an
// unknown joint, for no scion, where a number would overflow, or for more nodes than kLargestId.
std::vector<NodeId> place_scion(Tree& tree, NodeId joint, const Tree& scion, const ScionPlacement& placement);

}  // namespace treerec
