#include "photos/refine_disparity.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace treerec {

namespace {

constexpr float kFlat = 4.0F;   // mean square of grey levels per pixel: less slope tells nothing
constexpr int kMostWindow = 4;  // pixels to each side

size_t pixel_of(const RectifiedPair& pair, int x, int y) {
    return static_cast<size_t>(y) * static_cast<size_t>(pair.width) + static_cast<size_t>(x);
}

// A grey level of the right picture between the pixels of a row.
float right_level(const RectifiedPair& pair, float x, int y) {
    const float inside = std::clamp(x, 0.0F, static_cast<float>(pair.width - 1) - 1e-3F);
    const int left = static_cast<int>(inside);
    const float part = inside - static_cast<float>(left);
    const uint8_t* row = &pair.right.grey[pixel_of(pair, left, y)];
    return (1.0F - part) * row[0] + part * row[1];
}

}  // namespace

float refine_disparity(const RectifiedPair& pair, int x, int y, float disparity,
                       const RefineOptions& options) {
    constexpr int kMost = (2 * kMostWindow + 1) * (2 * kMostWindow + 1);
    const int window = std::min(options.window, kMostWindow);
    if (x < window || y < window || x + window >= pair.width || y + window >= pair.height) return disparity;
    const auto count = static_cast<float>((2 * window + 1) * (2 * window + 1));
    float refined = disparity;
    for (int step = 0; step < options.steps; step++) {
        std::array<float, kMost> slope, miss;
        float mean_slope = 0.0F, mean_miss = 0.0F;
        size_t size = 0;
        for (int v = y - window; v <= y + window; v++)
            for (int u = x - window; u <= x + window; u++, size++) {
                const float other = static_cast<float>(u) - refined;
                slope[size] =
                    0.5F * (right_level(pair, other + 1.0F, v) - right_level(pair, other - 1.0F, v));
                miss[size] = pair.left.grey[pixel_of(pair, u, v)] - right_level(pair, other, v);
                mean_slope += slope[size] / count;
                mean_miss += miss[size] / count;
            }
        float both = 0.0F, square = 0.0F;
        for (size_t i = 0; i < size; i++) {
            both += (slope[i] - mean_slope) * (miss[i] - mean_miss);
            square += (slope[i] - mean_slope) * (slope[i] - mean_slope);
        }
        if (square < kFlat * count) return disparity;
        refined -= std::clamp(both / square, -0.5F, 0.5F);
    }
    return std::abs(refined - disparity) <= options.most ? refined : disparity;
}

}  // namespace treerec
