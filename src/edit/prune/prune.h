// Cutting wood away. Each returns what it removed; the root always stays. All are linear in the nodes, throw
// before they change anything, and keep what stays as it is, bit for bit.
#pragma once

#include <limits>

#include "edit/commands/region.h"
#include "edit/prune/removed.h"
#include "tree/tree.h"

namespace treerec {

struct PruneOptions {
    double factor = 1.0;  // of the mean: how long a twig may be
    // Whether a twig's length is its number of nodes, as in the paper, or metres.
    bool in_metres = false;
    double minimum_length = 0.0;  // metres of every twig that stay, whatever the mean
    // Wood of at least this radius in metres stays: a scan's outliers are thin.
    double minimum_radius = std::numeric_limits<double>::infinity();
    bool spare_leader = true;  // leaves what is marked as trunk alone
};

// Chen 2025, algorithm 3: twigs, from a leaf down to the first fork, that are longer than
// the mean are cut to it. The mean number of nodes is rounded down. A tree without a fork has no twigs.
// As printed it spares no leader; all else here is the paper's unless asked for.
// Throws Error for a factor or a length below zero.
Removed prune_twigs(Tree& tree, const PruneOptions& options = {});

// All that grows above the node; it stays, as a tip.
Removed prune_below(Tree& tree, NodeId id);

// Cuts the segment that ends in the node, `stub` metres from where it begins: the stub gets an end of its
// own, as thick as the wood was there. Without a stub, or with less than a hundredth of the segment, it is
// cut clean at the joint; a stub as long as the segment keeps the node. stump: gets the new end, or kNoNode.
// Throws Misfit for the root, Error for a negative stub.
Removed cut(Tree& tree, NodeId id, double stub = 0.0, NodeId* stump = nullptr);

// Takes out one node; its children hang on its parent in its place. Wood that bridged a gap still says so.
// Throws Misfit for a root without exactly one child, which then is the root.
void delete_node(Tree& tree, NodeId id);

// Branches of this order and above (tree/branches.h; the trunk is 0). Throws Error for order < 1.
Removed prune_by_order(Tree& tree, int order);

// Wood thinner than `radius` metres, unless it bears thicker wood. Throws Error for a radius below zero.
Removed prune_by_radius(Tree& tree, double radius);

// Wood inside the region, and what then hangs on nothing. exact: branches end where they enter the region;
// else at their last node outside. Throws Misfit if the root lies inside.
Removed prune_region(Tree& tree, const Region& region, bool exact = true);

// All but the nodes and the wood that leads to them. Throws Misfit for an unknown node, Error for none.
Removed keep_only(Tree& tree, const std::vector<NodeId>& ids);

}  // namespace treerec
