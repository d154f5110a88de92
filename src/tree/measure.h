// What a forester measures on a tree.
#pragma once

#include <cstddef>
#include <vector>

#include "tree/tree.h"

namespace treerec {

inline constexpr double kBreastHeight = 1.3;  // metres above the base, along the trunk

struct OrderMeasure {
    size_t branches = 0;
    double length = 0.0;  // metres
};

// Metres, litres excepted by name. Zero where it cannot be measured (no trunk at breast height).
struct Measurements {
    size_t nodes = 0;
    size_t tips = 0;
    double height = 0.0;                 // from the lowest node to the top of the highest
    double dbh = 0.0;                    // diameter of the thickest stem at breast height
    int stems = 0;                       // stems that pass breast height
    double crown_radius = 0.0;           // mean over 36 directions of the farthest node from the crown's axis
    double crown_base = 0.0;             // height above the base of the first fork
    double total_length = 0.0;           // of all segments
    double volume = 0.0;                 // cubic metres of wood: truncated cones
    double measured_share = 0.0;         // share of the length whose radius was measured
    std::vector<OrderMeasure> by_order;  // 0: trunk
};

Measurements measure(const Tree& tree);

}  // namespace treerec
