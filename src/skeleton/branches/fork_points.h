// The points of stretches of branches, and how far they keep from bark.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "geometry/segment.h"
#include "skeleton/branches/skeleton_branches.h"
#include "skeleton/branches/slices.h"
#include "skeleton/cylinders/axis.h"

namespace treerec {

// Adds the points of the branch's stations [first, last], merged and absorbed slices included.
void gather_points(const SkeletonBranch& branch, const Slices& slices, int32_t first, int32_t last,
                   std::vector<uint32_t>& found);

// Leaves an even sample of so many as a mean needs, in ascending order.
void thin_out(std::vector<uint32_t>& found);

// Metres: how far p is outside of the cone between two stations; below 0 inside.
inline double outside(const DVec3& p, const Station& a, const Station& b) {
    double t;
    const double distance = std::sqrt(square_to_segment(p, a.position, b.position, t));
    return distance - (a.radius + t * (b.radius - a.radius));
}

// Hermite's cubic from `from` (t 0) to `to` (t 1), with derivatives there.
inline DVec3 hermite(const DVec3& from, const DVec3& start, const DVec3& to, const DVec3& end, double t) {
    const double u = 1.0 - t;
    return (1.0 + 2.0 * t) * u * u * from + t * u * u * start + t * t * (3.0 - 2.0 * t) * to -
           t * t * u * end;
}

}  // namespace treerec
