#include "textures/leaf_canvas.h"

#include <algorithm>
#include <cmath>

#include "geometry/portable_math.h"
#include "textures/texture_noise.h"

namespace treerec::texture {

namespace {

const DVec3 kDry(0.42, 0.30, 0.13);  // a withered margin

}  // namespace

DVec2 twig_at(double f, double sway, double top) {
    return {sway * portable::sin(2.2 * f) * f, top * f};
}

void draw_twig(std::vector<Sample>& canvas, int size, const Spray& spray, double sway, double top,
               double wide_base, double wide_end, int pieces) {
    for (int i = 0; i < pieces; i++) {
        const double f0 = static_cast<double>(i) / pieces, f1 = static_cast<double>(i + 1) / pieces;
        draw_stalk(canvas, size, twig_at(f0, sway, top), twig_at(f1, sway, top), mix(wide_base, wide_end, f0),
                   mix(wide_base, wide_end, f1), spray.twig);
    }
}

void draw_stalk(std::vector<Sample>& canvas, int size, DVec2 a, DVec2 b, double wide_a, double wide_b,
                const DVec3& colour) {
    const double widest = std::max(wide_a, wide_b);
    const auto column = [&](double x) { return static_cast<int>((x + 0.5) * size); };
    const auto row = [&](double y) { return static_cast<int>((1.0 - y) * size); };
    const int x0 = std::max(0, column(std::min(a.x, b.x) - widest)),
              x1 = std::min(size - 1, column(std::max(a.x, b.x) + widest));
    const int y0 = std::max(0, row(std::max(a.y, b.y) + widest)),
              y1 = std::min(size - 1, row(std::min(a.y, b.y) - widest));
    const DVec2 along = b - a;
    for (int y = y0; y <= y1; y++) {
        for (int x = x0; x <= x1; x++) {
            const DVec2 p((x + 0.5) / size - 0.5, 1.0 - (y + 0.5) / size);
            const double f = clamp01(glm::dot(p - a, along) / glm::dot(along, along));
            const double distance = glm::length(p - a - along * f);
            const double width = mix(wide_a, wide_b, f);
            if (distance > width) continue;
            Sample& sample = canvas[static_cast<size_t>(y) * size + x];
            const double light = 0.75 + 0.4 * std::sqrt(1.0 - (distance / width) * (distance / width));
            sample = {static_cast<float>(colour.r * light),
                      static_cast<float>(colour.g * light),
                      static_cast<float>(colour.b * light),
                      1.0f,
                      static_cast<float>(std::sqrt(width * width - distance * distance)),
                      static_cast<int16_t>(-2)};
        }
    }
}

void draw_leaf(std::vector<Sample>& canvas, int size, const Spray& spray, const Leaf& leaf, int16_t index,
               uint64_t seed) {
    const double reach = leaf.length * (spray.shape.palmate || spray.shape.fan ? 1.25 : 1.1);
    const DVec2 across(leaf.direction.y, -leaf.direction.x);
    const int x0 = std::max(0, static_cast<int>((leaf.base.x - reach + 0.5) * size));
    const int x1 = std::min(size - 1, static_cast<int>((leaf.base.x + reach + 0.5) * size));
    const int y0 = std::max(0, static_cast<int>((1.0 - leaf.base.y - reach) * size));
    const int y1 = std::min(size - 1, static_cast<int>((1.0 - leaf.base.y + reach) * size));
    for (int y = y0; y <= y1; y++) {
        for (int x = x0; x <= x1; x++) {
            const DVec2 p((x + 0.5) / size - 0.5, 1.0 - (y + 0.5) / size);
            const DVec2 local = (p - leaf.base) / leaf.length;
            const double s = glm::dot(local, leaf.direction);
            const double t = (glm::dot(local, across) - leaf.bend * s * s) / leaf.shown;
            BladePoint blade = blade_at(spray.shape, s, t);
            const DVec2 bite(0.62, leaf.bend > 0.0 ? 0.5 * spray.shape.width : -0.5 * spray.shape.width);
            blade.inside = std::min(blade.inside, glm::distance(DVec2(s, t), bite) - leaf.torn);
            Sample& sample = canvas[static_cast<size_t>(y) * size + x];
            if (blade.inside <= 0.0) {
                // A soft shadow on what lies below, so that overlapping leaves stay apart to the eye.
                if (sample.a > 0.0f && blade.inside > -0.06) {
                    const float shade = static_cast<float>(1.0 - 0.38 * smoothstep(-0.06, 0.0, blade.inside));
                    sample.r *= shade;
                    sample.g *= shade;
                    sample.b *= shade;
                }
                continue;
            }
            const DVec2 grid(p.x + 0.5, p.y);
            const double mottle = fractal(grid, 14, 14, 3, seed + static_cast<uint64_t>(index));
            const double light = 0.42 + 0.34 * smoothstep(0.0, 0.10, blade.inside) + 0.55 * mottle +
                                 (t > 0.0 ? 0.10 : -0.06) + 0.12 * s;
            DVec3 colour = glm::mix(spray.dark, spray.light, clamp01(light));
            colour *=
                leaf.brightness * DVec3(1.0 + 0.10 * leaf.hue, 1.0 + 0.03 * leaf.hue, 1.0 - 0.06 * leaf.hue);
            colour = glm::mix(colour, spray.vein, 0.55 * blade.vein);
            const double brown = leaf.dry * (1.0 - smoothstep(0.02, 0.16, blade.inside - 0.12 * mottle));
            colour = glm::mix(colour, kDry * (0.7 + 0.6 * mottle), brown);
            colour *= 0.80 + 0.20 * smoothstep(0.0, 0.016, blade.inside);
            sample = {static_cast<float>(colour.r),
                      static_cast<float>(colour.g),
                      static_cast<float>(colour.b),
                      1.0f,
                      static_cast<float>(blade.relief * leaf.length),
                      index};
        }
    }
}

}  // namespace treerec::texture
