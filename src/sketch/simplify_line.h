// Fewer points for the same line.
#pragma once

#include <cstddef>
#include <vector>

#include "geometry/vec.h"

namespace treerec {

// The places of the points that are enough: none left out is farther than `tolerance` from the line through
// those kept (Douglas and Peucker 1973). `keep` are kept, too, as are both ends. Ascending.
std::vector<size_t> simplify_line(const std::vector<DVec2>& points, const std::vector<size_t>& keep,
                                  double tolerance);

// Puts back points of the line between kept ones, so that steps longer than `longest` have a point between,
// where the line has any there.
std::vector<size_t> split_long_steps(const std::vector<DVec2>& points, const std::vector<size_t>& kept,
                                     double longest);

}  // namespace treerec
