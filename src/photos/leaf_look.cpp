#include "photos/leaf_look.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/portable_math.h"
#include "textures/linear_light.h"

namespace treerec {

namespace {

constexpr int kOpaque = 102;  // alpha that leaf.gdshader cuts at
constexpr int kSteps = 40;    // of a bisection
constexpr double kMostGain = 16.0;

// The mean light of levels multiplied by a gain. counts: by level.
double mean_light(const std::array<double, 256>& counts, double gain) {
    double sum = 0.0, all = 0.0;
    for (size_t i = 0; i < counts.size(); i++) {
        if (!(counts[i] > 0.0)) continue;
        sum += counts[i] * linear_of(std::min(1.0, gain * static_cast<double>(i) / 255.0));
        all += counts[i];
    }
    return all > 0.0 ? sum / all : 0.0;
}

}  // namespace

DVec3 picture_gain(const Image& picture, const DVec3& mean) {
    const size_t pixels = static_cast<size_t>(picture.width) * static_cast<size_t>(picture.height);
    DVec3 gains(1.0);
    for (int c = 0; c < 3; c++) {
        std::array<double, 256> counts{};
        for (size_t i = 0; i < pixels; i++)
            if (picture.pixels[4 * i + 3] >= kOpaque)
                counts[picture.pixels[4 * i + static_cast<size_t>(c)]] += 1.0;
        double low = 0.0, high = kMostGain;
        for (int step = 0; step < kSteps; step++) {
            const double middle = 0.5 * (low + high);
            (mean_light(counts, middle) < mean[c] ? low : high) = middle;
        }
        gains[c] = high;
    }
    return gains;
}

void recolour(Image& picture, const DVec3& mean) {
    const size_t pixels = static_cast<size_t>(picture.width) * static_cast<size_t>(picture.height);
    const DVec3 gains = picture_gain(picture, mean);
    for (size_t i = 0; i < pixels; i++)
        for (int c = 0; c < 3; c++) {
            uint8_t& level = picture.pixels[4 * i + static_cast<size_t>(c)];
            level = static_cast<uint8_t>(std::min(255.0, std::floor(gains[c] * level + 0.5)));
        }
}

DVec3 course_at(const LeafColours& colours, double height) {
    const double range = colours.high_height - colours.low_height;
    const double share = range > 0.0 ? std::clamp((height - colours.low_height) / range, 0.0, 1.0) : 0.5;
    DVec3 factor;
    for (int c = 0; c < 3; c++)
        factor[c] = portable::exp((1.0 - share) * portable::log(colours.low[c]) +
                                  share * portable::log(colours.high[c]));
    return factor;
}

DVec3 course_peak(const LeafColours& colours) {
    return glm::max(colours.low, colours.high);
}

}  // namespace treerec
