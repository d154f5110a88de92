// Axis-aligned bounding box.
#pragma once

#include <limits>

#include "geometry/vec.h"

namespace treerec {

struct Bounds {
    DVec3 min{std::numeric_limits<double>::max()};
    DVec3 max{std::numeric_limits<double>::lowest()};

    bool empty() const { return min.x > max.x; }
    void add(const DVec3& p) {
        min = glm::min(min, p);
        max = glm::max(max, p);
    }
    void add(const DVec3& centre, double radius) {
        add(centre - radius);
        add(centre + radius);
    }
    DVec3 size() const { return empty() ? DVec3(0) : max - min; }
    DVec3 centre() const { return empty() ? DVec3(0) : 0.5 * (min + max); }
    double diagonal() const { return glm::length(size()); }
};

}  // namespace treerec
