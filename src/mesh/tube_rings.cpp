#include "mesh/tube_rings.h"

#include <algorithm>
#include <cmath>

namespace treerec {

void limit_tilt(Ring* rings, size_t count) {
    for (int pass = 0; pass < 3; pass++) {
        for (size_t i = 0; i + 1 < count; i++) {
            Ring &a = rings[i], &b = rings[i + 1];
            const double distance = glm::distance(a.centre, b.centre);
            const double sine_half = std::min(1.0, 0.4 * distance / std::max(a.radius, b.radius));
            const double least_cosine = 1.0 - 2.0 * sine_half * sine_half;
            const double cosine = glm::dot(a.normal, b.normal);
            if (cosine >= least_cosine) continue;
            const DVec3 mean =
                normalized_or(a.normal + b.normal, normalized_or(b.centre - a.centre, a.normal));
            const DVec3 side = normalized_or(b.normal - mean * glm::dot(b.normal, mean), DVec3(0.0));
            const double cosine_half = std::sqrt(1.0 - sine_half * sine_half);
            a.normal = normalized_or(mean * cosine_half - side * sine_half, mean);
            b.normal = normalized_or(mean * cosine_half + side * sine_half, mean);
        }
    }
}

}  // namespace treerec
