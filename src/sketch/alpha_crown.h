// The crown's parts as the paper makes them: alpha shapes of random points (Ma and Liu 2020, 3.2).
#pragma once

#include <memory>

#include "progress.h"
#include "sketch/crown_bound.h"
#include "sketch/limb_cells.h"

namespace treerec {

// Fills the crown with random points, gives each to the limb nearest to it (equation 3), and bounds each
// limb's by the alpha shape (Edelsbrunner and Muecke 1994) whose alpha is 3 times the least at which it is in
// one piece; alpha is a radius here. A limb with no room bounds everything away. limbs: how many. The same
// seed gives the same. Throws Cancelled, and Error in a build without CGAL.
std::unique_ptr<const CrownBound> alpha_crown(const CrownSections& crown, const LimbCells& cells,
                                              size_t limbs, uint64_t seed, const Progress* progress);

}  // namespace treerec
