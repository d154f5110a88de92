#include "mesh/parallel_transport.h"

namespace treerec {

void parallel_transport(Ring* rings, size_t count) {
    if (count == 0) return;
    DVec3 normal = rings[0].normal;
    DVec3 x = any_perpendicular(normal);
    for (size_t i = 0; i < count; i++) {
        Ring& ring = rings[i];
        const double turn = 1.0 + glm::dot(normal, ring.normal);
        if (turn > 1e-9) x -= (normal + ring.normal) * (glm::dot(x, ring.normal) / turn);
        normal = ring.normal;
        x = normalized_or(x - normal * glm::dot(x, normal), any_perpendicular(normal));
        ring.x = x;
    }
}

}  // namespace treerec
