// A tree seen as branches: unbranched chains of wood, each continued at a fork by its main child.
#pragma once

#include <span>
#include <vector>

#include "tree/tree.h"

namespace treerec {

// nodes(): the chain from its first own node to its tip. A side branch's first own node is the child of
// `attach`, the node of the parent branch it grows from, so the wood starts at attach. The trunk's chain
// starts at the root.
struct Branch {
    int32_t parent = -1;      // index of the parent branch, -1 for the first
    int32_t order = 0;        // 0 for the first branch, the parent's + 1 for others
    NodeId attach = kNoNode;  // kNoNode for the first branch
    int32_t begin = 0;        // range in BranchList::nodes
    int32_t end = 0;
    double length = 0.0;  // metres from attach (or the root) to the tip
};

struct BranchList {
    std::vector<Branch> branches;  // parents before children
    std::vector<NodeId> nodes;
    std::vector<int32_t> branch_of;  // by node id; -1 for free ids

    std::span<const NodeId> nodes_of(const Branch& branch) const {
        return {nodes.data() + branch.begin, static_cast<size_t>(branch.end - branch.begin)};
    }
};

// The child that continues the branch at `id`: the only trunk child if there is one, else the thickest
// (radius decides down to 5 %, then the length of wood above, then the order of children). kNoNode for a
// leaf. subtree_length: metres of wood above each node by id, from subtree_lengths().
NodeId main_child(const Tree& tree, NodeId id, const std::vector<double>& subtree_length);

// By node id: the summed length of all segments above the node (its own segment to its parent not counted).
std::vector<double> subtree_lengths(const Tree& tree);
// By node id: the longest way from the node to a tip above it.
std::vector<double> longest_paths(const Tree& tree);

BranchList list_branches(const Tree& tree);

}  // namespace treerec
