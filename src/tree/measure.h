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

// Metres and cubic metres. Zero where it cannot be measured (no wood at breast height).
struct Measurements {
    size_t nodes = 0;
    size_t tips = 0;
    double height = 0.0;  // from the lowest node to the highest
    // Diameter of the thickest stem, 1.3 m from the root along the wood, between two nodes interpolated. None
    // where nothing is that high above the root.
    double dbh = 0.0;
    int stems = 0;  // wood there at least half as thick as the thickest
    // Mean over 36 directions of the crown's reach from its axis: the vertical through the middle of the wood
    // above the first fork.
    double crown_radius = 0.0;
    double crown_base = 0.0;    // height above the root of the first fork of the trunk
    double total_length = 0.0;  // of all segments
    // Wood: one truncated cone per segment; a side branch's first segment is a cylinder of its own radius,
    // not a cone from its parent's.
    double volume = 0.0;
    double measured_share = 0.0;         // share of the length whose radius was measured,
    double measured_volume_share = 0.0;  // and of the volume: fine twigs do not hide a measured stem
    std::vector<OrderMeasure> by_order;  // 0: trunk; branches and orders as list_branches() counts them
};

// Linear in the nodes. An empty tree measures zero.
Measurements measure(const Tree& tree);

}  // namespace treerec
