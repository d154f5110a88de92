// The crown's parts as the paper makes them: alpha shapes of random points (Ma and Liu 2020, 3.2).
#pragma once

#include <memory>

#include "progress.h"
#include "sketch/axis_cells.h"
#include "sketch/crown_bound.h"

namespace treerec {

// Fills the crown with random points, gives each to the branch nearest to it (equation 3), and bounds each
// branch's by the alpha shape (Edelsbrunner and Muecke 1994) whose alpha is 3 times the least at which it is
// in one piece; alpha is a radius here. A branch with no room bounds everything away. axes: how many. The
// same seed gives the same. Throws Cancelled, and Error in a build without CGAL.
std::unique_ptr<const CrownBound> alpha_crown(const CrownSections& crown, const AxisCells& cells, size_t axes,
                                              uint64_t seed, const Progress* progress);

}  // namespace treerec
