#include "photos/semi_global.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "photos/refine_disparity.h"

namespace treerec {

namespace {

constexpr int kCensusX = 4;  // pixels to each side
constexpr int kCensusY = 3;
// Costs are the bits of the census that differ, of 62.
constexpr uint8_t kUnknown = 31;  // where a picture has nothing: neither good nor bad
constexpr int kSmallStep = 10;    // for a disparity that changes by one from pixel to pixel
constexpr int kLargeStep = 96;    // for one that changes by more,
constexpr int kLeastStep = 24;    // less where the picture changes, too
constexpr int kEdge = 8;          // grey levels: of a change that makes it cheaper
constexpr int kTexture =
    6;  // grey levels within 3 x 3 pixels: more, and what stands before the sky would grow
constexpr float kUnique = 0.97F;  // of the second best cost apart from its neighbours
constexpr int kSpot = 60;         // pixels: smaller spots are errors
constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();

struct Size {
    int width, height, depth;
    size_t pixel(int x, int y) const {
        return static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x);
    }
    size_t pixels() const { return pixel(0, height); }
};

// R. Zabih and J. Woodfill, "Non-parametric local transforms for computing visual correspondence", 1994.
std::vector<uint64_t> census_of(const std::vector<uint8_t>& grey, const Size& size) {
    std::vector<uint64_t> census(size.pixels(), 0);
    for (int y = kCensusY; y < size.height - kCensusY; y++)
        for (int x = kCensusX; x < size.width - kCensusX; x++) {
            const uint8_t middle = grey[size.pixel(x, y)];
            uint64_t bits = 0;
            for (int v = -kCensusY; v <= kCensusY; v++) {
                const uint8_t* row = &grey[size.pixel(x, y + v)];
                for (int u = -kCensusX; u <= kCensusX; u++)
                    if (u != 0 || v != 0) bits = bits << 1 | (row[u] < middle ? 1U : 0U);
            }
            census[size.pixel(x, y)] = bits;
        }
    return census;
}

std::vector<uint8_t> costs_of(const RectifiedPair& pair, const Size& size, int least) {
    const auto left = census_of(pair.left.grey, size), right = census_of(pair.right.grey, size);
    std::vector<uint8_t> costs(size.pixels() * static_cast<size_t>(size.depth), kUnknown);
    for (int y = 0; y < size.height; y++)
        for (int x = 0; x < size.width; x++) {
            const size_t at = size.pixel(x, y);
            if (!pair.left.inside[at]) continue;
            uint8_t* cost = &costs[at * static_cast<size_t>(size.depth)];
            for (int d = 0; d < size.depth; d++) {
                const int other = x - least - d;
                if (other < 0 || other >= size.width) continue;
                const size_t there = size.pixel(other, y);
                if (pair.right.inside[there])
                    cost[d] = static_cast<uint8_t>(std::popcount(left[at] ^ right[there]));
            }
        }
    return costs;
}

// One step of a path: what it costs to be at each disparity here, on the way from the pixel before. Returns
// the least of it.
int16_t follow(const uint8_t* cost, const int16_t* before, int16_t least_before, int16_t* here, int depth,
               int16_t large_step) {
    const auto jump = static_cast<int16_t>(least_before + large_step);
    // 16-bit numbers throughout, of which processors compare eight at a time.
    const auto set = [&](int d, int16_t beside) {
        const auto step = static_cast<int16_t>(beside + kSmallStep);
        const int16_t best = std::min(std::min(before[d], step), jump);
        here[d] = static_cast<int16_t>(cost[d] + best - least_before);
    };
    for (int d = 1; d + 1 < depth; d++)
        set(d, std::min(before[d - 1], before[d + 1]));
    set(0, before[1]);
    set(depth - 1, before[depth - 2]);
    int16_t least = here[0];
    for (int d = 1; d < depth; d++)
        least = std::min(least, here[d]);
    return least;
}

// Adds the costs along all paths that go by (dx, dy) from pixel to pixel; dy is 0 or more, and dx 1 where it
// is 0, or the other way around where `backwards`.
void add_paths(const std::vector<uint8_t>& costs, const std::vector<uint8_t>& grey, const Size& size, int dx,
               int dy, bool backwards, std::vector<int16_t>& sums) {
    const size_t depth = static_cast<size_t>(size.depth), width = static_cast<size_t>(size.width);
    std::vector<int16_t> rows[2] = {std::vector<int16_t>(width * depth), std::vector<int16_t>(width * depth)};
    std::vector<int16_t> leasts[2] = {std::vector<int16_t>(width), std::vector<int16_t>(width)};
    int now = 0;
    for (int j = 0; j < size.height; j++) {
        const int y = backwards ? size.height - 1 - j : j;
        for (int i = 0; i < size.width; i++) {
            const int x = backwards ? size.width - 1 - i : i;
            const int from_x = backwards ? x + dx : x - dx, from_y = backwards ? y + dy : y - dy;
            const size_t at = size.pixel(x, y);
            const uint8_t* cost = &costs[at * depth];
            int16_t* here = &rows[now][static_cast<size_t>(x) * depth];
            if (from_x < 0 || from_x >= size.width || from_y < 0 || from_y >= size.height) {
                for (size_t d = 0; d < depth; d++)
                    here[d] = cost[d];
                leasts[now][static_cast<size_t>(x)] = *std::min_element(here, here + depth);
            } else {
                const int from = dy == 0 ? now : 1 - now;
                const int change = std::abs(grey[at] - grey[size.pixel(from_x, from_y)]);
                const auto large = static_cast<int16_t>(
                    std::clamp(kLargeStep * kEdge / std::max(change, kEdge), kLeastStep, kLargeStep));
                leasts[now][static_cast<size_t>(x)] =
                    follow(cost, &rows[from][static_cast<size_t>(from_x) * depth],
                           leasts[from][static_cast<size_t>(from_x)], here, size.depth, large);
            }
            int16_t* sum = &sums[at * depth];
            for (size_t d = 0; d < depth; d++)
                sum[d] = static_cast<int16_t>(sum[d] + here[d]);
        }
        now = 1 - now;
    }
}

bool has_texture(const std::vector<uint8_t>& grey, const Size& size, int x, int y) {
    uint8_t low = 255, high = 0;
    for (int v = std::max(y - 1, 0); v <= std::min(y + 1, size.height - 1); v++)
        for (int u = std::max(x - 1, 0); u <= std::min(x + 1, size.width - 1); u++) {
            low = std::min(low, grey[size.pixel(u, v)]);
            high = std::max(high, grey[size.pixel(u, v)]);
        }
    return high - low >= kTexture;
}

// The best disparity of the pixel (x, y) of the right picture, or -1.
int best_from_right(const std::vector<int16_t>& sums, const Size& size, int least, int x, int y) {
    int best = -1;
    int16_t lowest = std::numeric_limits<int16_t>::max();
    for (int d = 0; d < size.depth; d++) {
        const int other = x + least + d;
        if (other < 0 || other >= size.width) continue;
        const int16_t sum =
            sums[size.pixel(other, y) * static_cast<size_t>(size.depth) + static_cast<size_t>(d)];
        if (sum < lowest) {
            lowest = sum;
            best = d;
        }
    }
    return best;
}

float disparity_at(const std::vector<int16_t>& sums, const std::vector<int>& from_right, const Size& size,
                   int least, int x, int y) {
    const int16_t* sum = &sums[size.pixel(x, y) * static_cast<size_t>(size.depth)];
    const int best = static_cast<int>(std::min_element(sum, sum + size.depth) - sum);
    if (best == 0 || best == size.depth - 1) return kNothing;
    const int other = x - least - best;
    if (other < 0 || other >= size.width) return kNothing;
    if (std::abs(from_right[size.pixel(other, y)] - best) > 1) return kNothing;
    int16_t second = std::numeric_limits<int16_t>::max();
    for (int d = 0; d < size.depth; d++)
        if (std::abs(d - best) > 1) second = std::min(second, sum[d]);
    if (static_cast<float>(sum[best]) > kUnique * static_cast<float>(second)) return kNothing;
    // The vertex of the parabola through the three.
    const float before = sum[best - 1], here = sum[best], after = sum[best + 1];
    const float bend = before - 2.0F * here + after;
    const float part = bend > 0.0F ? 0.5F * (before - after) / bend : 0.0F;
    return static_cast<float>(least + best) + std::clamp(part, -0.5F, 0.5F);
}

void drop_spots(std::vector<float>& disparities, const Size& size) {
    std::vector<uint8_t> seen(disparities.size(), 0);
    std::vector<size_t> spot;
    for (size_t first = 0; first < disparities.size(); first++) {
        if (seen[first] || std::isnan(disparities[first])) continue;
        spot.assign(1, first);
        seen[first] = 1;
        for (size_t i = 0; i < spot.size(); i++) {
            const int x = static_cast<int>(spot[i] % static_cast<size_t>(size.width));
            const int y = static_cast<int>(spot[i] / static_cast<size_t>(size.width));
            const auto reach = [&](int u, int v) {
                if (u < 0 || v < 0 || u >= size.width || v >= size.height) return;
                const size_t next = size.pixel(u, v);
                if (seen[next] || !(std::abs(disparities[next] - disparities[spot[i]]) <= 1.0F)) return;
                seen[next] = 1;
                spot.push_back(next);
            };
            reach(x - 1, y);
            reach(x + 1, y);
            reach(x, y - 1);
            reach(x, y + 1);
        }
        if (spot.size() < kSpot)
            for (const size_t pixel : spot)
                disparities[pixel] = kNothing;
    }
}

}  // namespace

std::vector<float> match_rectified(const RectifiedPair& pair, int least, int most) {
    const Size size{pair.width, pair.height, most - least + 1};
    const std::vector<uint8_t> costs = costs_of(pair, size, least);
    std::vector<int16_t> sums(costs.size(), 0);
    for (const bool backwards : {false, true})
        for (const auto& [dx, dy] : {std::pair{1, 0}, {0, 1}, {1, 1}, {-1, 1}})
            add_paths(costs, pair.left.grey, size, dx, dy, backwards, sums);
    std::vector<int> from_right(size.pixels());
    for (int y = 0; y < size.height; y++)
        for (int x = 0; x < size.width; x++)
            from_right[size.pixel(x, y)] = best_from_right(sums, size, least, x, y);
    std::vector<float> disparities(size.pixels(), kNothing);
    for (int y = kCensusY; y < size.height - kCensusY; y++)
        for (int x = kCensusX; x < size.width - kCensusX; x++)
            if (pair.left.inside[size.pixel(x, y)] && has_texture(pair.left.grey, size, x, y))
                disparities[size.pixel(x, y)] = disparity_at(sums, from_right, size, least, x, y);
    drop_spots(disparities, size);
    for (int y = 0; y < size.height; y++)
        for (int x = 0; x < size.width; x++) {
            float& disparity = disparities[size.pixel(x, y)];
            if (!std::isnan(disparity)) disparity = refine_disparity(pair, x, y, disparity);
        }
    return disparities;
}

}  // namespace treerec
