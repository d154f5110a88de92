#include "edit/commands/region.h"

#include <algorithm>

#include "error.h"

namespace treerec {

Region Region::box(const DVec3& one_corner, const DVec3& other_corner) {
    Region region;
    region.shape = Shape::kBox;
    region.a = glm::min(one_corner, other_corner);
    region.b = glm::max(one_corner, other_corner);
    if (!is_finite(one_corner) || !is_finite(other_corner))
        throw Error("A box's corners must be finite numbers.");
    return region;
}

Region Region::sphere(const DVec3& centre, double radius) {
    if (!is_finite(centre)) throw Error("A sphere's centre must be finite numbers.");
    if (!(radius > 0.0) || !std::isfinite(radius))
        throw Error("A sphere's radius must be positive and finite.");
    Region region;
    region.shape = Shape::kSphere;
    region.a = centre;
    region.radius = radius;
    return region;
}

Region Region::side(const DVec3& place, const DVec3& normal) {
    const DVec3 unit = normalized_or(normal, DVec3(0.0));
    if (!is_finite(place) || !is_finite(unit) || unit == DVec3(0.0))
        throw Error("A plane needs a place of finite numbers and a normal that is not zero.");
    Region region;
    region.shape = Shape::kSide;
    region.a = place;
    region.b = unit;
    return region;
}

bool Region::contains(const DVec3& p) const {
    switch (shape) {
        case Shape::kBox:
            return p.x >= a.x && p.y >= a.y && p.z >= a.z && p.x <= b.x && p.y <= b.y && p.z <= b.z;
        case Shape::kSphere:
            return glm::dot(p - a, p - a) <= radius * radius;
        case Shape::kSide:
            return glm::dot(p - a, b) >= 0.0;
    }
    return false;
}

double Region::entry(const DVec3& outside, const DVec3& inside) const {
    const DVec3 way = inside - outside;
    double t = 0.0;
    switch (shape) {
        case Shape::kBox:
            // The last of the slabs that the way enters.
            for (int axis = 0; axis < 3; axis++) {
                if (way[axis] > 0.0) t = std::max(t, (a[axis] - outside[axis]) / way[axis]);
                if (way[axis] < 0.0) t = std::max(t, (b[axis] - outside[axis]) / way[axis]);
            }
            break;
        case Shape::kSphere: {
            const DVec3 from = outside - a;
            const double square = glm::dot(way, way), half = glm::dot(from, way);
            const double rest = glm::dot(from, from) - radius * radius;
            const double root = std::sqrt(std::max(half * half - square * rest, 0.0));
            if (square > 0.0) t = (-half - root) / square;
            break;
        }
        case Shape::kSide: {
            const double before = glm::dot(outside - a, b), after = glm::dot(inside - a, b);
            if (after > before) t = -before / (after - before);
            break;
        }
    }
    return std::clamp(t, 0.0, 1.0);
}

DVec3 point_between(const ScanFrame& from, const ScanFrame& to, const DVec3& p) {
    return from == to ? p : to.to_tree(from.to_scan(p));
}

DVec3 direction_between(const ScanFrame& from, const ScanFrame& to, const DVec3& v) {
    return from.up == to.up ? v : to.turn_to_tree(from.turn_to_scan(v));
}

double length_between(const ScanFrame& from, const ScanFrame& to, double metres) {
    return from.metres_per_unit == to.metres_per_unit ? metres
                                                      : from.length_to_scan(metres) * to.metres_per_unit;
}

}  // namespace treerec
