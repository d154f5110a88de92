// Which leaves which wood of a tree bears.
#pragma once

#include <string_view>
#include <vector>

#include "tree/tree.h"

namespace treerec {

// Gives the nodes a leaf rule (foliage/leaf_rule_text.h); "default" takes it away, so that they bear the
// tree's own leaves. A node is the wood up to it; one at an end stands for its twig, down to the last fork,
// as leaves stand along it (Chen 2025, 3.2.5). Returns those that bore other leaves, in rising order. Rules
// that no wood has any more are forgotten. Throws Error for an unknown id, for what is no rule, or for more
// rules than a tree can have.
std::vector<NodeId> set_leaves_of(Tree& tree, const std::vector<NodeId>& ids, std::string_view rule);

}  // namespace treerec
