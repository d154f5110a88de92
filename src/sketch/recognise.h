// What each stroke of a drawing is: the crown's outline, the trunk, or a branch (Ma and Liu 2020, 2.2).
//
// The paper takes the stroke with the highest point for the outline, the one with the lowest for the trunk
// and all others for branches, and assumes of a drawing (chapter 2):
//   1. It has one trunk. Where two lines stand side by side from the ground up, or one stroke goes around
//   both
//      sides, that is the trunk's outline; where there is none, one is made up (drawn_trunk.h).
//   2. It has one outline. Those that cross are united, two arcs that meet at their ends are one; others are
//      left out, and it is said. Where there is none, one is made around the branches (outline.h).
//   3. Branches are of the first order. One of the second order hangs on the branch that it grows from; one
//   of
//      a higher order is left out, and it is said.
//   4. The outline crosses no branch, and is nearly closed. It is closed by its chord; what leaves the crown
//      stays, and it is said.
//   5. Each stroke is one line. Here, too.
// Beyond the paper, an outline must go around something, and a trunk must stand: without that a trunk that
// pokes out of its crown, a bush whose outline is lowest, and a drawing without outline go wrong.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "sketch/flat_line.h"
#include "sketch/strokes.h"

namespace treerec {

struct Recognised {
    std::vector<StrokeRole> roles;    // of each line; kAuto: left out
    std::vector<std::string> faults;  // of each line; why it was left out
    std::vector<size_t> outlines;     // the largest first
    std::vector<size_t> trunks;       // two: its sides
    std::vector<size_t> branches;     // in their order
    bool goes_around = false;         // the one trunk's line goes around both its sides
};

// lines: cleaned (clean.h); those of one point are left out. wanted: what the user says that each is, kAuto
// where nothing.
Recognised recognise(std::span<const FlatLine> lines, std::span<const StrokeRole> wanted);

}  // namespace treerec
