// Which nodes are trunk (Chen 2025, algorithm 2).
#pragma once

#include "tree/tree.h"

namespace treerec {

struct TrunkOptions {
    double radius_ratio = 0.8;    // a fork's child is trunk too if this thick beside the thickest child
    double angle_degrees = 30.0;  // and within this angle of it
};

// Sets or clears the trunk flag of every node. Follows the paper's algorithm 2 as it is meant: line 12 marks
// the child, not the root, and at a fork the thickest child always goes on.
void mark_trunk(Tree& tree, const TrunkOptions& options = {});

}  // namespace treerec
