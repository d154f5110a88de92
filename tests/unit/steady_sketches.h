// Sketches as a steady hand draws them, for the tests of what becomes of them.
#pragma once

#include <vector>

#include "geometry/portable_trig.h"
#include "geometry/random.h"
#include "sketch/strokes.h"

namespace treerec {

inline Stroke drawn_line(const DVec2& from, const DVec2& to, double bend = 0.0) {
    Stroke stroke;
    const DVec2 way = to - from;
    const DVec2 side(-way.y, way.x);
    const int steps = std::max(4, static_cast<int>(glm::length(way) / 5.0));
    for (int i = 0; i <= steps; i++) {
        const double t = static_cast<double>(i) / steps;
        stroke.points.push_back(from + way * t + side * (bend * 4.0 * t * (1.0 - t)));
    }
    return stroke;
}

inline Stroke drawn_outline(const DVec2& middle, const DVec2& radii, double lobes = 0.0, int count = 7) {
    Stroke stroke;
    for (int i = 0; i < 160; i++) {
        const double angle = 2.0 * kPi * i / 160.0;
        const SineCosine turn = portable_sine_cosine(angle);
        const double wave = 1.0 + lobes * portable_sine_cosine(angle * count).sine;
        stroke.points.push_back(middle + radii * wave * DVec2(turn.sine, -turn.cosine));
    }
    return stroke;
}

// A crown of chance proportions, a trunk up into it, and branches on both sides that end in it.
inline Sketch drawn_sketch(uint64_t seed) {
    Random random(seed);
    Sketch sketch;
    sketch.seed = seed;
    sketch.height = random.uniform(3.0, 25.0);
    const DVec2 radii(random.uniform(120.0, 360.0), random.uniform(200.0, 330.0));
    const DVec2 middle(500.0 + random.uniform(-60.0, 60.0), 60.0 + radii.y * 1.2);
    sketch.strokes.push_back(drawn_outline(middle, radii, random.uniform(0.0, 0.08)));
    const DVec2 stem_base(500.0 + random.uniform(-60.0, 60.0), 965.0);
    const DVec2 top = middle + DVec2(random.uniform(-20.0, 20.0), -random.uniform(0.3, 0.7) * radii.y);
    const Stroke trunk = drawn_line(stem_base, top, random.uniform(-0.04, 0.04));
    sketch.strokes.push_back(trunk);
    const int branches = 2 + static_cast<int>(random.below(7));
    for (int i = 0; i < branches; i++) {
        const double side = i % 2 == 0 ? 1.0 : -1.0;
        const double share = 0.45 + 0.45 * (i + random.uniform()) / branches;
        const auto at = static_cast<size_t>(share * static_cast<double>(trunk.points.size() - 1));
        const DVec2 base = trunk.points[at];
        // Towards the outline, higher up.
        const double angle = kPi * random.uniform(0.15, 0.4);
        const SineCosine turn = portable_sine_cosine(angle);
        const DVec2 rim = middle + radii * DVec2(side * turn.sine, -turn.cosine);
        sketch.strokes.push_back(drawn_line(base, base + (rim - base) * random.uniform(0.5, 0.75),
                                            side * random.uniform(0.0, 0.1)));
    }
    sketch.number_strokes();
    return sketch;
}

}  // namespace treerec
