// Clouds of known shape for the skeleton tests.
#pragma once

#include <vector>

#include "geometry/random.h"
#include "scan/point_cloud.h"

namespace treerec::test {

// A surface point every `spacing` metres, on average, of the cone frustum from a to b, moved along the normal
// by noise (standard deviation, metres). from, to: the part of the way round that is seen, 0..1.
inline void add_cone(PointCloud& cloud, Random& random, const DVec3& a, const DVec3& b, double radius_a,
                     double radius_b, double spacing, double noise, double from = 0.0, double to = 1.0) {
    const DVec3 axis = glm::normalize(b - a);
    const DVec3 u = any_perpendicular(axis);
    const DVec3 v = glm::cross(axis, u);
    const double length = glm::distance(a, b);
    const double area = kPi * (radius_a + radius_b) * length * (to - from);
    const int count = static_cast<int>(area / (spacing * spacing));
    for (int i = 0; i < count; i++) {
        const double t = random.uniform();
        const double angle = 2.0 * kPi * random.uniform(from, to);
        const double radius = radius_a + t * (radius_b - radius_a) + noise * random.normal();
        cloud.positions.emplace_back(a + t * (b - a) + radius * (std::cos(angle) * u + std::sin(angle) * v));
    }
}

inline void add_bend(PointCloud& cloud, Random& random, const std::vector<DVec3>& line, double radius_a,
                     double radius_b, double spacing, double noise) {
    const double last = static_cast<double>(line.size() - 1);
    for (size_t i = 0; i + 1 < line.size(); i++) {
        const double s = static_cast<double>(i) / last;
        const double t = static_cast<double>(i + 1) / last;
        add_cone(cloud, random, line[i], line[i + 1], radius_a + s * (radius_b - radius_a),
                 radius_a + t * (radius_b - radius_a), spacing, noise);
    }
}

}  // namespace treerec::test
