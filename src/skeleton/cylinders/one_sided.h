// How thick wood is that the scanner saw from one side only.
#pragma once

#include <span>
#include <vector>

#include "geometry/vec.h"

namespace treerec {

// The radius in metres of a cross-section, better than `median`, its points' median distance to the axis: of
// bark that is seen from one side, the axis runs through the middle of what is seen, too near to the points,
// and half of the true radius is what they tell. But across the view they reach from edge to edge. The less
// round the points lie, the more of that is believed; points all around, few ones and wood that is not much
// thicker than the noise give the median. offsets: metres, in the section's plane, from the axis. noise:
// metres, a standard deviation; 0 where unknown, which gives the median. scratch: any.
double radius_across(std::span<const Vec2> offsets, double median, double noise, std::vector<float>& scratch);

}  // namespace treerec
