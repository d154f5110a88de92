#include "scan/robust.h"

#include <bit>
#include <cstdint>
#include <limits>

#include "geometry/random.h"

namespace treerec {

namespace {

constexpr size_t kRepresentative = 8192;    // points that tell a quantile well enough
constexpr size_t kBlock = size_t{1} << 18;  // points between two looks at the progress
constexpr float kNearEnd = 0.38F;           // of the width: as near an end
constexpr double kFilledEnd = 0.02;         // of the points: twice what lies beyond a quantile

template <typename Body>
void in_blocks(std::span<const Vec3> points, const Progress* progress, const Body& body) {
    for (size_t block = 0; block < points.size(); block += kBlock) {
        if (progress) progress->check();
        for (const Vec3& p : points.subspan(block, std::min(kBlock, points.size() - block)))
            body(p);
    }
}

// Whether so many points lie near either end of the box that it is all within reach of the middle 98 %: the
// two quantiles are then less than 0.4 of the width from its ends, hence no end lies further beyond them than
// twice their distance.
bool both_ends_filled(std::span<const Vec3> points, const Vec3& low, const Vec3& high,
                      const Progress* progress) {
    const Vec3 near_low = glm::mix(low, high, kNearEnd), near_high = glm::mix(high, low, kNearEnd);
    std::array<size_t, 3> lower{}, upper{};
    in_blocks(points, progress, [&](const Vec3& p) {
        for (int k = 0; k < 3; k++) {
            lower[static_cast<size_t>(k)] += p[k] <= near_low[k];
            upper[static_cast<size_t>(k)] += p[k] >= near_high[k];
        }
    });
    const size_t enough = static_cast<size_t>(kFilledEnd * static_cast<double>(points.size())) + 1;
    return std::min({lower[0], lower[1], lower[2], upper[0], upper[1], upper[2]}) >= enough;
}

}  // namespace

std::vector<Vec3> some_of(std::span<const Vec3> points, size_t wanted, const Progress* progress) {
    if (points.size() <= 2 * wanted) return {points.begin(), points.end()};
    const uint64_t limit = ~uint64_t{0} / points.size() * wanted;
    std::vector<Vec3> some;
    some.reserve(wanted + wanted / 8);
    in_blocks(points, progress, [&](const Vec3& p) {
        const uint64_t xy =
            static_cast<uint64_t>(std::bit_cast<uint32_t>(p.x)) << 32 | std::bit_cast<uint32_t>(p.y);
        if (hash_seed(xy, std::bit_cast<uint32_t>(p.z)) < limit) some.push_back(p);
    });
    // Few places that many points share may all have been passed over.
    if (some.size() < wanted / 4) return {points.begin(), points.end()};
    return some;
}

std::array<Range, 3> robust_ranges(std::span<const Vec3> points, const Progress* progress) {
    std::array<Range, 3> ranges;
    if (points.empty()) return ranges;
    Vec3 low = points[0], high = low;
    in_blocks(points, progress, [&](const Vec3& p) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    });
    for (int k = 0; k < 3; k++)
        ranges[static_cast<size_t>(k)] = {low[k], high[k]};
    if (both_ends_filled(points, low, high, progress)) return ranges;
    const std::vector<Vec3> some = some_of(points, kRepresentative, progress);
    std::array<float, 3> least{};
    std::array<float, 3> most{};
    std::vector<float> values(some.size());
    for (int axis = 0; axis < 3; axis++) {
        for (size_t i = 0; i < some.size(); i++)
            values[i] = some[i][axis];
        const double q01 = quantile(values, 0.01);
        const double q99 = quantile(values, 0.99);
        const double reach = 2.0 * (q99 - q01);
        const size_t k = static_cast<size_t>(axis);
        least[k] = static_cast<float>(std::max<double>(q01 - reach, std::numeric_limits<float>::lowest()));
        most[k] = static_cast<float>(std::min<double>(q99 + reach, std::numeric_limits<float>::max()));
        ranges[k] = {q01, q99};
    }
    for (int k = 0; k < 3; k++) {
        low[k] = static_cast<float>(ranges[static_cast<size_t>(k)].low);
        high[k] = static_cast<float>(ranges[static_cast<size_t>(k)].high);
    }
    in_blocks(points, progress, [&](const Vec3& p) {
        for (int k = 0; k < 3; k++) {
            const float v = p[k];
            if (v < low[k] && v >= least[static_cast<size_t>(k)]) low[k] = v;
            if (v > high[k] && v <= most[static_cast<size_t>(k)]) high[k] = v;
        }
    });
    for (int k = 0; k < 3; k++)
        ranges[static_cast<size_t>(k)] = {low[k], high[k]};
    return ranges;
}

}  // namespace treerec
