#include "scan/stems/lone_trunk.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

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

constexpr double kStumpHeight = 2.5;  // diameters: no higher
constexpr size_t kFewestRings = kSlices / 2;
constexpr double kStumpNarrows = 0.75;  // of its usual radius: a ball does more, at both ends
constexpr double kStumpShare = 0.95;    // of the points: on its bark and its cut faces
constexpr double kRingCoverage = 0.9;   // of a section that is closed, but not round
constexpr double kRingRough = 0.2;
constexpr double kRingInside = 0.04;
constexpr double kFaceWider = 1.15;   // than the bark next to it
constexpr double kBeyondEnds = 0.02;  // of the points, at either end

struct Trunk {
    size_t on_bark = 0;
    size_t on_faces = 0;  // points within the bark, where the trunk ends
    double radius = 0.0;  // the median; 0 where no bark is seen
    double height = 0.0;
    std::vector<TrunkRing> rings;  // from below
};

// flutes: whether sections that are closed but not round count as bark.
Trunk trunk_of(const std::vector<Vec3>& points, bool flutes, const Progress* progress) {
    Trunk trunk;
    if (points.size() < kSlices * kLeastPoints) return trunk;
    Bounds bounds;
    for (const Vec3& p : points)
        bounds.add(DVec3(p));
    const double height = trunk.height = bounds.size().y;
    if (!(height > 0.0)) return trunk;
    const double widest = std::max(bounds.size().x, bounds.size().z);
    std::vector<std::vector<DVec2>> slices(kSlices);
    for (const Vec3& p : points) {
        const double at = (p.y - bounds.min.y) / height * static_cast<double>(kSlices);
        slices[std::min(static_cast<size_t>(at), kSlices - 1)].emplace_back(p.x, p.z);
    }
    std::array<std::optional<CircleFit>, kSlices> rings;
    std::vector<double> radii;
    for (size_t s = 0; s < kSlices; s++) {
        if (progress) progress->check();
        if (slices[s].size() < kLeastPoints) continue;
        std::optional<CircleFit> ring = fit_circle(slices[s], widest, Random(s));
        if (ring && (ring->spread > kMostRough * ring->radius || ring->coverage < kLeastCoverage))
            ring.reset();
        if (!ring && flutes) {
            ring = fit_ring(slices[s]);
            if (ring && (ring->spread > kRingRough * ring->radius || ring->coverage < kRingCoverage ||
                         ring->inside > kRingInside))
                ring.reset();
        }
        if (!ring) continue;
        rings[s] = ring;
        radii.push_back(ring->radius);
    }
    if (radii.empty()) return trunk;
    const double radius = trunk.radius = quantile(radii, 0.5);
    const CircleFit* below = nullptr;
    std::array<bool, kSlices> bark{};
    for (size_t s = 0; s < kSlices; s++) {
        if (!rings[s] || rings[s]->radius > kMostWider * radius || rings[s]->radius * kMostWider < radius)
            continue;
        if (below && glm::distance(below->centre, rings[s]->centre) > kMostAside * radius) continue;
        below = &*rings[s];
        bark[s] = true;
        trunk.on_bark += slices[s].size();
        const double y =
            bounds.min.y + (static_cast<double>(s) + 0.5) / static_cast<double>(kSlices) * height;
        trunk.rings.push_back({{below->centre.x, y, below->centre.y}, below->radius, below->spread});
    }
    for (const auto& [end, beside] : {std::pair<size_t, size_t>{0, 1}, {kSlices - 1, kSlices - 2}})
        if (!bark[end] && bark[beside])
            for (const DVec2& p : slices[end])
                trunk.on_faces +=
                    glm::distance(p, rings[beside]->centre) < kFaceWider * rings[beside]->radius;
    return trunk;
}

// On to both ends, as the last two sections lead. What is left of the ground lies lower than the foot.
std::vector<TrunkRing> to_both_ends(Trunk& trunk, const std::vector<Vec3>& points) {
    std::vector<double> heights;
    heights.reserve(points.size());
    for (const Vec3& p : points)
        heights.push_back(p.y);
    const double low = quantile(heights, kBeyondEnds), high = quantile(heights, 1.0 - kBeyondEnds);
    std::erase_if(trunk.rings,
                  [&](const TrunkRing& ring) { return ring.centre.y <= low || ring.centre.y >= high; });
    if (trunk.rings.size() < 2) return {};
    const auto end = [](const TrunkRing& last, const TrunkRing& before, double y) {
        const double t = (y - last.centre.y) / (last.centre.y - before.centre.y);
        return TrunkRing{last.centre + t * (last.centre - before.centre),
                         std::max(0.5 * last.radius, last.radius + t * (last.radius - before.radius)),
                         last.scatter};
    };
    std::vector<TrunkRing>& rings = trunk.rings;
    const TrunkRing foot = end(rings[0], rings[1], low);
    const TrunkRing top = end(rings[rings.size() - 1], rings[rings.size() - 2], high);
    rings.insert(rings.begin(), foot);
    rings.push_back(top);
    return rings;
}

}  // namespace

bool is_lone_trunk(const std::vector<Vec3>& points, const Progress& progress) {
    const Trunk trunk = trunk_of(points, false, &progress);
    return static_cast<double>(trunk.on_bark) > kNearlyAll * static_cast<double>(points.size()) ||
           !stump_rings(points, &progress).empty();
}

std::vector<TrunkRing> stump_rings(const std::vector<Vec3>& points, const Progress* progress) {
    Trunk trunk = trunk_of(points, true, progress);
    if (trunk.rings.size() < kFewestRings || trunk.height >= kStumpHeight * 2.0 * trunk.radius ||
        static_cast<double>(trunk.on_bark + trunk.on_faces) <=
            kStumpShare * static_cast<double>(points.size()))
        return {};
    for (const TrunkRing& ring : trunk.rings)
        if (ring.radius < kStumpNarrows * trunk.radius) return {};
    return to_both_ends(trunk, points);
}

std::vector<TrunkRing> trunk_rings(const std::vector<Vec3>& points, const Progress* progress) {
    Trunk trunk = trunk_of(points, true, progress);
    if (trunk.rings.size() < kFewestRings) return {};
    return to_both_ends(trunk, points);
}

}  // namespace treerec
