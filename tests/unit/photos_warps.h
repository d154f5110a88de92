// Drawn pictures, and the same ones turned, sheared, scaled or seen from the side, of which every pixel's
// place is known.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "geometry/random.h"
#include "geometry/vec.h"
#include "mesh/image.h"
#include "photos/match_pair.h"

namespace treerec::test {

struct Warp {
    std::string name;
    DMat3 matrix{1.0};  // homogeneous places of the first picture to the second one

    DVec2 operator()(const DVec2& p) const {
        const DVec3 q = matrix * DVec3(p, 1.0);
        return DVec2(q) / q.z;
    }
};

inline constexpr int kDrawnWidth = 480, kDrawnHeight = 360;

// Smooth noise, 0 to 1.
inline double noise_in_plane(const DVec2& p, uint64_t seed) {
    const DVec2 low = glm::floor(p), part = p - low, s = part * part * (3.0 - 2.0 * part);
    const auto value = [&](int x, int y) {
        const auto column = static_cast<uint32_t>(static_cast<int>(low.x) + x);
        const auto row = static_cast<uint32_t>(static_cast<int>(low.y) + y);
        return static_cast<double>(hash_seed(seed, static_cast<uint64_t>(column) << 32 | row) >> 11) *
               0x1p-53;
    };
    const double above = (1 - s.x) * value(0, 0) + s.x * value(1, 0);
    const double below = (1 - s.x) * value(0, 1) + s.x * value(1, 1);
    return (1 - s.y) * above + s.y * below;
}

// Bark as it looks from near by: patches, flakes and grains, without an end to any side.
inline double drawn_grey(const DVec2& p, uint64_t seed) {
    const double sum = 0.35 * noise_in_plane(p / 47.0, seed) +
                       0.3 * noise_in_plane(p / DVec2(13.0, 19.0), seed + 1) +
                       0.25 * noise_in_plane(p / 7.0, seed + 2) + 0.1 * noise_in_plane(p / 3.5, seed + 3);
    return 255.0 * std::clamp(2.0 * sum - 0.5, 0.0, 1.0);
}

// The picture that `warp` makes of the drawn one; `gain` and `bias` change its light.
inline Image draw_warped(const Warp& warp, uint64_t seed, double gain = 1.0, double bias = 0.0) {
    Image image(kDrawnWidth, kDrawnHeight, 1);
    const Warp back{"", glm::inverse(warp.matrix)};
    for (int y = 0; y < image.height; y++)
        for (int x = 0; x < image.width; x++) {
            double sum = 0.0;
            for (int k = 0; k < 4; k++)
                sum += drawn_grey(back({x - 0.25 + 0.5 * (k & 1), y - 0.25 + 0.5 * (k >> 1)}), seed);
            *image.at(x, y) = static_cast<uint8_t>(std::clamp(gain * 0.25 * sum + bias, 0.0, 255.0) + 0.5);
        }
    return image;
}

// About the picture's middle.
inline Warp about_middle(const std::string& name, const DMat3& inner, const DVec2& shift = {3.3, -2.6}) {
    DMat3 there(1.0), back(1.0);
    const DVec2 middle(0.5 * kDrawnWidth, 0.5 * kDrawnHeight);
    there[2] = DVec3(middle + shift, 1.0);
    back[2] = DVec3(-middle, 1.0);
    return {name, there * inner * back};
}

inline DMat3 turned(double degrees, double scale = 1.0) {
    const double angle = degrees * kPi / 180.0, c = scale * std::cos(angle), s = scale * std::sin(angle);
    return DMat3(c, s, 0, -s, c, 0, 0, 0, 1);
}

inline std::vector<Warp> known_warps() {
    std::vector<Warp> warps;
    for (const int degrees : {5, 10, 15, 20, 25, 30, 35, 40})
        warps.push_back(about_middle("turned by " + std::to_string(degrees), turned(degrees)));
    warps.push_back(about_middle("sheared by 0.2", DMat3(1, 0, 0, 0.2, 1, 0, 0, 0, 1)));
    warps.push_back(about_middle("sheared by 0.4", DMat3(1, 0, 0, 0.4, 1, 0, 0, 0, 1)));
    warps.push_back(about_middle("larger by 1.3", turned(0, 1.3)));
    warps.push_back(about_middle("smaller by 1.3", turned(0, 1 / 1.3)));
    warps.push_back(about_middle("from the side", DMat3(0.8, 0.03, 6e-4, 0, 0.95, 1e-4, 0, 0, 1)));
    warps.push_back(about_middle("moved by 60", DMat3(1.0), {60.4, -11.7}));
    return warps;
}

// How far off matches are.
struct WarpError {
    size_t corners = 0;   // whose place is in both pictures, with room for a window
    size_t matches = 0;   // that were kept
    double median = 0.0;  // pixels
    double wrong = 0.0;   // share of the matches that are off by more than 2 pixels
};

inline WarpError error_of(const Warp& warp, const PhotoFeatures& one, const PairMatches& found) {
    WarpError error;
    for (const Corner& corner : one.corners) {
        const DVec2 p = warp(corner.place);
        error.corners += p.x > 16 && p.y > 16 && p.x < kDrawnWidth - 17 && p.y < kDrawnHeight - 17;
    }
    std::vector<double> misses;
    for (const PointMatch& match : found.matches)
        if (match.kept) misses.push_back(glm::distance(match.place, warp(one.corners[match.corner].place)));
    error.matches = misses.size();
    if (misses.empty()) return error;
    std::sort(misses.begin(), misses.end());
    error.median = misses[misses.size() / 2];
    error.wrong = static_cast<double>(misses.end() - std::upper_bound(misses.begin(), misses.end(), 2.0)) /
                  static_cast<double>(misses.size());
    return error;
}

}  // namespace treerec::test
