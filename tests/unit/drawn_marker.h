// Pictures of printed markers, of which every corner's place is known.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "geometry/random.h"
#include "geometry/vec.h"
#include "photos/grey_pyramid.h"
#include "photos/marker_code.h"
#include "photos_warps.h"

namespace treerec::test {

struct MarkerLook {
    int id = -1;                 // -1: any
    double side = 60.0;          // pixels, where it is nearest to the camera's axis
    double tilt = 0.0;           // degrees, about any axis
    double blur = 0.7;           // pixels: the deviation of a Gaussian
    double noise = 3.0;          // grey levels
    double falling_light = 0.0;  // how much less light there is a side away
    int size = 200;              // pixels: the picture's
    bool mirrored = false;
};

struct DrawnMarker {
    int id = 0;
    double side = 0.0;
    GreyPicture picture;
    std::array<DVec2, 4> corners{};  // the first pixel's middle is (0.5, 0.5)

    DVec2 centre() const { return 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]); }
};

// What a print with a white cell around is like at a place of its own plane: the black square is from (0, 0)
// to (1, 1). Nothing beside it.
inline std::optional<double> print_at(int id, double u, double v, bool mirrored) {
    constexpr double kCell = 1.0 / kMarkerCells;
    if (!(u >= -kCell && v >= -kCell && u < 1.0 + kCell && v < 1.0 + kCell)) return {};
    if (mirrored) u = 1.0 - u;
    if (u < 0.0 || v < 0.0 || u >= 1.0 || v >= 1.0) return 1.0;
    const int x = static_cast<int>(u * kMarkerCells), y = static_cast<int>(v * kMarkerCells);
    return is_white_cell(id, x, y) ? 1.0 : 0.0;
}

inline void blur_by(std::vector<double>& levels, int size, double blur) {
    if (!(blur > 0.0)) return;
    const int reach = static_cast<int>(std::ceil(3.0 * blur));
    std::vector<double> weights;
    double all = 0.0;
    for (int k = -reach; k <= reach; k++) {
        weights.push_back(std::exp(-0.5 * k * k / (blur * blur)));
        all += weights.back();
    }
    for (const auto& [right, down] : {std::pair{1, 0}, {0, 1}}) {
        const std::vector<double> from = levels;
        for (int y = 0; y < size; y++)
            for (int x = 0; x < size; x++) {
                double sum = 0.0;
                for (int k = -reach; k <= reach; k++) {
                    const int u = std::clamp(x + k * right, 0, size - 1);
                    const int v = std::clamp(y + k * down, 0, size - 1);
                    sum += weights[static_cast<size_t>(k + reach)] * from[static_cast<size_t>(v * size + u)];
                }
                levels[static_cast<size_t>(y * size + x)] = sum / all;
            }
    }
}

// A print before something like bark, turned any way, as a camera with a focal length of 1000 pixels sees it.
inline DrawnMarker draw_marker(const MarkerLook& look, Random& random) {
    constexpr double kFocal = 1000.0;
    constexpr int kSamples = 4;
    DrawnMarker drawn;
    drawn.id = look.id < 0 ? static_cast<int>(random.below(kMarkerCount)) : look.id;
    drawn.side = look.side;
    const double turn = random.uniform(0.0, 2.0 * kPi), about = random.uniform(0.0, 2.0 * kPi);
    const double tilt = look.tilt * kPi / 180.0, away = kFocal / look.side;
    const DVec2 middle = 0.5 * DVec2(look.size) + DVec2(random.uniform(-4, 4), random.uniform(-4, 4));
    // Rodrigues' formula, about an axis in the picture's plane.
    const DVec3 axis(std::cos(about), std::sin(about), 0.0);
    const auto tilted = [&](const DVec3& p) {
        return p * std::cos(tilt) + glm::cross(axis, p) * std::sin(tilt) +
               axis * (glm::dot(axis, p) * (1.0 - std::cos(tilt)));
    };
    const DVec3 right = tilted({std::cos(turn), std::sin(turn), 0.0});
    const DVec3 down = tilted({-std::sin(turn), std::cos(turn), 0.0});
    const DVec3 corner = DVec3(0.0, 0.0, away) - 0.5 * (right + down);
    const auto seen = [&](double u, double v) {
        const DVec3 p = corner + u * right + v * down;
        return middle + kFocal * DVec2(p) / p.z;
    };
    drawn.corners = {seen(0, 0), seen(1, 0), seen(1, 1), seen(0, 1)};
    const DMat3 to_plane = glm::inverse(DMat3(right, down, corner));
    std::vector<double> levels(static_cast<size_t>(look.size * look.size));
    const uint64_t seed = random.next();
    for (int y = 0; y < look.size; y++)
        for (int x = 0; x < look.size; x++) {
            const double behind = 20.0 + 0.5 * drawn_grey({x, y}, seed);
            double sum = 0.0;
            for (int k = 0; k < kSamples * kSamples; k++) {
                const DVec2 at(x + (k % kSamples + 0.5) / kSamples, y + (k / kSamples + 0.5) / kSamples);
                const DVec3 plane = to_plane * DVec3((at - middle) / kFocal, 1.0);
                const std::optional<double> print =
                    print_at(drawn.id, plane.x / plane.z, plane.y / plane.z, look.mirrored);
                sum += print ? 25.0 + 195.0 * *print : behind;
            }
            levels[static_cast<size_t>(y * look.size + x)] = sum / (kSamples * kSamples);
        }
    blur_by(levels, look.size, look.blur);
    drawn.picture = GreyPicture(look.size, look.size);
    for (int y = 0; y < look.size; y++)
        for (int x = 0; x < look.size; x++) {
            const double light = 1.0 + look.falling_light * glm::dot(DVec2(x, y) - middle, DVec2(axis)) /
                                           std::max(look.side, 40.0);
            const double level =
                levels[static_cast<size_t>(y * look.size + x)] * std::clamp(light, 0.2, 1.1) +
                look.noise * random.normal();
            drawn.picture.row(y)[x] = static_cast<uint8_t>(std::clamp(level, 0.0, 255.0) + 0.5);
        }
    return drawn;
}

}  // namespace treerec::test
