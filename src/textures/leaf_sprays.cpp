// How the leaves of each kind of tree stand on the twig's end that a spray's picture shows.
#include <algorithm>
#include <cmath>

#include "geometry/portable_math.h"
#include "geometry/random.h"
#include "textures/leaf_canvas.h"
#include "textures/texture_noise.h"

namespace treerec::texture {

namespace {

constexpr double kShootLength = 0.42, kShootTurn = 0.62;  // of a side shoot: over the twig's, radians
constexpr double kDryShare = 0.07, kTornShare = 0.10;     // of the leaves

// A twig beside the one in the middle.
struct Shoot {
    DVec2 from, ahead;
    double length;
    int nodes;

    DVec2 at(double f) const { return from + ahead * (length * f); }
};

// To the right for positive radians.
DVec2 turned(const DVec2& v, double turn) {
    const double c = portable::cos(turn), s = portable::sin(turn);
    return {v.x * c + v.y * s, v.y * c - v.x * s};
}

// A leaf at `on`: side 1 to the right of the way ahead, -1 to the left, 0 at its end.
Leaf leaf_on(const Spray& spray, const DVec2& on, const DVec2& ahead, double f, double side, Random& random) {
    Leaf leaf;
    leaf.direction = turned(ahead, side * spray.spread * (1.0 - 0.38 * f) * random.uniform(0.80, 1.15));
    leaf.length = spray.leaf_length * random.uniform(0.78, 1.08);
    leaf.base = on + leaf.direction * (spray.shape.petiole * leaf.length);
    leaf.bend = -side * random.uniform(0.02, 0.12) + (side == 0.0 ? random.uniform(-0.05, 0.05) : 0.0);
    leaf.brightness = random.uniform(0.76, 1.14);
    leaf.hue = random.uniform(-1.4, 1.4);
    leaf.shown = random.uniform(0.66, 1.0);
    leaf.dry = random.uniform() < kDryShare ? random.uniform(0.5, 1.0) : 0.0;
    leaf.torn = random.uniform() < kTornShare ? spray.shape.width * random.uniform(0.18, 0.42) : 0.0;
    return leaf;
}

void bear_on(const Spray& spray, const Shoot& shoot, Random& random, std::vector<Leaf>& leaves) {
    for (int i = 0; i < shoot.nodes; i++) {
        const double f = mix(0.30, 0.90, (i + 0.5) / shoot.nodes);
        leaves.push_back(leaf_on(spray, shoot.at(f), shoot.ahead, f, i % 2 ? 1.0 : -1.0, random));
    }
    leaves.push_back(leaf_on(spray, shoot.at(1.0), shoot.ahead, 1.0, 0.0, random));
}

std::vector<Shoot> side_shoots(const Spray& spray, double sway, double top, Random& random) {
    std::vector<Shoot> shoots;
    for (int i = 0; i < spray.side_shoots; i++) {
        const double f = mix(0.12, 0.62, (i + 0.5) / spray.side_shoots);
        const double turn = (i % 2 ? -1.0 : 1.0) * kShootTurn * random.uniform(0.85, 1.15);
        shoots.push_back({twig_at(f, sway, top), turned({0.0, 1.0}, turn),
                          kShootLength * top * random.uniform(0.85, 1.1) * (1.0 - 0.4 * f), spray.pairs - 1});
    }
    return shoots;
}

std::vector<Leaf> arrange(const Spray& spray, const std::vector<Shoot>& shoots, double sway, double top,
                          Random& random) {
    std::vector<Leaf> leaves;
    for (const Shoot& shoot : shoots)
        bear_on(spray, shoot, random, leaves);
    const auto add = [&](double f, double side) {
        const DVec2 ahead = glm::normalize(twig_at(f + 0.01, sway, top) - twig_at(f - 0.01, sway, top));
        leaves.push_back(leaf_on(spray, twig_at(f, sway, top), ahead, f, side, random));
    };
    const int count = spray.opposite ? spray.pairs : 2 * spray.pairs;
    for (int i = 0; i < count; i++) {
        const double f =
            mix(spray.opposite ? 0.20 : 0.10, 0.94, count > 1 ? static_cast<double>(i) / (count - 1) : 0.5);
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

void draw_tuft(std::vector<Sample>& canvas, int size, const Spray& spray, uint64_t seed, double sway,
               double top) {
    Random random(seed, 5);
    const int bundles = 84;
    for (int i = 0; i < bundles; i++) {
        const double f = mix(0.06, 1.0, (i + 0.5) / bundles);
        const DVec2 on = twig_at(f, sway, top);
        for (int k = 0; k < 4; k++) {
            const double side = k % 2 ? 1.0 : -1.0;
            const double turn = side * random.uniform(0.25, 1.25) * (1.0 - 0.45 * f);
            const double length = random.uniform(0.24, 0.34) * (1.0 - 0.30 * f);
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
    draw_twig(canvas, size, spray, sway, kTop, 0.013, 0.003, kPieces);
}

// A blade on its petiole, both within the picture.
void draw_stalked_leaf(std::vector<Sample>& canvas, int size, const Spray& spray, DVec2 stalk_base,
                       double turn, double petiole, Leaf leaf, int16_t index, uint64_t seed) {
    constexpr double kEdge = 0.475;
    leaf.direction = {portable::sin(turn), portable::cos(turn)};
    const double half = 0.5 * spray.shape.width;
    // As far as the blade's tip and its corners reach.
    const double aside = std::abs(leaf.direction.x) + half * std::abs(leaf.direction.y) * 0.8;
    const double above = std::max(leaf.direction.y, 0.0) + half * std::abs(leaf.direction.x) * 0.8;
    double room = std::min((kEdge - std::abs(stalk_base.x)) / (petiole * std::abs(leaf.direction.x) + aside),
                           (0.97 - stalk_base.y) / (petiole * std::max(leaf.direction.y, 0.0) + above));
    // Nor below its lower edge, where the shoot comes in.
    room = std::min(room, (stalk_base.y - 0.03) / (std::max(-leaf.direction.y, 0.0) * (1.0 + petiole) +
                                                   half * std::abs(leaf.direction.x)));
    leaf.length = std::min(leaf.length, room);
    leaf.base = stalk_base + leaf.direction * (petiole * leaf.length);
    draw_stalk(canvas, size, stalk_base, leaf.base + leaf.direction * (0.06 * leaf.length), 0.0044, 0.0036,
               glm::mix(spray.twig, spray.vein, 0.65));
    draw_leaf(canvas, size, spray, leaf, index, seed);
}

// A long shoot with short ones on it, each with a bunch of leaves on long petioles.
void draw_short_shoots(std::vector<Sample>& canvas, int size, const Spray& spray, uint64_t seed,
                       double sway) {
    Random random(seed, 5);
    constexpr double kTop = 0.52;
    constexpr int kPieces = 12;
    constexpr struct { double along, aside; } kShoots[] = {{0.38, -1.0}, {0.68, 1.0}, {1.0, 0.0}};
    draw_twig(canvas, size, spray, sway, kTop, 0.010, 0.006, kPieces);
    int16_t index = 0;
    for (const auto& shoot : kShoots) {
        const DVec2 on = twig_at(shoot.along, sway, kTop);
        const DVec2 knob = on + DVec2(0.050 * shoot.aside, 0.022);
        if (shoot.aside != 0.0) draw_stalk(canvas, size, on, knob, 0.010, 0.013, spray.twig);
        // The outer ones lie behind.
        for (int i = 0; i < spray.pairs; i++) {
            const double rank = 1.0 - static_cast<double>(i) / (spray.pairs - 1);  // 1 outermost .. 0
            const double turn = 0.72 * shoot.aside + (i % 2 ? 1.0 : -1.0) * rank *
                                                         (shoot.aside != 0.0 ? 0.62 : 0.66) * spray.spread *
                                                         random.uniform(0.85, 1.1);
            Leaf leaf;
            leaf.length = spray.leaf_length * random.uniform(0.82, 1.08);
            leaf.bend = random.uniform(-0.05, 0.05);
            leaf.brightness = mix(1.06, 0.86, rank) * random.uniform(0.94, 1.06);
            leaf.hue = random.uniform(-1.0, 1.0);
            draw_stalked_leaf(canvas, size, spray, knob, turn,
                              spray.shape.petiole * random.uniform(0.7, 1.25), leaf, index++, seed);
        }
        draw_stalk(canvas, size, on, knob, 0.008, 0.010, spray.twig);
    }
}

// Leaves all around the end of a shoot; of one shows the felted underside.
void draw_rosette(std::vector<Sample>& canvas, int size, const Spray& spray, uint64_t seed, double sway) {
    Random random(seed, 5);
    constexpr double kTop = 0.46;
    constexpr int kPieces = 12;
    draw_twig(canvas, size, spray, sway, kTop, 0.013, 0.008, kPieces);
    Spray felted = spray;
    felted.dark = {0.26, 0.20, 0.12};
    felted.light = {0.46, 0.37, 0.23};
    felted.vein = {0.56, 0.47, 0.28};
    const int count = 2 * spray.pairs;
    for (int i = 0; i <= count; i++) {
        const double f = static_cast<double>(i) / count;
        const double side = i == count ? 0.0 : i % 2 ? 1.0 : -1.0;
        const double turn = side * spray.spread * (1.0 - 0.86 * f) * random.uniform(0.9, 1.1);
        Leaf leaf;
        leaf.length = spray.leaf_length * random.uniform(0.88, 1.08) * (1.0 + 0.12 * f);
        leaf.bend = -side * random.uniform(0.0, 0.12);
        leaf.brightness = mix(0.84, 1.08, f) * random.uniform(0.94, 1.08);
        leaf.hue = random.uniform(-0.8, 0.8);
        draw_stalked_leaf(canvas, size, i == 1 ? felted : spray, twig_at(mix(0.52, 1.0, f), sway, kTop), turn,
                          spray.shape.petiole, leaf, static_cast<int16_t>(i), seed);
    }
}

void draw_leaves(std::vector<Sample>& canvas, int size, const Spray& spray, uint64_t seed, double sway,
                 double top) {
    Random random(seed, 77);
    const std::vector<Shoot> shoots = side_shoots(spray, sway, top, random);
    for (const Shoot& shoot : shoots)
        draw_stalk(canvas, size, shoot.from, shoot.at(1.0), 0.0055, 0.0032, spray.twig);
    const std::vector<Leaf> leaves = arrange(spray, shoots, sway, top, random);
    for (const Leaf& leaf : leaves) {
        const DVec2 stalk_base = leaf.base - leaf.direction * (spray.shape.petiole * leaf.length);
        draw_stalk(canvas, size, stalk_base, leaf.base + leaf.direction * (0.08 * leaf.length), 0.0042,
                   0.0032, glm::mix(spray.twig, spray.vein, 0.6));
        draw_leaf(canvas, size, spray, leaf, static_cast<int16_t>(&leaf - leaves.data()), seed);
    }
}

}  // namespace

void draw_spray(std::vector<Sample>& canvas, int size, const Spray& spray, uint64_t seed) {
    Random random(seed, 3);
    const double sway = random.uniform(-0.03, 0.03);
    if (spray.habit == Habit::kFlatTwigs) return draw_flat_twigs(canvas, size, spray, seed, sway);
    if (spray.habit == Habit::kFrond) return draw_frond(canvas, size, spray, seed, sway);
    if (spray.habit == Habit::kShortShoots) return draw_short_shoots(canvas, size, spray, seed, sway);
    if (spray.habit == Habit::kRosette) return draw_rosette(canvas, size, spray, seed, sway);
    const bool tuft = spray.habit == Habit::kTuft;
    const double top = tuft ? 0.74 : 0.97 - spray.leaf_length * (1.12 + spray.shape.petiole);
    constexpr int kTwigPieces = 16;
    draw_twig(canvas, size, spray, sway, top, 0.009, 0.004, kTwigPieces);
    if (tuft)
        draw_tuft(canvas, size, spray, seed, sway, top);
    else
        draw_leaves(canvas, size, spray, seed, sway, top);
}

}  // namespace treerec::texture
