#include <algorithm>
#include <vector>

#include "error.h"
#include "foliage/leaves.h"
#include "geometry/parallel.h"
#include "geometry/random.h"
#include "mesh/leaf_cards.h"
#include "textures/leaf_canvas.h"
#include "textures/leaf_shapes.h"
#include "textures/texture_noise.h"
#include "textures/textures.h"

namespace treerec {

namespace {

using namespace texture;

// One blade that fills the picture above its stalk, whatever its own width.
void draw_blade(std::vector<Sample>& canvas, int size, const Spray& spray, uint64_t seed) {
    constexpr double kMargin = 0.03;
    const BladeBox box = box_of(spray.shape);
    const DVec3 stalk = glm::mix(spray.twig, spray.vein, 0.6);
    draw_stalk(canvas, size, {0.0, 0.0}, {0.0, kBladeStalk + 0.05}, 0.5 * kBladeStalkWidth * 1.2,
               0.5 * kBladeStalkWidth * 1.2, stalk);
    for (int y = 0; y < size; y++)
        for (int x = 0; x < size; x++) {
            const DVec2 p((x + 0.5) / size - 0.5, 1.0 - (y + 0.5) / size);
            const double up = (p.y - kBladeStalk) / (1.0 - kMargin - kBladeStalk);
            const double s = mix(box.s_low, box.s_high, up);
            const double t = mix(box.t_low, box.t_high, p.x / (1.0 - 2.0 * kMargin) + 0.5);
            const BladePoint blade = blade_at(spray.shape, s, t);
            if (blade.inside <= 0.0) continue;
            Sample& sample = canvas[static_cast<size_t>(y) * size + x];
            const double mottle = fractal({p.x + 0.5, p.y}, 14, 14, 3, seed);
            const double light = 0.5 + 0.3 * smoothstep(0.0, 0.10, blade.inside) + 0.5 * mottle +
                                 (t > 0.0 ? 0.08 : -0.05) + 0.1 * s;
            DVec3 colour =
                glm::mix(glm::mix(spray.dark, spray.light, clamp01(light)), spray.vein, 0.55 * blade.vein);
            colour *= 0.80 + 0.20 * smoothstep(0.0, 0.016, blade.inside);
            sample = {static_cast<float>(colour.r),
                      static_cast<float>(colour.g),
                      static_cast<float>(colour.b),
                      1.0f,
                      static_cast<float>(blade.relief + 0.006 * mottle),
                      1};
        }
}

// Averages 2 x 2 samples, weighting colour by alpha.
std::vector<Sample> halve(const std::vector<Sample>& fine, int size) {
    const int half = size / 2;
    std::vector<Sample> coarse(static_cast<size_t>(half) * half);
    for (int y = 0; y < half; y++) {
        for (int x = 0; x < half; x++) {
            Sample& sum = coarse[static_cast<size_t>(y) * half + x];
            for (int k = 0; k < 4; k++) {
                const Sample& part = fine[static_cast<size_t>(2 * y + k / 2) * size + 2 * x + k % 2];
                sum.r += part.r * part.a;
                sum.g += part.g * part.a;
                sum.b += part.b * part.a;
                sum.relief += part.relief * part.a;
                sum.a += part.a;
            }
            if (sum.a > 0.0f) {
                sum.r /= sum.a;
                sum.g /= sum.a;
                sum.b /= sum.a;
                sum.relief /= sum.a;
            }
            sum.a *= 0.25f;
        }
    }
    return coarse;
}

// Gives transparent samples the colour of what is near them, coarser and coarser, so that filtering and
// mipmaps draw no dark fringe.
void spread_colour(std::vector<Sample>& canvas, int size) {
    if (size < 2) return;
    std::vector<Sample> coarse = halve(canvas, size);
    if (size % 2 == 0 && size > 2) spread_colour(coarse, size / 2);
    for (int y = 0; y < size; y++) {
        for (int x = 0; x < size; x++) {
            Sample& sample = canvas[static_cast<size_t>(y) * size + x];
            if (sample.a > 0.0f) continue;
            const Sample& near = coarse[static_cast<size_t>(std::min(y / 2, size / 2 - 1)) * (size / 2) +
                                        std::min(x / 2, size / 2 - 1)];
            sample.r = near.r;
            sample.g = near.g;
            sample.b = near.b;
        }
    }
}

// Shrinks the canvas, drawn at twice the size, to the pictures.
LeafTextures textures_of(const std::vector<Sample>& canvas, int size) {
    const int fine = 2 * size;
    LeafTextures textures{Image(size, size, 4), Image(size, size, 3)};
    // Slopes only within one leaf: where leaves overlap there is a gap, not a cliff.
    for (int y = 0; y < size; y++) {
        for (int x = 0; x < size; x++) {
            DVec3 normal(0.0);
            for (int k = 0; k < 4; k++) {
                const int fx = 2 * x + k % 2, fy = 2 * y + k / 2;
                const auto sample = [&](int dx, int dy) -> const Sample& {
                    return canvas[static_cast<size_t>(std::clamp(fy + dy, 0, fine - 1)) * fine +
                                  std::clamp(fx + dx, 0, fine - 1)];
                };
                const Sample& here = sample(0, 0);
                const auto slope = [&](const Sample& before, const Sample& after) {
                    if (here.a == 0.0f || before.leaf != here.leaf || after.leaf != here.leaf) return 0.0;
                    return 0.5 * fine * static_cast<double>(after.relief - before.relief);
                };
                const double dx = slope(sample(-1, 0), sample(1, 0)), dy = slope(sample(0, 1), sample(0, -1));
                normal += glm::normalize(DVec3(-dx, -dy, 1.0));
            }
            normal = glm::normalize(normal);
            for (int c = 0; c < 3; c++)
                textures.normal.at(x, y)[c] = to_byte(0.5 + 0.5 * normal[c]);
        }
    }
    std::vector<Sample> picture = halve(canvas, fine);
    spread_colour(picture, size);
    for (int y = 0; y < size; y++) {
        for (int x = 0; x < size; x++) {
            const Sample& sample = picture[static_cast<size_t>(y) * size + x];
            uint8_t* pixel = textures.albedo.at(x, y);
            pixel[0] = to_byte(sample.r);
            pixel[1] = to_byte(sample.g);
            pixel[2] = to_byte(sample.b);
            pixel[3] = to_byte(sample.a);
        }
    }
    return textures;
}

void check_arguments(const std::string& preset, int size) {
    leaf_preset(preset);  // throws for an unknown name
    if (size < 16 || size > 4096) throw Error("A texture's size must be between 16 and 4096 pixels.");
}

}  // namespace

LeafTextures make_leaf_textures(const std::string& preset, int size, uint64_t seed) {
    check_arguments(preset, size);
    std::vector<Sample> canvas(static_cast<size_t>(4) * size * size);
    draw_spray(canvas, 2 * size, spray_of(preset), seed);
    return textures_of(canvas, size);
}

LeafTextures make_spray_textures(const std::string& preset, int size, uint64_t seed) {
    check_arguments(preset, size);
    LeafTextures all{Image(kSprayColumns * size, kSprayRows * size, 4),
                     Image(kSprayColumns * size, kSprayRows * size, 3)};
    parallel_for(kSprayColumns * kSprayRows, 1, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; i++) {
            const LeafTextures one = make_leaf_textures(preset, size, i > 0 ? hash_seed(seed, i) : seed);
            const int x = static_cast<int>(i) % kSprayColumns * size,
                      y = static_cast<int>(i) / kSprayColumns * size;
            for (int row = 0; row < size; row++) {
                std::copy_n(one.albedo.at(0, row), 4 * size, all.albedo.at(x, y + row));
                std::copy_n(one.normal.at(0, row), 3 * size, all.normal.at(x, y + row));
            }
        }
    });
    return all;
}

LeafTextures make_blade_textures(const std::string& preset, int size, uint64_t seed) {
    check_arguments(preset, size);
    std::vector<Sample> canvas(static_cast<size_t>(4) * size * size);
    draw_blade(canvas, 2 * size, spray_of(preset), seed);
    return textures_of(canvas, size);
}

}  // namespace treerec
