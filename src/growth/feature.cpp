#include "growth/feature.h"

#include "geometry/portable_math.h"

namespace treerec::growth {

double burl_growth(double radius, double inner, double growth, double distance) {
    if (distance >= radius) return 0.0;
    if (distance <= inner) return growth;
    const double t = (radius - distance) / (radius - inner);
    return growth * t * t * (3.0 - 2.0 * t);
}

void Region::add(const DVec3& a, const DVec3& b, const DVec3& c) {
    triangles_.push_back({a, b, c});
    for (const DVec3& p : {a, b, c})
        box_.take(p);
}

bool Region::holds(const DVec3& point) const {
    if (glm::any(glm::lessThan(point, box_.low)) || glm::any(glm::greaterThan(point, box_.high)))
        return false;
    double angle = 0.0;  // solid, halved
    for (const std::array<DVec3, 3>& triangle : triangles_) {
        const DVec3 a = triangle[0] - point, b = triangle[1] - point, c = triangle[2] - point;
        const double x = glm::length(a), y = glm::length(b), z = glm::length(c);
        angle += portable::atan2(glm::dot(a, glm::cross(b, c)),
                                 x * y * z + glm::dot(a, b) * z + glm::dot(b, c) * x + glm::dot(c, a) * y);
    }
    return std::abs(angle) > kPi;  // 2 pi inside, 0 outside
}

}  // namespace treerec::growth
