// Points against triangles.
#pragma once

#include "geometry/segment.h"
#include "geometry/vec.h"

namespace treerec {

// The place on the triangle abc that is nearest to p, as shares of its corners, which sum up to 1. Of one
// without area: on one of its sides.
inline DVec3 nearest_in_triangle(const DVec3& p, const DVec3& a, const DVec3& b, const DVec3& c) {
    const DVec3 cross = glm::cross(b - a, c - a);
    const double square = glm::dot(cross, cross);
    if (square > 0.0) {
        const DVec3 shares(glm::dot(glm::cross(b - p, c - p), cross) / square,
                           glm::dot(glm::cross(c - p, a - p), cross) / square,
                           glm::dot(glm::cross(a - p, b - p), cross) / square);
        if (shares.x >= 0.0 && shares.y >= 0.0 && shares.z >= 0.0) return shares;
    }
    DVec3 best(1.0, 0.0, 0.0);
    double least = -1.0;
    const DVec3 corners[3] = {a, b, c};
    for (int k = 0; k < 3; k++) {
        const int next = (k + 1) % 3;
        double where = 0.0;
        const double far = square_to_segment(p, corners[k], corners[next], where);
        if (least >= 0.0 && far >= least) continue;
        least = far;
        best = DVec3(0.0);
        best[k] = 1.0 - where;
        best[next] = where;
    }
    return best;
}

}  // namespace treerec
