// Strokes without what the hand and the mouse add to them (Ma and Liu 2020, 2.1).
#pragma once

#include <span>

#include "sketch/flat_line.h"

namespace treerec {

inline constexpr double kLeastSpacing = 3.0;  // pixels: the paper's k
// What the later steps want between points of a line: straight pieces that are longer get points.
inline constexpr double kMostSpacing = 4.0;

// Points closer than `least` to the last one that was kept go (not to the one before, or all of a slow stroke
// would); both ends stay. All lengths are pixels.
FlatLine thin_line(const FlatLine& line, double least);
// Even points on pieces longer than `most`. pinned: gets, for each point, whether it lies between two pieces
// longer than `far`: then it was put there, and is no noise of a sampled line.
FlatLine fill_line(const FlatLine& line, double most, double far, std::vector<bool>* pinned);
// Equation 1: each point is the mean of the five around it with weights .07 .13 .60 .13 .07. The two at each
// end, which lack a neighbour, stay, and so do pinned ones.
FlatLine smooth_line(const FlatLine& line, const std::vector<bool>& pinned);

// All of it, for each of the strokes of a drawing. A line of one point stays one (as does one whose points
// are all the same). No two points that follow one another are equal. Where there is more than thousands of
// pixels to follow, all spacings grow, so that the work stays bounded.
std::vector<FlatLine> clean_lines(std::span<const FlatLine> lines);

}  // namespace treerec
