#include "skeleton/flood/flood_fit.h"

#include <algorithm>
#include <cmath>

#include "geometry/circle_fit.h"

namespace treerec {

namespace {

constexpr int kRounds = 2;
constexpr size_t kRingPoints = 12;
constexpr double kRingCoverage = 0.6;  // of the directions
constexpr double kRingSpread = 0.15;   // of the radius
constexpr double kRingInside = 0.15;   // of the points
constexpr double kBeginning = 0.05;    // of the points lie before where they are said to begin

template <typename Body>
void for_points(const FloodGrid& grid, const std::vector<Vec3>& points, const std::vector<uint32_t>& voxels,
                const Body& body) {
    for (const uint32_t v : voxels)
        for (const uint32_t i : grid.cells.in_cell(v))
            body(DVec3(points[i]));
}

double distance_from(const DVec3& d, const DVec3& direction) {
    return glm::length(d - glm::dot(d, direction) * direction);
}

}  // namespace

LineFit fit_line(const FloodGrid& grid, const std::vector<Vec3>& points, const DVec3& node,
                 const std::vector<uint32_t>& voxels) {
    LineFit fit;
    DVec3 sum(0.0);
    for_points(grid, points, voxels, [&](const DVec3& p) {
        sum += p - node;
        fit.points++;
    });
    if (fit.points == 0) return fit;
    fit.direction = normalized_or(sum, fit.direction);
    for (int round = 0; round < kRounds; round++) {
        // Of the equations t_i d = p_i - node, the least-squares solution is along sum t_i (p_i - node).
        DVec3 weighted(0.0);
        for_points(grid, points, voxels, [&](const DVec3& p) {
            weighted += std::max(0.0, glm::dot(p - node, fit.direction)) * (p - node);
        });
        fit.direction = normalized_or(weighted, fit.direction);
    }
    std::vector<double> along;
    along.reserve(fit.points);
    double mean = 0.0;
    for_points(grid, points, voxels, [&](const DVec3& p) {
        along.push_back(glm::dot(p - node, fit.direction));
        mean += along.back();
    });
    const double count = static_cast<double>(fit.points);
    const auto begin = along.begin() + static_cast<ptrdiff_t>(kBeginning * count);
    std::nth_element(along.begin(), begin, along.end());
    fit.length = std::max(0.0, 2.0 * mean / count - std::max(0.0, *begin));
    const Ring ring = ring_around(grid, points, node, fit.direction, voxels);
    fit.radius = ring.mean;
    fit.deviation = ring.deviation;
    return fit;
}

Ring ring_around(const FloodGrid& grid, const std::vector<Vec3>& points, const DVec3& node,
                 const DVec3& direction, const std::vector<uint32_t>& voxels, double inner) {
    Ring ring;
    double count = 0.0;
    for_points(grid, points, voxels, [&](const DVec3& p) {
        const double distance = distance_from(p - node, direction);
        ring.mean += distance;
        ring.farthest = std::max(ring.farthest, distance);
        ring.within += distance < inner;
        count += 1.0;
    });
    if (count == 0.0) return ring;
    ring.mean /= count;
    for_points(grid, points, voxels, [&](const DVec3& p) {
        ring.deviation += std::abs(distance_from(p - node, direction) - ring.mean);
    });
    ring.deviation /= count;
    return ring;
}

bool surround(const FloodGrid& grid, const std::vector<Vec3>& points, const DVec3& direction,
              const std::vector<uint32_t>& voxels, double most_radius, uint64_t seed, DVec3& end,
              double& radius) {
    const DVec3 u = any_perpendicular(direction);
    const DVec3 v = glm::cross(direction, u);
    std::vector<DVec2> across;
    for_points(grid, points, voxels,
               [&](const DVec3& p) { across.emplace_back(glm::dot(p - end, u), glm::dot(p - end, v)); });
    if (across.size() < kRingPoints) return false;
    const std::optional<CircleFit> circle = fit_circle(across, most_radius, Random(seed, across.size()));
    if (!circle || circle->coverage < kRingCoverage || circle->spread > kRingSpread * circle->radius ||
        circle->inside > kRingInside)
        return false;
    end += circle->centre.x * u + circle->centre.y * v;
    radius = circle->radius;
    return true;
}

}  // namespace treerec
