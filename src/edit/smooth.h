// Making wood smoother: radii, paths, kinks. All are linear in the nodes (relax_kinks() but for what hangs on
// the nodes that it moves), give the same result in whatever order the nodes are named, and throw Error for
// an unknown node or a value out of range before they change anything. They return the nodes that changed or
// were added.
#pragma once

#include <vector>

#include "tree/tree.h"

namespace treerec {

struct SmoothOptions {
    double strength = 0.5;  // 0..1: how far a node goes towards its neighbours in a round
    int rounds = 5;         // 0..1000
};

// Radii along branches: towards what the neighbours on the same branch have in between. Where a branch
// begins and ends, its radius stays. keep_measured: so do radii that were fitted to the scan. taper: no wood
// is then thicker than what it grows from (among the nodes named).
std::vector<NodeId> smooth_radii(Tree& tree, const std::vector<NodeId>& nodes,
                                 const SmoothOptions& options = {}, bool keep_measured = false,
                                 bool taper = true);

// Paths: towards the straight way between the neighbours. Tips, forks and the root stay where they are.
std::vector<NodeId> smooth_paths(Tree& tree, const std::vector<NodeId>& nodes,
                                 const SmoothOptions& options = {});

// Where a branch turns by more than `angle` degrees (0 < angle < 180) at a node, moves the node towards the
// straight way until it turns by that much. Side branches on it move along. Up to `rounds` times from the
// root up, since a node moved bends its neighbours.
std::vector<NodeId> relax_kinks(Tree& tree, const std::vector<NodeId>& nodes, double angle, int rounds = 10);

// Puts nodes into the segments that end in the nodes, at equal distances, so that none is longer than
// `length` metres. curved: along a curve through the neighbouring nodes on the branch (centripetal
// Catmull-Rom: Yuksel, Schaefer and Keyser 2011) instead of straight. Throws Error where that would be more
// than a million nodes.
std::vector<NodeId> subdivide(Tree& tree, const std::vector<NodeId>& nodes, double length,
                              bool curved = true);

// Puts one node into the segment that ends in `id`, at a share of its way (0 < share < 1), straight. Throws
// Misfit for the root.
NodeId insert_node(Tree& tree, NodeId id, double share = 0.5);

// The branch that the node lies on (tree/branches.h), towards the straight line from where it begins to its
// tip, by `strength` 0..1; what grows from it is carried along.
std::vector<NodeId> straighten(Tree& tree, NodeId id, double strength = 1.0);

}  // namespace treerec
