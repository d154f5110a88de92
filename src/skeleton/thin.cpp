#include "skeleton/thin.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "geometry/bounds.h"

namespace treerec {

namespace {

constexpr double kCellsPerAxis = 2097152.0;  // 21 bits per axis in one 64-bit key

struct KeyedPoint {
    uint64_t key;
    Vec3 position;
};

bool finite(const Vec3& p) {
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

bool before(const Vec3& a, const Vec3& b) {
    if (a.x != b.x) return a.x < b.x;
    if (a.y != b.y) return a.y < b.y;
    return a.z < b.z;
}

Bounds finite_bounds(const std::vector<Vec3>& points) {
    Bounds bounds;
    for (const Vec3& p : points)
        if (finite(p)) bounds.add(DVec3(p));
    return bounds;
}

// Never so small that the cells of one axis would outgrow their bits.
double safe_spacing(const Bounds& bounds, double spacing) {
    const DVec3 size = bounds.size();
    return std::max(spacing, std::max({size.x, size.y, size.z}) / (kCellsPerAxis - 2.0));
}

uint64_t cell_key(const Vec3& p, const DVec3& low, double inverse_spacing) {
    const DVec3 cell = glm::floor((DVec3(p) - low) * inverse_spacing);
    return (static_cast<uint64_t>(cell.y) << 42) | (static_cast<uint64_t>(cell.x) << 21) |
           static_cast<uint64_t>(cell.z);
}

size_t occupied_cells(const std::vector<Vec3>& points, const Bounds& bounds, double spacing,
                      std::vector<uint64_t>& keys) {
    const double inverse = 1.0 / safe_spacing(bounds, spacing);
    keys.clear();
    for (const Vec3& p : points)
        if (finite(p)) keys.push_back(cell_key(p, bounds.min, inverse));
    std::sort(keys.begin(), keys.end());
    return static_cast<size_t>(std::unique(keys.begin(), keys.end()) - keys.begin());
}

}  // namespace

std::vector<Vec3> thin_points(const std::vector<Vec3>& points, double spacing, Progress& progress) {
    const Bounds bounds = finite_bounds(points);
    if (bounds.empty()) return {};
    const double inverse = 1.0 / safe_spacing(bounds, spacing);
    std::vector<KeyedPoint> keyed;
    keyed.reserve(points.size());
    for (const Vec3& p : points)
        if (finite(p)) keyed.push_back({cell_key(p, bounds.min, inverse), p});
    progress.check();
    std::sort(keyed.begin(), keyed.end(), [](const KeyedPoint& a, const KeyedPoint& b) {
        return a.key != b.key ? a.key < b.key : before(a.position, b.position);
    });
    progress.check();

    std::vector<Vec3> thinned;
    for (size_t begin = 0, end = 0; begin < keyed.size(); begin = end) {
        DVec3 mean(0.0);
        size_t distinct = 0;
        for (end = begin; end < keyed.size() && keyed[end].key == keyed[begin].key; end++) {
            if (end > begin && keyed[end].position == keyed[end - 1].position) continue;
            mean += DVec3(keyed[end].position);
            distinct++;
        }
        mean /= static_cast<double>(distinct);
        size_t best = begin;
        double best_distance = std::numeric_limits<double>::max();
        for (size_t i = begin; i < end; i++) {
            const DVec3 offset = DVec3(keyed[i].position) - mean;
            const double distance = glm::dot(offset, offset);
            if (distance < best_distance) {
                best_distance = distance;
                best = i;
            }
        }
        thinned.push_back(keyed[best].position);
    }
    return thinned;
}

double automatic_spacing(const std::vector<Vec3>& points) {
    const Bounds bounds = finite_bounds(points);
    double spacing = std::max(std::clamp(bounds.diagonal() / 2000.0, 0.001, 0.02), bounds.diagonal() * 1e-5);
    if (points.size() <= kMostPoints) return spacing;
    std::vector<uint64_t> keys;
    keys.reserve(points.size());
    // A scanned tree is between a line and a volume: the count falls with about the square of the spacing.
    for (size_t count = occupied_cells(points, bounds, spacing, keys); count > kMostPoints;
         count = occupied_cells(points, bounds, spacing, keys))
        spacing *= std::clamp(std::sqrt(static_cast<double>(count) / kMostPoints), 1.05, 4.0);
    return spacing;
}

}  // namespace treerec
