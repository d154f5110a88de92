// How points lie about their mean.
#pragma once

#include <vector>

#include "geometry/vec.h"

namespace treerec {

// Square units of the points, divided by their number. points: at least one.
inline DMat3 covariance_of(const std::vector<Vec3>& points) {
    DVec3 mean(0.0);
    for (const Vec3& p : points)
        mean += DVec3(p);
    mean /= static_cast<double>(points.size());
    DMat3 covariance(0.0);
    for (const Vec3& p : points) {
        const DVec3 d = DVec3(p) - mean;
        covariance += glm::outerProduct(d, d);
    }
    return covariance / static_cast<double>(points.size());
}

}  // namespace treerec
