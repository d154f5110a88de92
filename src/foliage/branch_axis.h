// The smooth axis of a branch, on which both its bark and its leaves sit.
#pragma once

#include <vector>

#include "tree/branches.h"
#include "tree/tree.h"

namespace treerec {

struct AxisPoint {
    DVec3 position;    // metres, tree space
    DVec3 direction;   // unit, towards the tip
    double radius;     // metres
    double along;      // metres from the branch's start
    double way = 0.0;  // the same along the straight chords between nodes
};

// Points along a cubic through the branch's nodes, dense where it bends, in order; the first is where the
// branch starts (attach, or the root). Nodes that lie nearer to one another than a quarter radius are joined,
// so consecutive points are apart. `least`: the smallest distance between points that counts (metres).
// Leaves `points` empty for a branch without length. Reuses the memory of `points`.
void sample_axis(const Tree& tree, const BranchList& list, const Branch& branch, double least,
                 std::vector<AxisPoint>& points);

// The point at `along` metres, by linear interpolation. Precondition: two points or more.
// `hint`: where to start looking, moved to the interval found; walk up or down with it in constant time.
AxisPoint axis_at(const std::vector<AxisPoint>& points, double along, size_t& hint);

}  // namespace treerec
