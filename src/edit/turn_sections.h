// Measured outlines of wood that an edit turned.
#pragma once

#include <vector>

#include "tree/tree.h"

namespace treerec {

// Sections count their angles from a direction of the tree, so those of wood that is turned or mirrored as a
// whole must be told anew. ids: of the wood, which lies as it is now; turn: from how it lay before.
void turn_sections(Tree& tree, const std::vector<NodeId>& ids, const DMat3& turn);

}  // namespace treerec
