// Which cells the skeleton of a leafy tree should follow. Internal to scan/.
#pragma once

#include <cstdint>
#include <vector>

#include "progress.h"
#include "scan/leaves/leaf_cells.h"
#include "scan/leaves/leaf_paths.h"

namespace treerec {

struct FollowedBranches {
    std::vector<uint8_t> path;  // by cell: 1 for what the skeleton should follow
    double hidden_share = 0.0;  // of the path's cells in the crown: those among leaves
    bool fronds = false;        // a palm: one stem, and leaves as long as branches
    double reach = 0.0;         // metres: how far leaves stand from the stem of a palm
};

// leaf: by cell; small mistakes in it are put right: wood that hangs in the leaves without a way to the
// ground, and leaves on the stem's foot. A branch that leaves hide is followed where paths go on for long
// behind them, and the leader up to the very top. Leaves in sheets, all from the end of one bare stem, are a
// palm's fronds, and so is a tuft that hangs around the end of a tall one: there the stem alone is followed,
// up through the middle of the crown. palms: whether the tree may be one.
FollowedBranches follow_branches(const Cells& cells, const CellShapes& shapes, const CellPaths& tree,
                                 std::vector<uint8_t>& leaf, bool palms, const Progress& progress);

}  // namespace treerec
