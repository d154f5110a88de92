#include "scan/lone_trunk.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "geometry/bounds.h"
#include "geometry/portable_math.h"
#include "geometry/quantile.h"

namespace treerec {

namespace {

constexpr size_t kSlices = 16;
constexpr size_t kLeastPoints = 12;  // of a slice
constexpr double kMostRough = 0.08;  // of the radius: that half of the points lie off the bark
constexpr size_t kSectors = 24;
constexpr size_t kLeastSectors = 10;  // seen from one side
constexpr double kMostWider = 1.67;   // than the stem usually is, or thinner
constexpr double kMostAside = 0.5;    // of the radius, from slice to slice
constexpr double kNearlyAll = 0.8;    // of the points

struct Ring {
    DVec2 centre{0.0};
    double radius = 0.0;
};

// The circle with the least squares of |p|^2 - 2 c.p - k (I. Kåsa, "A circle fitting procedure and its error
// analysis", 1976), where the points are those of bark.
std::optional<Ring> ring_of(const std::vector<DVec2>& points) {
    const auto count = static_cast<double>(points.size());
    DVec2 mean(0.0);
    for (const DVec2& p : points)
        mean += p / count;
    DVec2 along(0.0), moment(0.0);  // of squares; and of the squares' product with each axis
    double across = 0.0, squares = 0.0;
    for (const DVec2& p : points) {
        const DVec2 d = p - mean;
        const double square = glm::dot(d, d);
        along += d * d / count;
        across += d.x * d.y / count;
        moment += d * (square / count);
        squares += square / count;
    }
    const double determinant = along.x * along.y - across * across;
    if (!(determinant > 1e-9 * squares * squares)) return std::nullopt;
    const DVec2 off = DVec2(along.y * moment.x - across * moment.y, along.x * moment.y - across * moment.x) /
                      (2.0 * determinant);
    const Ring ring{mean + off, std::sqrt(squares + glm::dot(off, off))};
    std::vector<double> residuals;
    std::array<bool, kSectors> seen{};
    for (const DVec2& p : points) {
        const DVec2 d = p - ring.centre;
        residuals.push_back(std::abs(glm::length(d) - ring.radius));
        const double turn = portable::atan2(d.y, d.x) / (2.0 * kPi) + 0.5;
        seen[std::min(static_cast<size_t>(turn * kSectors), kSectors - 1)] = true;
    }
    if (quantile(residuals, 0.5) > kMostRough * ring.radius) return std::nullopt;
    if (static_cast<size_t>(std::count(seen.begin(), seen.end(), true)) < kLeastSectors) return std::nullopt;
    return ring;
}

}  // namespace

bool is_lone_trunk(const std::vector<Vec3>& points, const Progress& progress) {
    if (points.size() < kSlices * kLeastPoints) return false;
    Bounds bounds;
    for (const Vec3& p : points)
        bounds.add(DVec3(p));
    const double height = bounds.size().y;
    if (!(height > 0.0)) return false;
    std::vector<std::vector<DVec2>> slices(kSlices);
    for (const Vec3& p : points) {
        const double at = (p.y - bounds.min.y) / height * static_cast<double>(kSlices);
        slices[std::min(static_cast<size_t>(at), kSlices - 1)].emplace_back(p.x, p.z);
    }
    std::array<std::optional<Ring>, kSlices> rings;
    std::vector<double> radii;
    for (size_t s = 0; s < kSlices; s++) {
        progress.check();
        if (slices[s].size() >= kLeastPoints) rings[s] = ring_of(slices[s]);
        if (rings[s]) radii.push_back(rings[s]->radius);
    }
    if (radii.empty()) return false;
    const double radius = quantile(radii, 0.5);
    size_t on_bark = 0;
    const Ring* below = nullptr;
    for (size_t s = 0; s < kSlices; s++) {
        if (!rings[s] || rings[s]->radius > kMostWider * radius || rings[s]->radius * kMostWider < radius)
            continue;
        if (below && glm::distance(below->centre, rings[s]->centre) > kMostAside * radius) continue;
        below = &*rings[s];
        on_bark += slices[s].size();
    }
    return static_cast<double>(on_bark) > kNearlyAll * static_cast<double>(points.size());
}

}  // namespace treerec
