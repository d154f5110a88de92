// Pictures of sketches, drawn with a round brush, of which every stroke is known.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "exchange/material_textures.h"
#include "geometry/random.h"
#include "geometry/vec.h"
#include "mesh/image.h"

namespace treerec::test {

using Polyline = std::vector<DVec2>;

inline double distance_to(const DVec2& p, const DVec2& a, const DVec2& b) {
    const DVec2 ab = b - a;
    const double square = glm::dot(ab, ab);
    const double t = square > 0.0 ? std::clamp(glm::dot(p - a, ab) / square, 0.0, 1.0) : 0.0;
    return glm::length(p - a - t * ab);
}

inline double distance_to(const DVec2& p, const Polyline& line) {
    double best = 1e30;
    for (size_t i = 0; i < line.size(); i++)
        best = std::min(best, distance_to(p, line[i > 0 ? i - 1 : 0], line[i]));
    return best;
}

// Of places every four pixels along the one from the other.
inline double mean_distance(const Polyline& from, const Polyline& to) {
    double sum = 0.0, count = 0.0;
    for (size_t i = 1; i < from.size(); i++) {
        const int steps = 1 + static_cast<int>(0.25 * glm::length(from[i] - from[i - 1]));
        for (int k = 0; k < steps; k++) {
            sum += distance_to(from[i - 1] + (from[i] - from[i - 1]) * (double(k) / steps), to);
            count += 1.0;
        }
    }
    return count > 0.0 ? sum / count : 1e30;
}

// The worse of both ways.
inline double apart(const Polyline& a, const Polyline& b) {
    return std::max(mean_distance(a, b), mean_distance(b, a));
}

struct Brush {
    double width = 5.0;  // pixels
    bool smooth = true;  // shades at the border
};

// How much of each pixel the lines cover, 0 to 1.
inline std::vector<double> cover(int width, int height, const std::vector<Polyline>& lines,
                                 const Brush& brush) {
    std::vector<double> covered(static_cast<size_t>(width) * static_cast<size_t>(height), 0.0);
    const double reach = 0.5 * brush.width;
    for (const Polyline& line : lines)
        for (size_t i = 1; i < line.size(); i++) {
            const DVec2 &a = line[i - 1], &b = line[i];
            const DVec2 low = glm::min(a, b) - DVec2(reach + 1.0);
            const DVec2 high = glm::max(a, b) + DVec2(reach + 1.0);
            for (int y = std::max(0, int(low.y)); y < std::min<double>(height, high.y); y++)
                for (int x = std::max(0, int(low.x)); x < std::min<double>(width, high.x); x++) {
                    const double inside = reach - distance_to({x + 0.5, y + 0.5}, a, b);
                    const double share = brush.smooth    ? std::clamp(inside + 0.5, 0.0, 1.0)
                                         : inside >= 0.0 ? 1.0
                                                         : 0.0;
                    double& here = covered[static_cast<size_t>(y) * static_cast<size_t>(width) + size_t(x)];
                    here = std::max(here, share);
                }
        }
    return covered;
}

// Lines of one colour on paper of another; 4 channels: red, green, blue, opacity.
inline Image paint(int width, int height, const std::vector<Polyline>& lines, const Brush& brush,
                   const std::array<int, 4>& ink = {20, 20, 30, 255},
                   const std::array<int, 4>& paper = {250, 248, 240, 255}) {
    const std::vector<double> covered = cover(width, height, lines, brush);
    Image picture(width, height, 4);
    for (size_t i = 0; i < covered.size(); i++)
        for (size_t k = 0; k < 4; k++)
            picture.pixels[4 * i + k] =
                static_cast<uint8_t>(std::lround(covered[i] * ink[k] + (1.0 - covered[i]) * paper[k]));
    return picture;
}

inline std::string png_of(const Image& picture) {
    const std::vector<uint8_t> bytes = encode_png(picture);
    return {bytes.begin(), bytes.end()};
}

// A tree as one draws it: outline, trunk, branches.
struct DrawnStrokes {
    Polyline outline, trunk;
    std::vector<Polyline> branches;

    std::vector<Polyline> all() const {
        std::vector<Polyline> lines = {outline, trunk};
        lines.insert(lines.end(), branches.begin(), branches.end());
        return lines;
    }
};

// In a canvas so high; branches keep `gap` pixels between one another at the trunk, and from the outline.
// crossed: the trunk goes down through the outline, else both keep apart.
inline DrawnStrokes random_drawing(Random& random, double size, double gap, bool crossed, int branches) {
    DrawnStrokes drawn;
    const DVec2 middle(0.5 * size, 0.4 * size);
    const DVec2 radii(size * random.uniform(0.3, 0.4), size * random.uniform(0.28, 0.35));
    const double wave = random.uniform(0.0, 0.06), phase = random.uniform(0.0, 6.0);
    for (int i = 0; i <= 180; i++) {
        const double angle = 2.0 * kPi * (i % 180) / 180.0;
        drawn.outline.push_back(middle + radii * (1.0 + wave * std::sin(5.0 * angle + phase)) *
                                             DVec2(std::sin(angle), -std::cos(angle)));
    }
    const double top = middle.y - 0.6 * radii.y, below = middle.y + 0.75 * radii.y;
    const double base = crossed ? 0.95 * size : below;
    const double bend = size * random.uniform(-0.02, 0.02);
    const auto trunk_at = [&](double y) { return DVec2(middle.x + bend * std::sin(6.0 * y / size), y); };
    for (int i = 0; i <= 60; i++)
        drawn.trunk.push_back(trunk_at(base + (top - base) * i / 60.0));
    for (int i = 0; i < branches; i++) {
        // From below to above, left and right in turn.
        const double room = (below - top) * 0.85 / branches;
        const double y = below - gap - room * (i + 0.3 * random.uniform());
        const double side = i % 2 == 0 ? -1.0 : 1.0, rise = random.uniform(0.5, 1.0);
        const DVec2 from = trunk_at(y);
        Polyline branch = {from};
        const DVec2 way = glm::normalize(DVec2(side, -rise));
        for (int k = 1; k <= 40; k++) {
            const double along = k * 0.02 * radii.x;
            const DVec2 p = from + way * along + DVec2(0.0, 0.00025 * along * along);
            if (distance_to(p, drawn.outline) < gap || p.y < middle.y - 0.8 * radii.y) break;
            branch.push_back(p);
        }
        drawn.branches.push_back(std::move(branch));
    }
    return drawn;
}

}  // namespace treerec::test
