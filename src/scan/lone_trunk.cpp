#include "scan/lone_trunk.h"

#include <algorithm>
#include <array>
#include <optional>

#include "geometry/bounds.h"
#include "geometry/circle_fit.h"
#include "geometry/quantile.h"

namespace treerec {

namespace {

constexpr size_t kSlices = 16;
constexpr size_t kLeastPoints = 12;     // of a slice
constexpr double kMostRough = 0.08;     // of the radius: that half of the points lie off the bark
constexpr double kLeastCoverage = 0.4;  // of the circle: seen from one side
constexpr double kMostWider = 1.67;     // than the stem usually is, or thinner
constexpr double kMostAside = 0.5;      // of the radius, from slice to slice
constexpr double kNearlyAll = 0.8;      // of the points

}  // namespace

bool is_lone_trunk(const std::vector<Vec3>& points, const Progress& progress) {
    if (points.size() < kSlices * kLeastPoints) return false;
    Bounds bounds;
    for (const Vec3& p : points)
        bounds.add(DVec3(p));
    const double height = bounds.size().y;
    if (!(height > 0.0)) return false;
    const double widest = std::max(bounds.size().x, bounds.size().z);
    std::vector<std::vector<DVec2>> slices(kSlices);
    for (const Vec3& p : points) {
        const double at = (p.y - bounds.min.y) / height * static_cast<double>(kSlices);
        slices[std::min(static_cast<size_t>(at), kSlices - 1)].emplace_back(p.x, p.z);
    }
    std::array<std::optional<CircleFit>, kSlices> rings;
    std::vector<double> radii;
    for (size_t s = 0; s < kSlices; s++) {
        progress.check();
        if (slices[s].size() < kLeastPoints) continue;
        const std::optional<CircleFit> ring = fit_circle(slices[s], widest, Random(s));
        if (!ring || ring->spread > kMostRough * ring->radius || ring->coverage < kLeastCoverage) continue;
        rings[s] = ring;
        radii.push_back(ring->radius);
    }
    if (radii.empty()) return false;
    const double radius = quantile(radii, 0.5);
    size_t on_bark = 0;
    const CircleFit* below = nullptr;
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
