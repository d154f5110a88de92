#include <algorithm>
#include <cmath>

#include "textures/bark_kinds.h"

namespace treerec::bark {

BarkPoint plated(const Place& place, const Plates& plates, const Palette& palette) {
    const DVec2 s = plates.size;
    const Place bent =
        place.moved({0.20 * s.x * place.noise(0.8 * s, 4, 1) + 0.05 * s.x * place.noise(0.15 * s, 3, 2),
                     0.20 * s.y * place.noise(0.7 * s, 4, 3)});
    const texture::Cell plate = bent.cell(s, 4);
    // Fissures along are wide and deep, those across narrower, and some plates still hang together.
    const double along = smoothstep(0.35, 0.85, plate.across);
    const double open =
        mix(0.16, 1.0, along) * mix(0.35, 1.0, smoothstep(-0.3, 0.25, place.noise(1.6 * s, 2, 5)));
    const double wide = plates.width * open * (1.0 + 0.5 * place.noise(0.6 * s, 3, 6));
    const double t = clamp01(plate.border / std::max(wide, 1e-4) - 0.10);
    const double fissure = 1.0 - open * (1.0 - t) * (1.0 - t) * (1.0 + 0.8 * t);
    // Layers, like contour lines: they end in ragged edges, the more of them the nearer to the plate's edge.
    const double dome = smoothstep(0.0, 0.42 * s.x, plate.border);
    const double pile = 2.4 * dome + 2.3 * bent.noise(0.62 * s, 5, 7) + 1.6 * (plate.number - 0.5) + 2.0;
    const double floor = std::floor(pile), rest = pile - floor;
    const double step = floor + smoothstep(0.0, 0.10, rest);
    // A layer's edge lifts a little before it breaks.
    const double lift = (1.0 - smoothstep(0.08, 0.40, rest)) * smoothstep(0.04, 0.12, rest);
    const double fibre = place.noise({0.004, 0.018}, 3, 8), grain = place.noise({0.003, 0.004}, 3, 9);
    const double layer =
        cell_number(static_cast<int>(floor) + 64, static_cast<int>(4096.0 * plate.number), place.seed + 5);

    BarkPoint point;
    const double top = smoothstep(0.2, 0.9, fissure);
    point.height =
        plates.depth * fissure + top * (plates.layer * (step + 0.5 * lift) + 0.0004 * fibre) + 0.0004 * grain;
    DVec3 colour = glm::mix(palette.crack, palette.side, smoothstep(0.05, 0.75, fissure));
    colour = glm::mix(colour, layer < 0.45 ? palette.crest : palette.accent, top * mix(0.25, 0.75, layer));
    // Broken edges are dark below and pale on their rim.
    colour *= 1.0 - 0.30 * top * (1.0 - smoothstep(0.0, 0.10, rest)) + 0.14 * top * lift;
    colour *= 1.0 + 0.16 * (plate.number - 0.5) + 0.20 * grain + 0.14 * fibre +
              0.12 * place.noise({0.12, 0.2}, 3, 10);
    point.colour = colour;
    point.roughness = clamp01(0.90 - 0.10 * top * layer + 0.06 * grain);
    point.cover = place.cover();
    return point;
}

BarkPoint scaly(const Place& place, const Scales& scales, const Palette& palette) {
    const DVec2 s = scales.size;
    const Place bent =
        place.moved({0.12 * s.x * place.noise(0.8 * s, 3, 1), 0.12 * s.y * place.noise(0.8 * s, 3, 2)});
    const Flake upper = bent.flake(s, 0.75, 1.75, 0.40, 10), lower = bent.flake(0.8 * s, 1.0, 2.1, 0.35, 20);
    const bool covered = upper.level > 0.0;
    const Flake& shown = covered ? upper : lower;
    const double layer = covered ? 1.0 + upper.level : lower.level;
    const double body = smoothstep(0.0, 0.12, shown.inside);
    // The lower edge stands off: towards it the scale rises, then it ends. A picture's upper edge is its end
    // below.
    const double curl = scales.curl * smoothstep(-0.2, 0.9, -shown.offset.y);
    const double fibre = place.noise({0.22 * s.x, 0.8 * s.y}, 3, 30),
                 grain = place.noise({0.0028, 0.0035}, 3, 31);

    BarkPoint point;
    point.height = scales.thickness * (layer * 0.8 + body * (0.55 + 0.8 * curl)) +
                   0.08 * scales.thickness * fibre + 0.0004 * grain;
    const double tone = clamp01(0.25 + 0.38 * layer + 0.35 * (shown.number - 0.5));
    DVec3 colour = glm::mix(palette.crack, palette.side, mix(0.25, 1.0, body) * smoothstep(0.0, 0.5, tone));
    colour = glm::mix(colour, palette.crest, body * smoothstep(0.45, 1.0, tone + 0.25 * fibre + 0.2 * curl));
    colour = glm::mix(colour, palette.accent, 0.55 * body * smoothstep(0.62, 0.95, shown.number));
    colour *= 1.0 + 0.22 * grain + 0.12 * fibre + 0.14 * (shown.number - 0.5) +
              0.14 * place.noise({0.1, 0.15}, 3, 32);
    point.colour = colour;
    point.roughness = clamp01(0.90 - 0.08 * body * tone + 0.06 * grain);
    point.cover = place.cover();
    return point;
}

}  // namespace treerec::bark
