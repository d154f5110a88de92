// Vector types. float for bulk data (points, vertices), double for the tree and for arithmetic.
#pragma once

#include <cmath>
#include <glm/glm.hpp>

namespace treerec {

using Vec2 = glm::vec2;
using Vec3 = glm::vec3;
using Vec4 = glm::vec4;
using DVec2 = glm::dvec2;
using DVec3 = glm::dvec3;
using DMat3 = glm::dmat3;

inline constexpr double kPi = 3.14159265358979323846;

inline bool is_finite(const DVec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

// v / |v|, or `fallback` where |v| is too small to have a direction.
inline DVec3 normalized_or(const DVec3& v, const DVec3& fallback) {
    const double length = glm::length(v);
    return length > 1e-12 ? v / length : fallback;
}

// Some unit vector perpendicular to the unit vector `direction`.
inline DVec3 any_perpendicular(const DVec3& direction) {
    const DVec3 axis = std::abs(direction.y) < 0.9 ? DVec3(0, 1, 0) : DVec3(1, 0, 0);
    return glm::normalize(glm::cross(direction, axis));
}

}  // namespace treerec
