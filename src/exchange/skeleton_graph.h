// Skeletons that are no tree yet: edges without a direction, paths that begin at a copy of the node they grow
// from, several trees in one file. Internal to exchange/.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "exchange/skeleton_table.h"

namespace treerec {

// Gives the table parents: vertices at one place are one node, with the largest of their radii; the piece
// with the most nodes is the tree; it begins at its end (a node with one neighbour) in its lowest fiftieth,
// along `up`, that is thickest. Of edges that close a ring one is left out. table.parents is not read. Throws
// Error where no edge joins two nodes; `path` is for the sentence.
SkeletonTable tree_of_graph(const SkeletonTable& table, const std::vector<std::pair<NodeId, NodeId>>& edges,
                            UpAxis up, const std::string& path);

// The tree with the most nodes of a table whose parents may name several roots. Throws Error where nodes hang
// in a ring.
SkeletonTable largest_tree(const SkeletonTable& table, const std::string& path);

}  // namespace treerec
