#include "mesh/parallel_transport.h"

#include "geometry/portable_math.h"

namespace treerec {

void parallel_transport(Ring* rings, size_t count, double turn) {
    if (count == 0) return;
    DVec3 normal = rings[0].normal;
    DVec3 x = any_perpendicular(normal);
    if (turn != 0.0) x = x * portable::cos(turn) + glm::cross(normal, x) * portable::sin(turn);
    for (size_t i = 0; i < count; i++) {
        Ring& ring = rings[i];
        const double cosine = 1.0 + glm::dot(normal, ring.normal);
        if (cosine > 1e-9) x -= (normal + ring.normal) * (glm::dot(x, ring.normal) / cosine);
        normal = ring.normal;
        x = normalized_or(x - normal * glm::dot(x, normal), any_perpendicular(normal));
        ring.x = x;
    }
}

}  // namespace treerec
