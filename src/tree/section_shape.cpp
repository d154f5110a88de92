#include "tree/section_shape.h"

namespace treerec {

DVec3 section_zero(const DVec3& direction) {
    const double share = direction.x / std::max(1.0 + direction.y, 1e-9);
    const DVec3 turned = DVec3(1, 0, 0) - (DVec3(0, 1, 0) + direction) * share;
    return normalized_or(turned - direction * glm::dot(turned, direction), any_perpendicular(direction));
}

double section_steadiness(const DVec3& direction) {
    return glm::smoothstep(-0.95, -0.8, direction.y);
}

}  // namespace treerec
