#include "photos/bark_maps.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/parallel.h"
#include "geometry/portable_math.h"
#include "geometry/quantile.h"
#include "textures/linear_light.h"
#include "textures/texture_noise.h"

namespace treerec {

namespace {

using texture::clamp01;
using texture::mix;
using texture::smoothstep;
using texture::to_byte;
using texture::wrap;

// Of linear light: what the bark of trees throws back, from wet oak to birch.
constexpr double kDarkest = 0.085;
constexpr double kLightest = 0.55;
constexpr double kMostChange = 5.0;  // of light that is taken off
constexpr double kRelief = 0.008;    // metres from the deepest cracks to the crests
constexpr double kFine = 0.0012;     // metres: what is finer is grain of the photo
constexpr double kCoarse = 0.045;    // metres: slower changes are no relief
constexpr double kGrain = 0.6;       // of the photos' detail
constexpr double kCoarser = 1.5;     // than a pixel
constexpr double kNoiseRelief = 0.15, kNoiseTone = 0.32;
constexpr size_t kRows = 16;

uint8_t level_of(double light) {
    return to_byte(stored_of(light));
}

std::array<float, 256> linear_table() {
    std::array<float, 256> table{};
    for (int i = 0; i < 256; i++)
        table[static_cast<size_t>(i)] = static_cast<float>(linear_of(i / 255.0));
    return table;
}

// A running mean of 2 * radius + 1 pixels along a line.
void run_mean(const float* from, float* to, int count, size_t step, int radius, bool wraps) {
    const auto value = [&](int i) {
        const int k = wraps ? wrap(i, count) : i;
        return k < 0 || k >= count ? 0.0 : static_cast<double>(from[static_cast<size_t>(k) * step]);
    };
    double sum = 0.0;
    for (int i = -radius; i <= radius; i++)
        sum += value(i);
    for (int i = 0; i < count; i++) {
        to[static_cast<size_t>(i) * step] = static_cast<float>(sum / (2 * radius + 1));
        sum += value(i + radius + 1) - value(i - radius);
    }
}

// Three means of this radius have about the Gaussian's deviation: 3 * ((2r + 1)^2 - 1) / 12.
int radius_of(double deviation) {
    return std::max(
        0, static_cast<int>(std::lround(0.5 * (std::sqrt(4.0 * deviation * deviation + 1.0) - 1.0))));
}

// Noise from the photos' detail down to a pixel: bark does not end at their resolution.
void roughen(Image& albedo, PixelField& relief, const DVec2& metres, double detail) {
    const auto cells = [&](int pixels, double size) {
        return std::max(4, static_cast<int>(std::lround(pixels * size / detail)));
    };
    const int across = cells(albedo.width, metres.x), along = cells(albedo.height, metres.y);
    int octaves = 1;
    while ((across << octaves) < albedo.width && octaves < 4)
        octaves++;
    parallel_for(static_cast<size_t>(albedo.height), kRows, [&](size_t begin, size_t end) {
        for (int y = static_cast<int>(begin); y < static_cast<int>(end); y++)
            for (int x = 0; x < albedo.width; x++) {
                const DVec2 p((x + 0.5) / albedo.width, (y + 0.5) / albedo.height);
                const double tone = texture::fractal(p, across, along, octaves, 1);
                relief.at(x, y) =
                    static_cast<float>(clamp01(static_cast<double>(relief.at(x, y)) + kNoiseRelief * tone));
                for (int c = 0; c < 3; c++)
                    albedo.at(x, y)[c] = to_byte(albedo.at(x, y)[c] / 255.0 * (1.0 + kNoiseTone * tone));
            }
    });
}

}  // namespace

PixelField blurred(const PixelField& field, const DVec2& deviation, bool wraps) {
    PixelField here = field, there(field.width, field.height);
    const int across = std::min(radius_of(deviation.x), field.width / 2);
    const int along = std::min(radius_of(deviation.y), field.height / 2);
    for (int pass = 0; pass < 3; pass++) {
        parallel_for(static_cast<size_t>(field.height), kRows, [&](size_t begin, size_t end) {
            for (size_t y = begin; y < end; y++) {
                const size_t row = y * static_cast<size_t>(field.width);
                run_mean(here.values.data() + row, there.values.data() + row, field.width, 1, across, wraps);
            }
        });
        parallel_for(static_cast<size_t>(field.width), kRows, [&](size_t begin, size_t end) {
            for (size_t x = begin; x < end; x++)
                run_mean(there.values.data() + x, here.values.data() + x, field.height,
                         static_cast<size_t>(field.width), along, wraps);
        });
    }
    return here;
}

void take_light_off(Image& picture, const std::vector<uint8_t>& seen, const DVec2& deviation, double colour,
                    bool wraps) {
    const std::array<float, 256> linear = linear_table();
    PixelField there(picture.width, picture.height);
    std::array<PixelField, 4> lights{there, there, there, there};  // luminance, and the three channels
    std::array<double, 4> means{};
    size_t count = 0;
    std::vector<float> sorted;
    for (size_t i = 0; i < seen.size(); i++) {
        if (!seen[i]) continue;
        const uint8_t* level = picture.pixels.data() + 3 * i;
        const DVec3 light(linear[level[0]], linear[level[1]], linear[level[2]]);
        lights[0].values[i] = static_cast<float>(luminance_of(light));
        for (size_t c = 0; c < 3; c++)
            lights[c + 1].values[i] = linear[level[c]];
        there.values[i] = 1.0f;
        sorted.push_back(lights[0].values[i]);
    }
    if (sorted.empty()) return;
    // Without the extremes.
    const float low = quantile(sorted, 0.05), high = quantile(sorted, 0.95);
    for (size_t i = 0; i < seen.size(); i++) {
        if (!seen[i] || lights[0].values[i] < low || lights[0].values[i] > high) continue;
        for (size_t c = 0; c < 4; c++)
            means[c] += static_cast<double>(lights[c].values[i]);
        count++;
    }
    for (double& mean : means)
        mean /= static_cast<double>(count);
    const PixelField share = blurred(there, deviation, wraps);
    for (PixelField& light : lights)
        light = blurred(light, deviation, wraps);
    const double raised = std::clamp(means[0], kDarkest, kLightest) / std::max(means[0], 1e-6);
    parallel_for(static_cast<size_t>(picture.height), kRows, [&](size_t begin, size_t end) {
        for (size_t y = begin; y < end; y++)
            for (size_t x = 0; x < static_cast<size_t>(picture.width); x++) {
                const size_t i = y * static_cast<size_t>(picture.width) + x;
                uint8_t* level = picture.pixels.data() + 3 * i;
                if (!seen[i] || !(share.values[i] > 0.0f)) continue;
                const auto change = [&](size_t c) {
                    const double here = static_cast<double>(lights[c].values[i] / share.values[i]);
                    return std::clamp(means[c] / std::max(here, 1e-6), 1.0 / kMostChange, kMostChange);
                };
                const double plain = change(0);
                for (size_t c = 0; c < 3; c++)
                    level[c] = level_of(raised * mix(plain, change(c + 1), colour) *
                                        static_cast<double>(linear[level[c]]));
            }
    });
}

std::vector<float> faults_of(const Image& picture, const std::vector<uint8_t>& seen, const DVec2& deviation) {
    const size_t count = seen.size();
    PixelField there(picture.width, picture.height), detail(picture.width, picture.height);
    std::array<PixelField, 3> colours{there, there, there};
    for (size_t i = 0; i < count; i++) {
        if (!seen[i]) continue;
        there.values[i] = 1.0f;
        const uint8_t* level = picture.pixels.data() + 3 * i;
        const double sum = level[0] + level[1] + level[2] + 3.0;
        colours[0].values[i] = static_cast<float>(level[0] / sum);
        colours[1].values[i] = static_cast<float>(level[1] / sum);
        colours[2].values[i] = static_cast<float>(sum / 765.0);
        const size_t x = i % static_cast<size_t>(picture.width);
        if (x > 0 && seen[i - 1]) detail.values[i] = static_cast<float>(std::abs(level[1] - level[-2]));
    }
    const PixelField share = blurred(there, deviation, false);
    std::vector<float> faults(count, 1.0f);
    std::vector<double> unlike(count, 0.0);
    const auto look = [&](const PixelField& of, bool low_only) {
        const PixelField around = blurred(of, deviation, false);
        std::vector<float> values;
        for (size_t i = 0; i < count; i++)
            if (seen[i] && share.values[i] > 0.0f) values.push_back(around.values[i] / share.values[i]);
        if (values.empty()) return;
        std::vector<float> sorted = values;
        const float middle = quantile(sorted, 0.5);
        for (float& value : sorted)
            value = std::abs(value - middle);
        const double usual = std::max(1e-4, 1.4826 * static_cast<double>(quantile(sorted, 0.5)));
        for (size_t i = 0; i < count; i++) {
            if (!seen[i] || !(share.values[i] > 0.0f)) continue;
            double off = static_cast<double>(around.values[i] / share.values[i] - middle) / usual;
            if (low_only) off = std::min(off, 0.0);
            unlike[i] += off * off;
        }
    };
    for (const PixelField& colour : colours)
        look(colour, false);
    look(detail, true);
    for (size_t i = 0; i < count; i++)
        if (seen[i]) faults[i] = static_cast<float>(0.9 * (1.0 - 1.0 / (1.0 + unlike[i] / 8.0)));
    return faults;
}

BarkTextures maps_of(Image albedo, const DVec2& metres, double detail) {
    const int width = albedo.width, height = albedo.height;
    const std::array<float, 256> linear = linear_table();
    std::array<double, 256> lightness{};  // a perceptual one: cracks are a few dark levels
    for (int i = 0; i < 256; i++)
        lightness[static_cast<size_t>(i)] =
            portable::cbrt(static_cast<double>(linear[static_cast<size_t>(i)]));
    PixelField light(width, height);
    for (size_t i = 0; i < light.values.size(); i++) {
        const uint8_t* level = albedo.pixels.data() + 3 * i;
        light.values[i] =
            static_cast<float>(luminance_of({lightness[level[0]], lightness[level[1]], lightness[level[2]]}));
    }
    // Relief is what changes at the scale of cracks and plates; coarser relief counts more, as it is deeper.
    PixelField relief(width, height);
    const PixelField fine = blurred(light, std::max(kFine, kGrain * detail) / metres, true);
    double share = 0.5;
    for (double scale = kCoarse; scale > 0.006; scale *= 0.5, share *= 0.7) {
        const PixelField around = blurred(light, scale / metres, true);
        for (size_t i = 0; i < relief.values.size(); i++)
            relief.values[i] += static_cast<float>(share) * (fine.values[i] - around.values[i]);
    }
    std::vector<float> sorted = relief.values;
    const double low = static_cast<double>(quantile(sorted, 0.02));
    const double high = std::max(low + 1e-3, static_cast<double>(quantile(sorted, 0.98)));
    for (float& value : relief.values)
        value = static_cast<float>(clamp01(0.06 + 0.88 * (static_cast<double>(value) - low) / (high - low)));
    if (detail > kCoarser * metres.x) roughen(albedo, relief, metres, detail);
    BarkTextures textures{std::move(albedo), Image(width, height, 3), Image(width, height, 3)};
    parallel_for(static_cast<size_t>(height), kRows, [&](size_t begin, size_t end) {
        for (int y = static_cast<int>(begin); y < static_cast<int>(end); y++)
            for (int x = 0; x < width; x++) {
                const auto at = [&](int u, int v) {
                    return static_cast<double>(relief.at(wrap(u, width), wrap(v, height)));
                };
                const double here = at(x, y), grain = static_cast<double>(light.at(x, y) - fine.at(x, y));
                const double dx = 0.5 * (at(x + 1, y) - at(x - 1, y));
                const double dy = 0.5 * (at(x, y - 1) - at(x, y + 1));  // upwards in the picture
                const DVec3 normal =
                    glm::normalize(DVec3(-dx * kRelief / metres.x, -dy * kRelief / metres.y, 1.0));
                for (int c = 0; c < 3; c++)
                    textures.normal.at(x, y)[c] = to_byte(0.5 + 0.5 * normal[c]);
                textures.roughness.at(x, y)[0] = to_byte(mix(0.35, 1.0, smoothstep(0.05, 0.7, here)));
                textures.roughness.at(x, y)[1] =
                    to_byte(0.94 - 0.16 * smoothstep(0.62, 0.98, here) + 0.3 * grain);
            }
    });
    return textures;
}

}  // namespace treerec
