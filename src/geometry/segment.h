// Points against line segments.
#pragma once

#include <algorithm>

#include "geometry/vec.h"

namespace treerec {

// The squared distance of p from the segment a-b; where: gets the nearest place, 0 at a, 1 at b.
inline double square_to_segment(const DVec3& p, const DVec3& a, const DVec3& b, double& where) {
    const DVec3 ab = b - a;
    const double square = glm::dot(ab, ab);
    const double t = square > 0.0 ? glm::dot(p - a, ab) / square : 0.0;
    where = std::min(std::max(t, 0.0), 1.0);
    const DVec3 off = a + where * ab - p;
    return glm::dot(off, off);
}

// The distance of p from the segment a-b; where: if given, gets the nearest place, 0 at a, 1 at b.
inline double distance_to_segment(const DVec3& p, const DVec3& a, const DVec3& b, double* where = nullptr) {
    double t;
    const double square = square_to_segment(p, a, b, t);
    if (where) *where = t;
    return std::sqrt(square);
}

}  // namespace treerec
