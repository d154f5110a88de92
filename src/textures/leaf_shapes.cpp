#include "textures/leaf_shapes.h"

#include <algorithm>
#include <cmath>

#include "geometry/portable_math.h"
#include "textures/texture_noise.h"

namespace treerec::texture {

namespace {

// Half the width of a lobe at `s` (0 base .. 1 tip), over its length.
double half_width(const Shape& shape, double s) {
    if (s <= 0.0 || s >= 1.0) return 0.0;
    // A bell that rises to 1 at `widest`: s^a (1-s)^b scaled.
    const double b = shape.taper;
    const double a = b * shape.widest / (1.0 - shape.widest);
    const double bell =
        portable::pow(s / shape.widest, a) * portable::pow((1.0 - s) / (1.0 - shape.widest), b);
    double width = 0.5 * shape.width * portable::pow(bell, 0.62);
    if (shape.margin == Margin::kSerrate) {
        // Saw teeth that point to the tip.
        const double tooth = s * shape.teeth - std::floor(s * shape.teeth);
        width *= 1.0 - shape.depth * (1.0 - tooth) * smoothstep(0.0, 0.12, 1.0 - s);
    } else if (shape.margin == Margin::kLobed) {
        const double wave = 0.5 + 0.5 * portable::cos(2.0 * kPi * (s * shape.teeth - 0.62));
        width *= 1.0 - shape.depth * (1.0 - portable::pow(wave, 0.7)) * smoothstep(0.08, 0.22, s) *
                           smoothstep(0.0, 0.18, 1.0 - s);
    }
    return width;
}

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
    const double quilt = 0.5 - 0.5 * portable::cos(2.0 * kPi * (phase + 0.5));
    point.relief = 0.020 * std::sqrt(quilt) * (1.0 - 0.5 * reach) + 0.30 * across - 0.012 * midrib;
    return point;
}

// A fan: a wedge from the petiole, its veins forking on their way to a wavy rim that is cleft in the middle.
BladePoint fan_at(const Shape& shape, double s, double t) {
    constexpr double kLean = 0.12;  // the sides are hollow: steeper at the base
    BladePoint point;
    const double reach = std::sqrt(s * s + t * t);
    const double turn = reach > 1e-9 ? portable::atan2(t, s) : 0.0;
    const double half = portable::asin(std::min(0.999, 0.5 * shape.width));
    const double side = half * (1.0 - kLean + 2.0 * kLean * reach * reach);
    const double share = turn / half;
    // Where the rim lies: rounded to the corners, wavy, the two lobes not quite alike.
    double rim = 1.0 - 0.10 * share * share + 0.016 * portable::sin(19.0 * turn + 1.1) +
                 0.011 * portable::sin(43.0 * turn);
    rim -= 0.09 * smoothstep(0.72, 1.08, std::abs(share));
    const double off = std::abs(t + 0.018 * portable::sin(9.0 * s));
    const double cleft =
        shape.depth * (1.0 - smoothstep(0.0, 0.05, off)) + 0.06 * (1.0 - smoothstep(0.0, 0.22, off));
    rim -= cleft;
    point.inside = std::min(rim - reach, (side - std::abs(turn)) * std::max(reach, 0.02));
    if (s < 0.0) point.inside = std::min(point.inside, -reach);
    if (point.inside < -0.05) return point;
    // Each vein forks twice, so that they keep their distance.
    double line = 0.0;
    for (int fork = 0; fork < 3; fork++) {
        const double phase = turn / half * shape.veins * 0.5 * (1 << fork);
        const double from = fork == 0 ? 0.0 : 0.20 + 0.24 * (fork - 1);
        const double near = std::abs(phase - std::floor(phase) - 0.5) * 2.0;
        line = std::max(
            line, (1.0 - smoothstep(0.0, 0.55, 1.0 - near)) * smoothstep(from, from + 0.10, reach + 1e-9));
    }
    point.vein = 0.75 * line * smoothstep(0.0, 0.05, point.inside) + 0.5 * smoothstep(0.22, 0.0, reach);
    point.relief = 0.010 * line + 0.035 * portable::cos(7.0 * turn) * reach;
    return point;
}

const DVec3 kTwig(0.33, 0.25, 0.17);  // the colour of most twigs

struct PresetSpray {
    const char* preset;
    Spray spray;
};

const PresetSpray kSprays[] = {
    {"maple",
     {{0.50, 0.46, 1.75, Margin::kSerrate, 4, 0.24, 5, true, 0.34},
      4,
      true,
      0.275,
      1.10,
      {0.17, 0.33, 0.09},
      {0.38, 0.55, 0.17},
      {0.60, 0.68, 0.36},
      kTwig}},
    {"cherry",
     {{0.46, 0.47, 1.75, Margin::kSerrate, 22, 0.035, 8, false, 0.20},
      4,
      false,
      0.28,
      1.18,
      {0.14, 0.31, 0.09},
      {0.33, 0.52, 0.16},
      {0.52, 0.63, 0.32},
      {0.36, 0.22, 0.17},
      Habit::kLeaves,
      3}},
    {"oak",
     {{0.60, 0.60, 0.85, Margin::kLobed, 4, 0.34, 5, false, 0.06},
      4,
      false,
      0.29,
      1.10,
      {0.16, 0.28, 0.08},
      {0.35, 0.47, 0.15},
      {0.56, 0.60, 0.31},
      kTwig,
      Habit::kLeaves,
      2}},
    {"birch",
     {{0.74, 0.30, 1.85, Margin::kSerrate, 14, 0.075, 6, false, 0.30},
      5,
      false,
      0.19,
      1.12,
      {0.20, 0.37, 0.10},
      {0.45, 0.60, 0.20},
      {0.64, 0.71, 0.40},
      {0.29, 0.20, 0.16},
      Habit::kLeaves,
      3}},
    {"willow",
     {{0.17, 0.38, 1.5, Margin::kSerrate, 26, 0.06, 9, false, 0.08},
      8,
      false,
      0.27,
      0.78,
      {0.22, 0.34, 0.13},
      {0.45, 0.56, 0.25},
      {0.62, 0.68, 0.44},
      {0.42, 0.38, 0.18},
      Habit::kLeaves,
      4}},
    {"apple",
     {{0.60, 0.48, 1.25, Margin::kSerrate, 18, 0.045, 6, false, 0.26},
      4,
      false,
      0.27,
      1.20,
      {0.13, 0.29, 0.10},
      {0.32, 0.48, 0.19},
      {0.56, 0.63, 0.40},
      {0.34, 0.24, 0.20},
      Habit::kLeaves,
      2}},
    {"pine",
     {{0.02, 0.50, 0.35, Margin::kSmooth, 0, 0.0, 0, false, 0.0},
      0,
      false,
      0.33,
      0.0,
      {0.12, 0.25, 0.11},
      {0.27, 0.42, 0.20},
      {0.34, 0.47, 0.27},
      kTwig,
      Habit::kTuft}},
    {"spruce",
     {{0.06, 0.50, 0.35, Margin::kSmooth, 0, 0.0, 0, false, 0.0},
      5,
      true,
      0.075,
      0.90,
      {0.11, 0.25, 0.14},
      {0.29, 0.45, 0.24},
      {0.28, 0.43, 0.28},
      {0.40, 0.28, 0.17},
      Habit::kFlatTwigs}},
    {"palm",
     {{0.06, 0.35, 1.1, Margin::kSmooth, 0, 0.0, 2, false, 0.0},
      34,
      true,
      0.46,
      0.95,
      {0.13, 0.29, 0.07},
      {0.36, 0.52, 0.16},
      {0.55, 0.60, 0.26},
      {0.50, 0.49, 0.22},
      Habit::kFrond}},
    {"ginkgo",
     {{1.68, 0.5, 1.0, Margin::kSmooth, 0, 0.30, 15, false, 0.62, true},
      5,
      false,
      0.235,
      1.95,
      {0.30, 0.44, 0.11},
      {0.55, 0.67, 0.22},
      {0.66, 0.73, 0.37},
      {0.44, 0.39, 0.30},
      Habit::kShortShoots}},
    {"poplar",
     {{0.96, 0.30, 1.55, Margin::kSerrate, 15, 0.055, 6, false, 0.62},
      4,
      false,
      0.215,
      1.20,
      {0.17, 0.34, 0.10},
      {0.40, 0.57, 0.20},
      {0.66, 0.70, 0.42},
      {0.40, 0.36, 0.22},
      Habit::kLeaves,
      3}},
    {"magnolia",
     {{0.42, 0.52, 1.08, Margin::kSmooth, 0, 0.0, 9, false, 0.10},
      5,
      false,
      0.40,
      1.75,
      {0.055, 0.155, 0.065},
      {0.20, 0.37, 0.15},
      {0.46, 0.54, 0.26},
      {0.30, 0.25, 0.18},
      Habit::kRosette}},
};

const Spray kGenericSpray = {{0.52, 0.42, 1.65, Margin::kSmooth, 0, 0.0, 7, false, 0.16},
                             4,
                             false,
                             0.28,
                             1.15,
                             {0.16, 0.34, 0.09},
                             {0.36, 0.55, 0.18},
                             {0.55, 0.66, 0.34},
                             kTwig,
                             Habit::kLeaves,
                             3};

}  // namespace

Spray spray_of(const std::string& preset) {
    for (const PresetSpray& known : kSprays)
        if (preset == known.preset) return known.spray;
    return kGenericSpray;
}

BladePoint blade_at(const Shape& shape, double s, double t) {
    if (shape.fan) return fan_at(shape, s, t);
    if (!shape.palmate) return lobe_at(shape, s, t);
    static constexpr double kAngles[5] = {0.0, 0.74, -0.74, 1.52, -1.52};
    static constexpr double kLengths[5] = {1.0, 0.86, 0.86, 0.54, 0.54};
    BladePoint best;
    const double s0 = s - 0.06;
    for (int i = 0; i < 5; i++) {
        const double c = portable::cos(kAngles[i]), n = portable::sin(kAngles[i]);
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

BladeBox box_of(const Shape& shape) {
    constexpr double kSteps = 400.0;
    const double aside = shape.palmate ? 1.1 : 0.55 * shape.width;
    BladeBox box{1.0, 0.0, 1.0, -1.0};
    for (double s = -0.6; s <= 1.1; s += 1.7 / kSteps)
        for (double t = -aside; t <= aside; t += 2.0 * aside / kSteps) {
            if (blade_at(shape, s, t).inside <= 0.0) continue;
            box.s_low = std::min(box.s_low, s);
            box.s_high = std::max(box.s_high, s);
            box.t_low = std::min(box.t_low, t);
            box.t_high = std::max(box.t_high, t);
        }
    return box;
}

}  // namespace treerec::texture
