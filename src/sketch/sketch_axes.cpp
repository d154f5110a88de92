#include "sketch/sketch_axes.h"

#include <algorithm>
#include <utility>

#include "geometry/segment.h"

namespace treerec {

double length_of(const std::vector<DVec3>& points) {
    double length = 0.0;
    for (size_t i = 1; i < points.size(); i++)
        length += glm::length(points[i] - points[i - 1]);
    return length;
}

namespace {

// The segment's first point, and how far on it, 0..1.
std::pair<size_t, double> find_along(const std::vector<DVec3>& points, double along) {
    for (size_t i = 1; i < points.size(); i++) {
        const double length = glm::length(points[i] - points[i - 1]);
        if (along <= length && length > 0.0) return {i - 1, std::max(along, 0.0) / length};
        along -= length;
    }
    return {points.size() - 2, 1.0};
}

}  // namespace

DVec3 place_along(const std::vector<DVec3>& points, double along) {
    const auto [i, part] = find_along(points, along);
    return points[i] + (points[i + 1] - points[i]) * part;
}

DVec3 direction_along(const std::vector<DVec3>& points, double along) {
    const size_t i = find_along(points, along).first;
    return normalized_or(points[i + 1] - points[i], DVec3(0.0, 1.0, 0.0));
}

double value_along(const std::vector<DVec3>& points, const std::vector<double>& values, double along) {
    const auto [i, part] = find_along(points, along);
    return values[i] + (values[i + 1] - values[i]) * part;
}

double nearest_along(const std::vector<DVec3>& points, const DVec3& p) {
    double along = 0.0, nearest = 0.0, least = 1e300;
    for (size_t i = 0; i + 1 < points.size(); i++) {
        double where;
        const double square = square_to_segment(p, points[i], points[i + 1], where);
        const double length = glm::length(points[i + 1] - points[i]);
        if (square < least) {
            least = square;
            nearest = along + where * length;
        }
        along += length;
    }
    return nearest;
}

std::vector<double> tapered(const std::vector<DVec3>& points, double base, double least) {
    const double length = length_of(points);
    std::vector<double> radii(points.size(), std::max(base, least));
    double along = 0.0;
    for (size_t i = 1; i < points.size(); i++) {
        along += glm::length(points[i] - points[i - 1]);
        radii[i] = std::max(base * (length > 0.0 ? 1.0 - along / length : 1.0), least);
    }
    return radii;
}

}  // namespace treerec
