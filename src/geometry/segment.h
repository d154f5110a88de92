// Points against line segments.
#pragma once

#include <algorithm>

#include "geometry/vec.h"

namespace treerec {

// The distance of p from the segment a-b; where: if given, gets the nearest place, 0 at a, 1 at b.
inline double distance_to_segment(const DVec3& p, const DVec3& a, const DVec3& b, double* where = nullptr) {
    const DVec3 ab = b - a;
    const double square = glm::dot(ab, ab);
    const double t = square > 0.0 ? std::clamp(glm::dot(p - a, ab) / square, 0.0, 1.0) : 0.0;
    if (where) *where = t;
    return glm::distance(p, a + t * ab);
}

}  // namespace treerec
