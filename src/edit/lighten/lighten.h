// Lighter trees: the same look with fewer nodes (Zhang 2013, 6.2).
//
// merge_turns, merge_tips and merge_branches are the paper's. lighten() does the same two things, but the one
// that is seen least first, within bounds, and without moving what stays: it is what to use.
#pragma once

#include <cstddef>
#include <vector>

#include "progress.h"
#include "tree/tree.h"

namespace treerec {

struct Lightened {
    size_t before = 0;  // nodes
    size_t after = 0;
    std::vector<NodeId> removed;  // ascending
    std::vector<NodeId> changed;  // stayed, but moved or got another radius or other flags; ascending
    // Metres that the bark moved where nodes of wood that stays went: the largest distance of such a node
    // from the new axis plus the difference of the radii there.
    double deviation = 0.0;
    // Metres from a tip that is gone to what stands for it, at most: the merged tip, or with lighten() the
    // wood beside it (before that moved, too).
    double tip_distance = 0.0;
};

// Algorithm 8, as the text and figure 6.1 mean it: of every unbranched run, from its lower end upwards, the
// first node goes that has one child and where the wood turns by less than `angle` (degrees, 0..180); again
// until none does. Nodes that coincide with a neighbour turn by nothing. The root stays; a trunk's flag is
// handed to the child. O(nodes). Throws Error for an angle outside of 0..180, or Cancelled; the tree is then
// as it was.
Lightened merge_turns(Tree& tree, double angle, const Progress* progress = nullptr);

// Algorithm 9: of the leaves on one fork, the first pair nearer than `distance` (metres) becomes one, half
// way between, with the larger radius; again until there is none. The new one takes the place and the id of
// the first. Throws Error for a distance that is negative or not finite, or Cancelled.
Lightened merge_tips(Tree& tree, double distance, const Progress* progress = nullptr);

// Both in turns until neither finds anything (6.2.3); only in what grows from the node `below`, if that is
// given. Throws Error for one that the tree doesn't have.
Lightened merge_branches(Tree& tree, double angle, double distance, const Progress* progress = nullptr,
                         NodeId below = kNoNode);

// A level of detail. With `nodes` at 0: what the three bounds allow. Else as many nodes go as that asks,
// whatever the bounds.
struct LightenOptions {
    double angle = 60.0;      // degrees: a node goes where the wood turns by less
    double distance = 0.1;    // metres: a leaf goes that ends so near other wood on its fork
    double deviation = 0.01;  // metres: the bark does not move farther
    size_t nodes = 0;         // how many to leave, at least 2; with `below` of that and what grows from it
    NodeId below = kNoNode;   // if a node: only what grows from it becomes lighter; itself it stays
};

// Takes away, the least visible first, nodes of runs and leaves of forks, where least visible is the least
// area that the silhouette changes by. What stays keeps its place, radius and id; of leaves side by side the
// one that is seen most stays, where the paper puts one between them. The trunk is never merged into
// anything; a leaf of it stays, so that trunks set the lowest number of nodes that can be reached.
// Deterministic. O(n log n): 100,000 nodes take some tens of milliseconds. Throws Error for options out of
// range, or Cancelled; the tree is then as it was. A leaf looks at the eight siblings before and after it.
Lightened lighten(Tree& tree, const LightenOptions& options, const Progress* progress = nullptr);

}  // namespace treerec
