#include "skeleton/cylinders/one_sided.h"

#include <algorithm>
#include <cmath>

namespace treerec {

namespace {

constexpr size_t kLeastPoints = 8;
constexpr double kLeastRadius = 4.0;  // standard deviations of the noise
// Depth over width of the points' spread (standard deviations). That of a half circle as a beam scans it is
// .39, of a whole one 1; chance and noise move both.
constexpr double kOneSided = 0.35;
constexpr double kAllAround = 0.6;
// Of a half circle that is scanned evenly across, so many points are within so much of the radius, sideways.
constexpr double kShare = 0.8;
constexpr double kReach = 0.8;
// What stays of it: twigs and wandering axes widen what is seen, too.
constexpr double kCaution = 0.96;

}  // namespace

double radius_across(std::span<const Vec2> offsets, double median, double noise,
                     std::vector<float>& scratch) {
    if (offsets.size() < kLeastPoints || noise <= 0.0) return median;
    const auto count = static_cast<double>(offsets.size());
    DVec2 mean(0.0);
    double xx = 0.0, xy = 0.0, yy = 0.0;
    for (const Vec2& offset : offsets) {
        const DVec2 p(offset);
        mean += p;
        xx += p.x * p.x;
        xy += p.x * p.y;
        yy += p.y * p.y;
    }
    mean /= count;
    const double unbiased = count / (count - 1.0);
    xx = (xx / count - mean.x * mean.x) * unbiased;
    xy = (xy / count - mean.x * mean.y) * unbiased;
    yy = (yy / count - mean.y * mean.y) * unbiased;
    const double half = 0.5 * (xx + yy);
    const double root = std::sqrt(0.25 * (xx - yy) * (xx - yy) + xy * xy);
    // Noise lies along the beams, so only the depth holds all of it.
    const double width = half + root - 0.5 * noise * noise;
    const double depth = std::max(half - root - noise * noise, 0.0);
    if (width <= 0.0) return median;
    const double roundness = std::sqrt(depth / width);
    const double belief = std::clamp((kAllAround - roundness) / (kAllAround - kOneSided), 0.0, 1.0);
    if (belief <= 0.0) return median;
    // The main direction; both forms of it, lest the points lie along one axis.
    DVec2 across = xx >= yy ? DVec2(half + root - yy, xy) : DVec2(xy, half + root - xx);
    const double length = glm::length(across);
    if (!(length > 0.0)) return median;
    across /= length;
    scratch.clear();
    for (const Vec2& offset : offsets)
        scratch.push_back(static_cast<float>(std::abs(glm::dot(DVec2(offset) - mean, across))));
    const auto edge = scratch.begin() + static_cast<ptrdiff_t>(kShare * count);
    std::nth_element(scratch.begin(), edge, scratch.end());
    const double radius = kCaution / kReach * *edge;
    if (radius < kLeastRadius * noise || radius <= median) return median;
    return median + belief * (radius - median);
}

}  // namespace treerec
