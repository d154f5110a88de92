// From fitted branches to the Tree.
#pragma once

#include <vector>

#include "skeleton/cylinders/axis.h"
#include "tree/tree.h"

namespace treerec {

// simplify_distance: a station goes where axis and radius stay within this many metres without it (Douglas
// and Peucker 1973; AdTree, Du et al. 2019, 2.3); 0: a tenth of the local radius, at least 2 mm. Forks, tips
// and both ends of bridges stay, and no segment grows longer than 20 cm. The tree's nodes are in depth-first
// order.
Tree assemble_tree(const std::vector<std::vector<Station>>& axes, const std::vector<SkeletonBranch>& branches,
                   double simplify_distance, PassSet left_out = {});

}  // namespace treerec
