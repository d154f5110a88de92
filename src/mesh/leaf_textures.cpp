#include <algorithm>
#include <vector>

#include "error.h"
#include "foliage/leaves.h"
#include "geometry/parallel.h"
#include "geometry/portable_math.h"
#include "mesh/leaf_cards.h"
#include "mesh/leaf_shapes.h"
#include "mesh/texture_noise.h"
#include "mesh/textures.h"

namespace treerec {

namespace {

using namespace texture;

// Coordinates of the spray: x from -0.5 to 0.5, y from 0 at the lower edge to 1.

struct Leaf {
    DVec2 base;       // of the blade
    DVec2 direction;  // unit, of the midrib
    double length;
    double bend;  // sideways curve of the midrib, over the length
    double brightness;
    double hue;
};

struct Sample {
    float r = 0, g = 0, b = 0, a = 0;
    float relief = 0;  // in spray units
    int16_t leaf = -1;
};

DVec2 twig_at(double f, double sway, double top) {
    return {sway * portable::sin(2.2 * f) * f, top * f};
}

std::vector<Leaf> arrange(const Spray& spray, uint64_t seed, double sway, double top) {
    std::vector<Leaf> leaves;
    Random random(seed, 77);
    const auto add = [&](double f, double side) {
        const DVec2 on = twig_at(f, sway, top);
        const DVec2 ahead = glm::normalize(twig_at(f + 0.01, sway, top) - twig_at(f - 0.01, sway, top));
        const double turn = side * spray.spread * (1.0 - 0.38 * f) * random.uniform(0.88, 1.1);
        const DVec2 direction(ahead.x * portable::cos(turn) + ahead.y * portable::sin(turn),
                              ahead.y * portable::cos(turn) - ahead.x * portable::sin(turn));
        Leaf leaf;
        leaf.length = spray.leaf_length * random.uniform(0.86, 1.06) * (side == 0.0 ? 1.05 : 1.0);
        leaf.direction = direction;
        leaf.base = on + direction * (spray.shape.petiole * leaf.length);
        leaf.bend = -side * random.uniform(0.02, 0.10) + (side == 0.0 ? random.uniform(-0.05, 0.05) : 0.0);
        leaf.brightness = random.uniform(0.86, 1.10);
        leaf.hue = random.uniform(-1.0, 1.0);
        leaves.push_back(leaf);
    };
    const int count = spray.opposite ? spray.pairs : 2 * spray.pairs;
    for (int i = 0; i < count; i++) {
        const double f =
            mix(spray.opposite ? 0.34 : 0.14, 0.92, count > 1 ? static_cast<double>(i) / (count - 1) : 0.5);
        if (spray.opposite) {
            add(f, 1.0);
            add(f, -1.0);
        } else {
            add(f, i % 2 ? 1.0 : -1.0);
        }
    }
    add(1.0, 0.0);
    return leaves;
}

// A line of the given half width from a to b, blended onto the canvas.
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
    const double reach = leaf.length * (spray.shape.palmate ? 1.25 : 1.1);
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
            const double t = glm::dot(local, across) - leaf.bend * s * s;
            const BladePoint blade = blade_at(spray.shape, s, t);
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

void draw_tuft(std::vector<Sample>& canvas, int size, const Spray& spray, uint64_t seed, double sway,
               double top) {
    Random random(seed, 5);
    const int bundles = 64;
    for (int i = 0; i < bundles; i++) {
        const double f = mix(0.06, 1.0, (i + 0.5) / bundles);
        const DVec2 on = twig_at(f, sway, top);
        for (int k = 0; k < 4; k++) {
            const double side = k % 2 ? 1.0 : -1.0;
            const double turn = side * random.uniform(0.25, 1.25) * (1.0 - 0.45 * f);
            const double length = random.uniform(0.26, 0.40) * (1.0 - 0.35 * f);
            const DVec2 direction(portable::sin(turn), portable::cos(turn));
            const DVec2 middle = on + direction * (0.5 * length);
            const DVec2 tip = middle + glm::normalize(direction + DVec2(0.0, 0.25)) * (0.5 * length);
            const double light = random.uniform(0.75, 1.2);
            const DVec3 colour = glm::mix(spray.dark, spray.light, random.uniform()) * light;
            draw_stalk(canvas, size, on, middle, 0.0048, 0.0052, colour);
            draw_stalk(canvas, size, middle, tip, 0.0052, 0.0014, colour);
        }
    }
}

// Short needles to both sides of a twig from a to b.
void draw_needled_twig(std::vector<Sample>& canvas, int size, const Spray& spray, DVec2 a, DVec2 b,
                       Random& random) {
    const DVec2 along = glm::normalize(b - a), across(along.y, -along.x);
    const double length = glm::distance(a, b);
    const int count = std::max(6, static_cast<int>(length * 190.0));
    draw_stalk(canvas, size, a, b, 0.0065, 0.0030, spray.twig);
    for (int i = 0; i < count; i++) {
        const double f = (i + 0.5) / count;
        // Those on top of the twig come last and look shorter.
        const double side = i % 3 == 2 ? random.uniform(-0.4, 0.4) : i % 3 == 1 ? 1.0 : -1.0;
        const double needle = spray.leaf_length * random.uniform(0.8, 1.1) * (1.0 - 0.3 * f);
        const DVec2 direction = glm::normalize(along * random.uniform(0.55, 0.95) + across * side);
        const DVec2 from = glm::mix(a, b, f);
        const DVec3 colour = glm::mix(spray.dark, spray.light, random.uniform()) * (0.8 + 0.35 * f);
        draw_stalk(canvas, size, from, from + direction * (0.6 * needle), 0.0040, 0.0042, colour);
        draw_stalk(canvas, size, from + direction * (0.6 * needle), from + direction * needle, 0.0042, 0.0012,
                   colour * 1.1);
    }
}

// A flat branchlet of needled twigs.
void draw_flat_twigs(std::vector<Sample>& canvas, int size, const Spray& spray, uint64_t seed, double sway) {
    Random random(seed, 5);
    constexpr double kTop = 0.88;
    constexpr int kPieces = 6;
    const int count = 2 * spray.pairs;
    for (int i = 0; i < count; i++) {
        const double f = mix(0.10, 0.86, (i + 0.5) / count);
        const double side = i % 2 ? 1.0 : -1.0;
        const double turn = side * spray.spread * random.uniform(0.9, 1.1) * (1.0 - 0.2 * f);
        const double reach = (0.40 * (1.0 - f) + 0.10) * random.uniform(0.9, 1.1);
        const DVec2 on = twig_at(f, sway, kTop);
        const DVec2 bent(portable::sin(0.75 * turn), portable::cos(0.75 * turn));
        const DVec2 middle = on + DVec2(portable::sin(turn), portable::cos(turn)) * (0.55 * reach);
        draw_needled_twig(canvas, size, spray, middle, middle + bent * (0.45 * reach), random);
        draw_needled_twig(canvas, size, spray, on, middle, random);
    }
    for (int i = kPieces - 1; i >= 0; i--)
        draw_needled_twig(canvas, size, spray, twig_at(static_cast<double>(i) / kPieces, sway, kTop),
                          twig_at(static_cast<double>(i + 1) / kPieces, sway, kTop), random);
}

// A feather of leaflets along a stout rachis.
void draw_frond(std::vector<Sample>& canvas, int size, const Spray& spray, uint64_t seed, double sway) {
    Random random(seed, 5);
    constexpr double kTop = 0.86;
    constexpr int kPieces = 24;
    int16_t index = 0;
    for (int i = 0; i <= 2 * spray.pairs; i++) {
        const double f = mix(0.13, 1.0, static_cast<double>(i) / (2 * spray.pairs));
        const double side = i == 2 * spray.pairs ? 0.0 : i % 2 ? 1.0 : -1.0;
        Leaf leaf;
        // Longest a little below the middle, short and upright at the tip.
        leaf.length = spray.leaf_length * portable::pow(portable::sin(kPi * mix(0.24, 0.97, f)), 0.8) *
                      random.uniform(0.90, 1.04);
        leaf.length = std::max(leaf.length, 0.09);
        const double turn = side * mix(spray.spread, 0.30, f * f * f) * random.uniform(0.95, 1.05);
        leaf.direction = {portable::sin(turn), portable::cos(turn)};
        leaf.base = twig_at(f, sway, kTop);
        const double room =
            std::min((0.96 - leaf.base.y) / std::max(leaf.direction.y, 0.2),
                     (0.485 - std::abs(leaf.base.x)) / std::max(std::abs(leaf.direction.x), 1e-6));
        leaf.length = std::min(leaf.length, room);
        leaf.bend = side * random.uniform(0.02, 0.06);
        leaf.brightness = random.uniform(0.8, 1.12);
        leaf.hue = random.uniform(-0.6, 1.0);
        draw_leaf(canvas, size, spray, leaf, index++, seed);
    }
    for (int i = 0; i < kPieces; i++) {
        const double f0 = static_cast<double>(i) / kPieces, f1 = static_cast<double>(i + 1) / kPieces;
        draw_stalk(canvas, size, twig_at(f0, sway, kTop), twig_at(f1, sway, kTop), mix(0.013, 0.003, f0),
                   mix(0.013, 0.003, f1), spray.twig);
    }
}

void draw_leaves(std::vector<Sample>& canvas, int size, const Spray& spray, uint64_t seed, double sway,
                 double top) {
    const std::vector<Leaf> leaves = arrange(spray, seed, sway, top);
    for (const Leaf& leaf : leaves) {
        const DVec2 foot = leaf.base - leaf.direction * (spray.shape.petiole * leaf.length);
        draw_stalk(canvas, size, foot, leaf.base + leaf.direction * (0.08 * leaf.length), 0.0042, 0.0032,
                   glm::mix(spray.twig, spray.vein, 0.6));
        draw_leaf(canvas, size, spray, leaf, static_cast<int16_t>(&leaf - leaves.data()), seed);
    }
}

void draw_spray(std::vector<Sample>& canvas, int size, const Spray& spray, uint64_t seed) {
    Random random(seed, 3);
    const double sway = random.uniform(-0.03, 0.03);
    if (spray.habit == Habit::kFlatTwigs) return draw_flat_twigs(canvas, size, spray, seed, sway);
    if (spray.habit == Habit::kFrond) return draw_frond(canvas, size, spray, seed, sway);
    const bool tuft = spray.habit == Habit::kTuft;
    const double top = tuft ? 0.74 : 0.97 - spray.leaf_length * (1.08 + spray.shape.petiole);
    constexpr int kTwigPieces = 16;
    for (int i = 0; i < kTwigPieces; i++) {
        const double f0 = static_cast<double>(i) / kTwigPieces, f1 = static_cast<double>(i + 1) / kTwigPieces;
        draw_stalk(canvas, size, twig_at(f0, sway, top), twig_at(f1, sway, top), mix(0.009, 0.004, f0),
                   mix(0.009, 0.004, f1), spray.twig);
    }
    if (tuft)
        draw_tuft(canvas, size, spray, seed, sway, top);
    else
        draw_leaves(canvas, size, spray, seed, sway, top);
}

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

LeafTextures make_blade_textures(const std::string& preset, int size, uint64_t seed) {
    check_arguments(preset, size);
    std::vector<Sample> canvas(static_cast<size_t>(4) * size * size);
    draw_blade(canvas, 2 * size, spray_of(preset), seed);
    return textures_of(canvas, size);
}

}  // namespace treerec
