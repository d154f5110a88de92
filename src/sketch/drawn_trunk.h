// The trunk's line out of what was drawn of it, or of what was not.
#pragma once

#include <optional>

#include "sketch/flat_line.h"
#include "sketch/strokes.h"

namespace treerec {

// From the lower end up. reversed: gets whether it was drawn downwards.
FlatLine upward(const FlatLine& line, bool* reversed);

// The middle of two sides, with half of what is between them as radii. Both go from about the ground up.
DrawnLine middle_of_sides(const FlatLine& left, const FlatLine& right);
// The same of a line around both sides.
DrawnLine middle_of_outline(const FlatLine& around);

// Straight from below a crown into it. lowest: the lowest point of all that was drawn. x: where it stands.
FlatLine make_trunk(const FlatLine& outline, double x, double lowest);

// A whole tree in one stroke: around trunk and crown, or up the trunk and around the crown.
struct Lollipop {
    FlatLine crown;   // a line to close
    DrawnLine trunk;  // without a stroke
};
// line: as drawn. polygon: what make_outline() made of it.
std::optional<Lollipop> split_lollipop(const FlatLine& line, const FlatLine& polygon);

// Longer where it ends below or just within the crown: on to three quarters of the crown's height. Whether
// it was.
bool reach_into_crown(DrawnLine& trunk, const FlatLine& outline);

}  // namespace treerec
