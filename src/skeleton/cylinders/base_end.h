// The end of a branch at which it came off its tree.
#pragma once

#include <vector>

#include "geometry/vec.h"
#include "progress.h"
#include "skeleton/passes.h"

namespace treerec {

struct BaseEnd {
    DVec3 position{0.0};
    DVec3 direction{0.0};  // unit; the way the wood goes from there
};

// Whichever way the branch lies: side branches lean the way the wood grows. So the ends of long branches, and
// the lowest point, are taken for the root one after the other, and the one stays from which the wood goes on
// most nearly straight at its forks, as a mean of the cosines by the side branches' lengths and points; of
// those alike, the thickest. A shortest path cuts the corner of every fork that it comes through, from any
// root; that is the same for all. Where there is hardly a fork, or the points are too far apart, it is the
// thicker end of the longest path. points: of wood, metres, distinct; some 20,000 of them are looked at.
// Throws Cancelled.
BaseEnd find_base_end(const std::vector<Vec3>& points, Progress& progress, PassSet left_out = {});

}  // namespace treerec
