// Branches that do not begin where they should (Ma and Liu 2020, 2.2 and figures 4 and 5).
#pragma once

#include <vector>

#include "sketch/flat_line.h"
#include "sketch/strokes.h"

namespace treerec {

// Thresholds: the paper prints none. These are tuned on sketches of known intent (tests/sketch).
struct RepairOptions {
    // Of a piece near the tail, as a multiple of the whole stroke's: n L / (l N). More is a hook or a loop.
    double relative_density = 1.6;
    // How far from the tail one may begin: this share of the branch's length, and no more than so many
    // pixels.
    double cluster_share = 0.3;
    double cluster_reach = 60.0;
    // How much of its length a branch is extended to meet the trunk.
    double gap_share = 0.15;
    // Where the trunk cuts off at least this share of a stroke, it is a branch on the other side.
    double other_side = 0.35;
    // How much of the branch its direction at the tail is taken from, pixels.
    double tail = 20.0;
};

struct MendedBranch {
    FlatLine line;  // from its tail, a point of the trunk's line
    std::vector<StrokeRepair> repairs;
    LinePlace attach;      // on the trunk's line
    double bridged = 0.0;  // pixels added
    FlatLine other_side;   // of a stroke right through the trunk, from the trunk; else empty
};

// Whether the line's last point is its tail: the end nearer to the trunk, or the lower one where both are
// near.
bool is_reversed(const FlatLine& line, const FlatLine& trunk);

// line: cleaned, from its tail, at least two points. trunk: what it grows from, with radii where they were
// drawn; at least two points. In this order, until nothing changes:
// hook, loop: the densest piece near the tail, if it is dense enough, becomes its centroid, moved onto the
//     line that the branch comes along. After cleaning, points stand evenly along the line, so that a piece's
//     length l is the distance between its ends: dense is what turns back.
// crossing: cut where it meets the trunk; the shorter part goes.
// gap: extended along its direction to the trunk; or joined to the nearest point, where that misses.
MendedBranch mend_branch(FlatLine line, const DrawnLine& trunk, const RepairOptions& options);

// understand_sketch() with other thresholds.
UnderstoodSketch understand_sketch(const Sketch& sketch, const RepairOptions& options);

}  // namespace treerec
