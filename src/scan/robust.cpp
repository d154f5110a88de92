#include "scan/robust.h"

#include <bit>
#include <cstdint>
#include <limits>

#include "geometry/random.h"

namespace treerec {

namespace {

constexpr size_t kRepresentative = 8192;    // points that tell a quantile well enough
constexpr size_t kBlock = size_t{1} << 18;  // points between two looks at the progress

template <typename Body>
void in_blocks(std::span<const Vec3> points, const Progress* progress, const Body& body) {
    for (size_t block = 0; block < points.size(); block += kBlock) {
        if (progress) progress->check();
        for (const Vec3& p : points.subspan(block, std::min(kBlock, points.size() - block)))
            body(p);
    }
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
    std::array<float, 3> low{};
    std::array<float, 3> high{};
    for (size_t k = 0; k < 3; k++) {
        low[k] = static_cast<float>(ranges[k].low);
        high[k] = static_cast<float>(ranges[k].high);
    }
    in_blocks(points, progress, [&](const Vec3& p) {
        for (size_t k = 0; k < 3; k++) {
            const float v = p[static_cast<int>(k)];
            if (v < low[k] && v >= least[k]) low[k] = v;
            if (v > high[k] && v <= most[k]) high[k] = v;
        }
    });
    for (size_t k = 0; k < 3; k++)
        ranges[k] = {low[k], high[k]};
    return ranges;
}

}  // namespace treerec
