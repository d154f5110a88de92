#include "skeleton/circle_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace treerec {

namespace {

constexpr int kSamples = 40;
constexpr size_t kScored = 64;      // points looked at per sample
constexpr double kHopeless = 0.35;  // median residual over radius: not worth refining
constexpr int kRefinements = 12;
constexpr int kRingSteps = 6;
constexpr int kSectors = 16;
constexpr double kTukey = 4.685;  // 95 % efficiency for normal noise
constexpr double kMadToSigma = 1.4826;

std::optional<CircleFit> circle_through(const DVec2& a, const DVec2& b, const DVec2& c) {
    const DVec2 u = b - a;
    const DVec2 v = c - a;
    const double cross = u.x * v.y - u.y * v.x;
    const double uu = glm::dot(u, u);
    const double vv = glm::dot(v, v);
    if (!(std::abs(cross) > 1e-9 * (uu + vv))) return std::nullopt;
    const DVec2 offset = DVec2(v.y * uu - u.y * vv, u.x * vv - v.x * uu) / (2.0 * cross);
    CircleFit fit;
    fit.centre = a + offset;
    fit.radius = glm::length(offset);
    return fit;
}

double median(std::vector<double>& values) {
    const auto middle = values.begin() + static_cast<ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

int sector_of(const DVec2& offset) {
    const int sector = static_cast<int>((std::atan2(offset.y, offset.x) / (2.0 * kPi) + 0.5) * kSectors);
    return std::clamp(sector, 0, kSectors - 1);
}

// Solves the symmetric 3x3 system by Cramer's rule.
std::optional<DVec3> solve(const DMat3& m, const DVec3& rhs) {
    const double det = glm::determinant(m);
    const double scale = m[0][0] * m[1][1] * m[2][2];
    if (!(std::abs(det) > 1e-9 * std::abs(scale))) return std::nullopt;
    return glm::inverse(m) * rhs;
}

}  // namespace

std::optional<CircleFit> fit_circle(std::span<const DVec2> points, double max_radius, Random random) {
    const size_t count = points.size();
    if (count < 5) return std::nullopt;
    std::vector<double> residuals;
    residuals.reserve(count);
    std::optional<CircleFit> best;
    const size_t stride = (count + kScored - 1) / kScored;
    for (int sample = 0; sample < kSamples; sample++) {
        const uint32_t n = static_cast<uint32_t>(count);
        const uint32_t i = random.below(n);
        const uint32_t j = random.below(n);
        const uint32_t k = random.below(n);
        if (i == j || j == k || i == k) continue;
        std::optional<CircleFit> trial = circle_through(points[i], points[j], points[k]);
        if (!trial || trial->radius > max_radius) continue;
        residuals.clear();
        for (size_t p = 0; p < count; p += stride)
            residuals.push_back(std::abs(glm::distance(points[p], trial->centre) - trial->radius));
        trial->spread = median(residuals);
        if (!best || trial->spread < best->spread) best = trial;
    }
    if (!best || best->spread > kHopeless * best->radius) return std::nullopt;

    CircleFit fit = *best;
    for (int round = 0; round < kRefinements; round++) {
        residuals.clear();
        for (const DVec2& p : points)
            residuals.push_back(std::abs(glm::distance(p, fit.centre) - fit.radius));
        const double sigma = kMadToSigma * median(residuals) + 1e-6 * fit.radius + 1e-9;
        DMat3 normal(0.0);
        DVec3 rhs(0.0);
        for (const DVec2& p : points) {
            const DVec2 offset = p - fit.centre;
            const double distance = glm::length(offset);
            const double residual = distance - fit.radius;
            const double t = residual / (kTukey * sigma);
            if (std::abs(t) >= 1.0 || distance < 1e-9) continue;
            const double weight = (1.0 - t * t) * (1.0 - t * t);
            const DVec3 row(-offset.x / distance, -offset.y / distance, -1.0);
            normal += weight * glm::outerProduct(row, row);
            rhs -= weight * residual * row;
        }
        const std::optional<DVec3> step = solve(normal, rhs);
        if (!step) break;
        const DVec2 centre = fit.centre + DVec2(step->x, step->y);
        const double radius = fit.radius + step->z;
        if (!(radius > 0.0) || radius > max_radius) break;
        fit.centre = centre;
        fit.radius = radius;
        if (glm::length(*step) < 1e-6 * radius) break;
    }

    residuals.clear();
    std::array<bool, kSectors> hit{};
    double inside = 0.0;
    for (const DVec2& p : points) {
        const DVec2 offset = p - fit.centre;
        const double distance = glm::length(offset);
        residuals.push_back(std::abs(distance - fit.radius));
        if (distance < 0.7 * fit.radius) inside += 1.0;
        if (std::abs(distance - fit.radius) > 0.3 * fit.radius) continue;
        hit[sector_of(offset)] = true;
    }
    fit.spread = median(residuals);
    fit.inside = inside / static_cast<double>(count);
    fit.coverage = static_cast<double>(std::count(hit.begin(), hit.end(), true)) / kSectors;
    return fit;
}

std::optional<CircleFit> fit_ring(std::span<const DVec2> points) {
    if (points.size() < kSectors) return std::nullopt;
    CircleFit fit;
    for (const DVec2& p : points)
        fit.centre += p;
    fit.centre /= static_cast<double>(points.size());
    std::array<DVec2, kSectors> sum;
    std::array<double, kSectors> weight;
    int filled = 0;
    for (int step = 0; step < kRingSteps; step++) {
        sum.fill(DVec2(0.0));
        weight.fill(0.0);
        for (const DVec2& p : points) {
            const int sector = sector_of(p - fit.centre);
            sum[sector] += p;
            weight[sector] += 1.0;
        }
        DVec2 centre(0.0);
        filled = 0;
        for (int s = 0; s < kSectors; s++) {
            if (weight[s] == 0.0) continue;
            centre += sum[s] / weight[s];
            filled++;
        }
        fit.centre = centre / static_cast<double>(filled);
    }
    std::vector<double> distances;
    distances.reserve(points.size());
    for (const DVec2& p : points)
        distances.push_back(glm::distance(p, fit.centre));
    fit.radius = median(distances);
    double inside = 0.0;
    for (double& d : distances) {
        if (d < 0.4 * fit.radius) inside += 1.0;
        d = std::abs(d - fit.radius);
    }
    fit.spread = median(distances);
    fit.inside = inside / static_cast<double>(points.size());
    fit.coverage = static_cast<double>(filled) / kSectors;
    return fit;
}

}  // namespace treerec
