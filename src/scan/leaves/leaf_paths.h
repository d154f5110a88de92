// Which cells the shortest paths from the ground to the twigs' ends pass through. Internal to scan/.
#pragma once

#include <cstdint>
#include <vector>

#include "progress.h"
#include "scan/leaves/leaf_cells.h"

namespace treerec {

// Per cell. Wood carries long, straight paths; among leaves they are short, crooked and bushy. Lengths in
// cells.
struct CellPath {
    float height = 0.0F;          // ln(1 + length of the longest path onward)
    float mass = 0.0F;            // ln of the number of cells whose path passes here
    float chain = 0.0F;           // ln(1 + length of the unforked path that this cell lies on)
    float chain_mass = 0.0F;      // ln of the cells beyond that path's start, per unit of its length
    float straight_short = 0.0F;  // chord over arc of the next 6 steps to the ground
    float straight_long = 0.0F;   // of the next 32
    float gap = 0.0F;             // mean length of the next 16 steps
    float bush_8 = 0.0F;  // ln(1 + cells per length of the whole end piece no longer than 8), 0 further in
    float bush_16 = 0.0F;
    float bush_32 = 0.0F;
};

struct CellPaths {
    std::vector<uint32_t> parent;  // the next cell to the ground; itself where there is none
    std::vector<uint32_t> order;   // parents before children
    std::vector<CellPath> paths;
};

// Steps cost the square of their length, so that paths stay in dense wood; parts that touch nothing are
// bridged to the largest. Starts at the lowest cells. cells: Y up.
CellPaths trace_paths(const Cells& cells, const Progress& progress);

}  // namespace treerec
