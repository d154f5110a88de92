#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "error.h"
#include "foliage/leaves.h"
#include "geometry/parallel.h"
#include "textures/bark_kinds.h"
#include "textures/textures.h"

namespace treerec {

namespace {

using texture::clamp01;
using texture::to_byte;
using texture::wrap;

// No bark is darker or lighter than this (sRGB): wet soot and birch, see Quixel's or Adobe's PBR guides.
constexpr double kDarkest = 54.0 / 255.0, kLightest = 238.0 / 255.0;
constexpr size_t kRows = 16;

struct Heights {
    int width, height;
    std::vector<float> metres;

    float at(int x, int y) const {
        return metres[static_cast<size_t>(wrap(y, height)) * static_cast<size_t>(width) +
                      static_cast<size_t>(wrap(x, width))];
    }
};

// How much of the sky over a point its surroundings leave, 0..1: horizons in eight directions (Bavoil and
// Sainz, "Image-Space Horizon-Based Ambient Occlusion", 2008).
double occlusion_at(const Heights& heights, int x, int y, double pixel) {
    constexpr std::array<std::array<int, 2>, 8> kWays{
        {{1, 0}, {0, 1}, {-1, 0}, {0, -1}, {1, 1}, {-1, 1}, {-1, -1}, {1, -1}}};
    constexpr std::array<double, 7> kReach{0.0008, 0.0016, 0.003, 0.005, 0.008, 0.012, 0.018};  // metres
    const float here = heights.at(x, y);
    double open = 0.0;
    for (const auto& way : kWays) {
        const double pace = pixel * (way[0] != 0 && way[1] != 0 ? 1.4142135623730951 : 1.0);
        double steepest = 0.0;
        for (const double reach : kReach) {
            const int steps = std::max(1, static_cast<int>(std::lround(reach / pace)));
            const float there = heights.at(x + steps * way[0], y + steps * way[1]);
            steepest = std::max(steepest, static_cast<double>(there - here) / (steps * pace));
        }
        // What a horizon leaves of the cosine-weighted sky on its side.
        open += 1.0 / (1.0 + steepest * steepest);
    }
    return open / kWays.size();
}

// What is soft needs half the pixels. Means of four; sizes are even.
Image half_of(const Image& image) {
    Image half(image.width / 2, image.height / 2, image.channels);
    for (int y = 0; y < half.height; y++)
        for (int x = 0; x < half.width; x++)
            for (int c = 0; c < image.channels; c++)
                half.at(x, y)[c] = static_cast<uint8_t>(
                    (image.at(2 * x, 2 * y)[c] + image.at(2 * x + 1, 2 * y)[c] +
                     image.at(2 * x, 2 * y + 1)[c] + image.at(2 * x + 1, 2 * y + 1)[c] + 2) /
                    4);
    return half;
}

}  // namespace

int bark_rows(int size) {
    return static_cast<int>(std::lround(size * kBarkLength / kBarkWidth / 4.0)) * 4;
}

BarkTextures make_bark_textures(const std::string& preset, int size, uint64_t seed, BarkAge age) {
    leaf_preset(preset);  // throws for an unknown name
    if (size < 16 || size > 8192) throw Error("A texture's size must be between 16 and 8192 pixels.");
    if (size % 2 != 0) throw Error("A bark's picture has an even number of pixels around.");
    const bool young = age == BarkAge::kYoung;
    const int rows = bark_rows(size);
    const DVec2 metres = DVec2(kBarkWidth, kBarkLength) * (young ? kYoungScale : 1.0);
    BarkTextures textures{Image(size, rows, 3), Image(size, rows, 3), Image(size, rows, 3)};
    Image& packed = textures.roughness;
    Heights heights{size, rows, std::vector<float>(static_cast<size_t>(size) * static_cast<size_t>(rows))};
    parallel_for(static_cast<size_t>(rows), kRows, [&](size_t begin, size_t end) {
        for (int y = static_cast<int>(begin); y < static_cast<int>(end); y++) {
            for (int x = 0; x < size; x++) {
                const bark::Place place{{(x + 0.5) / size, (y + 0.5) / rows}, metres, seed};
                const bark::BarkPoint point =
                    young ? bark::young_bark(preset, place) : bark::old_bark(preset, place);
                heights.metres[static_cast<size_t>(y) * static_cast<size_t>(size) + static_cast<size_t>(x)] =
                    static_cast<float>(point.height);
                for (int c = 0; c < 3; c++)
                    textures.albedo.at(x, y)[c] = to_byte(std::clamp(point.colour[c], kDarkest, kLightest));
                packed.at(x, y)[1] = to_byte(point.roughness);
                packed.at(x, y)[2] = to_byte(point.cover);
            }
        }
    });
    const double across = metres.x / size, along = metres.y / rows;
    parallel_for(static_cast<size_t>(rows), kRows, [&](size_t begin, size_t end) {
        for (int y = static_cast<int>(begin); y < static_cast<int>(end); y++) {
            for (int x = 0; x < size; x++) {
                const double dx = (heights.at(x + 1, y) - heights.at(x - 1, y)) / (2.0 * across);
                const double dy = (heights.at(x, y - 1) - heights.at(x, y + 1)) / (2.0 * along);  // upwards
                const DVec3 normal = glm::normalize(DVec3(-dx, -dy, 1.0));
                uint8_t* const pixel = textures.normal.at(x, y);
                pixel[0] = to_byte(0.5 + 0.5 * normal.x);
                pixel[1] = to_byte(0.5 + 0.5 * normal.y);
                pixel[2] = to_byte(0.5 + 0.5 * normal.z);
                packed.at(x, y)[0] = to_byte(occlusion_at(heights, x, y, across));
            }
        }
    });
    packed = half_of(packed);
    return textures;
}

}  // namespace treerec
