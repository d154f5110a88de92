#include <algorithm>
#include <vector>

#include "error.h"
#include "foliage/leaves.h"
#include "geometry/parallel.h"
#include "mesh/texture_noise.h"
#include "mesh/textures.h"

namespace treerec {

namespace {

using namespace texture;

// Coordinates of the spray: x from -0.5 to 0.5, y from 0 at the lower edge to 1.

enum class Margin { kSmooth, kSerrate, kLobed };

struct Shape {
    double width;    // full width over length of one lobe
    double widest;   // where along the lobe it is widest, 0..1
    double taper;    // > 1 draws the tip out
    Margin margin;   //
    int teeth;       // along one side
    double depth;    // of the teeth, over the width
    int veins;       // pairs of side veins
    bool palmate;    // five lobes from one point
    double petiole;  // over the leaf's length
};

struct Spray {
    Shape shape;
    int pairs;           // leaves beside the twig: 2 per pair
    bool opposite;       // else alternate
    double leaf_length;  // of the blade
    double spread;       // radians between the twig and its lowest leaves
    DVec3 dark, light;   // blade colours, sRGB
    DVec3 vein, twig;
};

Spray spray_of(const std::string& preset) {
    const DVec3 twig(0.33, 0.25, 0.17);
    if (preset == "maple")
        return {{0.50, 0.46, 1.75, Margin::kSerrate, 4, 0.24, 5, true, 0.34},
                2,
                true,
                0.36,
                1.10,
                {0.17, 0.33, 0.09},
                {0.38, 0.55, 0.17},
                {0.60, 0.68, 0.36},
                twig};
    if (preset == "cherry")
        return {{0.46, 0.47, 1.75, Margin::kSerrate, 22, 0.035, 8, false, 0.20},
                4,
                false,
                0.37,
                1.18,
                {0.14, 0.31, 0.09},
                {0.33, 0.52, 0.16},
                {0.52, 0.63, 0.32},
                {0.36, 0.22, 0.17}};
    if (preset == "oak")
        return {{0.60, 0.60, 0.85, Margin::kLobed, 4, 0.34, 5, false, 0.06},
                3,
                false,
                0.43,
                1.10,
                {0.16, 0.28, 0.08},
                {0.35, 0.47, 0.15},
                {0.56, 0.60, 0.31},
                twig};
    if (preset == "birch")
        return {{0.74, 0.30, 1.85, Margin::kSerrate, 14, 0.075, 6, false, 0.30},
                4,
                false,
                0.31,
                1.12,
                {0.20, 0.37, 0.10},
                {0.45, 0.60, 0.20},
                {0.64, 0.71, 0.40},
                {0.29, 0.20, 0.16}};
    return {{0.52, 0.42, 1.65, Margin::kSmooth, 0, 0.0, 7, false, 0.16},
            4,
            false,
            0.36,
            1.15,
            {0.16, 0.34, 0.09},
            {0.36, 0.55, 0.18},
            {0.55, 0.66, 0.34},
            twig};
}

// Half the width of a lobe at `s` (0 base .. 1 tip), over its length.
double half_width(const Shape& shape, double s) {
    if (s <= 0.0 || s >= 1.0) return 0.0;
    // A bell that rises to 1 at `widest`: s^a (1-s)^b scaled.
    const double b = shape.taper;
    const double a = b * shape.widest / (1.0 - shape.widest);
    const double bell = std::pow(s / shape.widest, a) * std::pow((1.0 - s) / (1.0 - shape.widest), b);
    double width = 0.5 * shape.width * std::pow(bell, 0.62);
    if (shape.margin == Margin::kSerrate) {
        // Saw teeth that point to the tip.
        const double tooth = s * shape.teeth - std::floor(s * shape.teeth);
        width *= 1.0 - shape.depth * (1.0 - tooth) * smoothstep(0.0, 0.12, 1.0 - s);
    } else if (shape.margin == Margin::kLobed) {
        const double wave = 0.5 + 0.5 * std::cos(2.0 * kPi * (s * shape.teeth - 0.62));
        width *= 1.0 - shape.depth * (1.0 - std::pow(wave, 0.7)) * smoothstep(0.08, 0.22, s) *
                           smoothstep(0.0, 0.18, 1.0 - s);
    }
    return width;
}

// What a blade shows at a point: how far inside it is (negative: outside; in lengths), vein strength, relief.
struct BladePoint {
    double inside = -1.0;
    double vein = 0.0;
    double relief = 0.0;
};

// One lobe: `s` along its midrib, `t` across, both over its length.
BladePoint lobe_at(const Shape& shape, double s, double t) {
    BladePoint point;
    const double width = half_width(shape, s);
    const double across = std::abs(t);
    const double beyond = std::max({0.0, -s, s - 1.0});
    point.inside = beyond > 0.0 ? -std::sqrt(across * across + beyond * beyond) : width - across;
    if (point.inside < -0.05) return point;
    const double reach = width > 1e-6 ? clamp01(across / width) : 1.0;
    const double midrib = smoothstep(0.016 * (1.15 - s), 0.006 * (1.15 - s), across);
    // Side veins leave the midrib at an angle and bend towards the tip.
    const double q =
        (s - 0.55 * across - 0.55 * across * reach) * (shape.veins + 1.0) + (t > 0.0 ? 0.35 : 0.0);
    const double phase = q - std::floor(q) - 0.5;
    const double side = smoothstep(0.11, 0.03, std::abs(phase)) * (1.0 - 0.75 * reach);
    point.vein = std::max(midrib, 0.62 * side);
    const double quilt = 0.5 - 0.5 * std::cos(2.0 * kPi * (phase + 0.5));
    point.relief = 0.020 * std::sqrt(quilt) * (1.0 - 0.5 * reach) + 0.30 * across - 0.012 * midrib;
    return point;
}

BladePoint blade_at(const Shape& shape, double s, double t) {
    if (!shape.palmate) return lobe_at(shape, s, t);
    static constexpr double kAngles[5] = {0.0, 0.74, -0.74, 1.52, -1.52};
    static constexpr double kLengths[5] = {1.0, 0.86, 0.86, 0.54, 0.54};
    BladePoint best;
    const double s0 = s - 0.06;
    for (int i = 0; i < 5; i++) {
        const double c = std::cos(kAngles[i]), n = std::sin(kAngles[i]);
        const double along = (s0 * c + t * n) / kLengths[i];
        const double across = (t * c - s0 * n) / kLengths[i];
        // Palmate lobes share a broad base: widen each towards it.
        BladePoint point = lobe_at(shape, along, across);
        point.inside *= kLengths[i];
        if (point.inside > best.inside) {
            best = point;
        }
    }
    const double heart = 0.21 - std::sqrt((s0 - 0.16) * (s0 - 0.16) + t * t);
    best.inside = std::max(best.inside, heart);
    return best;
}

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
    return {sway * std::sin(2.2 * f) * f, top * f};
}

std::vector<Leaf> arrange(const Spray& spray, uint64_t seed, double sway, double top) {
    std::vector<Leaf> leaves;
    Random random(seed, 77);
    const auto add = [&](double f, double side) {
        const DVec2 on = twig_at(f, sway, top);
        const DVec2 ahead = glm::normalize(twig_at(f + 0.01, sway, top) - twig_at(f - 0.01, sway, top));
        const double turn = side * spray.spread * (1.0 - 0.38 * f) * random.uniform(0.88, 1.1);
        const DVec2 direction(ahead.x * std::cos(turn) + ahead.y * std::sin(turn),
                              ahead.y * std::cos(turn) - ahead.x * std::sin(turn));
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

void draw_needles(std::vector<Sample>& canvas, int size, uint64_t seed, double sway, double top) {
    Random random(seed, 5);
    const int bundles = 64;
    for (int i = 0; i < bundles; i++) {
        const double f = mix(0.06, 1.0, (i + 0.5) / bundles);
        const DVec2 on = twig_at(f, sway, top);
        for (int k = 0; k < 4; k++) {
            const double side = k % 2 ? 1.0 : -1.0;
            const double turn = side * random.uniform(0.25, 1.25) * (1.0 - 0.45 * f);
            const double length = random.uniform(0.26, 0.40) * (1.0 - 0.35 * f);
            const DVec2 direction(std::sin(turn), std::cos(turn));
            const DVec2 middle = on + direction * (0.5 * length);
            const DVec2 tip = middle + glm::normalize(direction + DVec2(0.0, 0.25)) * (0.5 * length);
            const double light = random.uniform(0.75, 1.2);
            const DVec3 colour =
                glm::mix(DVec3(0.12, 0.25, 0.11), DVec3(0.27, 0.42, 0.20), random.uniform()) * light;
            draw_stalk(canvas, size, on, middle, 0.0048, 0.0052, colour);
            draw_stalk(canvas, size, middle, tip, 0.0052, 0.0014, colour);
        }
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

}  // namespace

LeafTextures make_leaf_textures(const std::string& preset, int size, uint64_t seed) {
    leaf_preset(preset);  // throws for an unknown name
    if (size < 16 || size > 4096) throw Error("A texture's size must be between 16 and 4096 pixels.");
    const int fine = 2 * size;
    std::vector<Sample> canvas(static_cast<size_t>(fine) * fine);
    Random random(seed, 3);
    const double sway = random.uniform(-0.03, 0.03);
    const Spray spray = spray_of(preset);
    const bool needles = preset == "pine";
    const double top = needles ? 0.74 : 0.97 - spray.leaf_length * (1.08 + spray.shape.petiole);
    constexpr int kTwigPieces = 16;
    for (int i = 0; i < kTwigPieces; i++) {
        const double f0 = static_cast<double>(i) / kTwigPieces, f1 = static_cast<double>(i + 1) / kTwigPieces;
        draw_stalk(canvas, fine, twig_at(f0, sway, top), twig_at(f1, sway, top), mix(0.009, 0.004, f0),
                   mix(0.009, 0.004, f1), spray.twig);
    }
    if (needles) {
        draw_needles(canvas, fine, seed, sway, top);
    } else {
        const std::vector<Leaf> leaves = arrange(spray, seed, sway, top);
        for (const Leaf& leaf : leaves) {
            const DVec2 foot = leaf.base - leaf.direction * (spray.shape.petiole * leaf.length);
            draw_stalk(canvas, fine, foot, leaf.base + leaf.direction * (0.08 * leaf.length), 0.0042, 0.0032,
                       glm::mix(spray.twig, spray.vein, 0.6));
            draw_leaf(canvas, fine, spray, leaf, static_cast<int16_t>(&leaf - leaves.data()), seed);
        }
    }
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

}  // namespace treerec
