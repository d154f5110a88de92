// Skeletons that are no tree yet: edges without a direction, paths that begin at a copy of the node they grow
// from, several trees in one file. Internal to exchange/.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "exchange/skeleton_table.h"
#include "exchange/tree_files.h"

namespace treerec {

// Which tree of a file is read, as an index. sizes: their nodes, in the file's order, at least one tree. Says
// so where there is another one. Throws Error for a number that there is not.
size_t choose_tree(const std::vector<size_t>& sizes, const SkeletonChoice& choice, const std::string& path,
                   SkeletonReport* report);

// Gives the table parents: vertices at one place are one node, with the largest of their radii; the chosen
// one of the pieces, in the order of their first vertices, is the tree; it begins at its end (a node with one
// neighbour) in its lowest fiftieth, upwards, that is thickest. Of edges that close a ring one is left out.
// table.parents is not read. Throws Error where no edge joins two nodes; `path` is for the sentence.
SkeletonTable tree_of_graph(const SkeletonTable& table, const std::vector<std::pair<NodeId, NodeId>>& edges,
                            const SkeletonChoice& choice, const std::string& path, SkeletonReport* report);

// The chosen tree of a table whose parents may name several roots, in the order of these. Throws Error where
// nodes hang in a ring.
SkeletonTable chosen_tree(const SkeletonTable& table, const SkeletonChoice& choice, const std::string& path,
                          SkeletonReport* report);

}  // namespace treerec
