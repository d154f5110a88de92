#include <algorithm>
#include <cmath>

#include "textures/bark_kinds.h"

namespace treerec::bark {

BarkPoint ridged(const Place& place, const Ridges& ridges, const Palette& palette) {
    const double s = ridges.spacing;
    // What lies side by side is shifted along the stem: a lattice's rows would show.
    const double shifted = 0.5 * ridges.length * place.noise({3.2 * s, 2.0 * ridges.length}, 2, 15);
    const Place bent = place.moved({0.10 * s * place.noise({0.5 * s, 0.9 * s}, 4, 1),
                                    shifted + 0.3 * s * place.noise({0.6 * s, 0.7 * s}, 3, 2)});
    // Two nets of lines laid over each other run together and part again, as fissures do.
    const Line one = bent.line({s, ridges.length}, 2, 3),
               two = bent.line({1.15 * s, 0.8 * ridges.length}, 2, 4);
    const double coming = smoothstep(-0.25, 0.30, place.noise({2.2 * s, 0.8 * ridges.length}, 2, 5));
    const double second = mix(0.35, 1.0, coming);
    const double wide = ridges.width * (0.75 + 0.5 * place.noise({0.9 * s, 1.6 * s}, 3, 6));
    // A fissure's floor is narrow, its walls are steep below and rounded above.
    const auto wall = [&](double distance, double much) {
        const double t = clamp01(distance / (wide * mix(0.6, 1.0, much)) - 0.12);
        return 1.0 - much * (1.0 - t) * (1.0 - t) * (1.0 + 0.6 * t);
    };
    const double fissure = std::min(wall(one.distance, 1.0), wall(two.distance, second));
    const double from_fissure = std::min(one.distance, two.distance / std::max(second, 0.4));
    // Cracks across, the deeper the wider the ridge has grown.
    const Line cross =
        place.moved({0.0, 0.25 * s * place.noise({0.35 * s, 0.3 * s}, 3, 7)}).line({1.4 * s, 0.5 * s}, 2, 8);
    const double crossing = ridges.blocks *
                            smoothstep(0.15, 0.45, place.noise({1.1 * s, 2.5 * s}, 2, 9) + 0.32) *
                            (1.0 - smoothstep(0.0, 0.0026, cross.distance));
    const double fibre = 1.0 - std::abs(1.8 * bent.noise({0.12 * s, 1.1 * s}, 3, 10));
    // Thin layers break off the crests in steps.
    const double shelf = 2.6 * bent.noise({0.45 * s, 0.8 * s}, 5, 11) + 1.3;
    const double step = std::floor(shelf) + smoothstep(0.0, 0.16, shelf - std::floor(shelf));
    const double grain = place.noise({0.0035, 0.005}, 3, 12);
    const double crest = smoothstep(0.15, 0.95, fissure);

    BarkPoint point;
    point.height =
        ridges.depth * (fissure + 0.22 * smoothstep(0.0, 0.5 * s, from_fissure) - 0.45 * crossing * fissure) +
        crest * (0.0011 * step + ridges.fibre * (fibre - 0.5)) + 0.0005 * grain;
    const double high = smoothstep(0.10, 0.85, fissure - 0.3 * crossing);
    const double bleached =
        smoothstep(0.45, 1.15, fissure + 0.16 * (step - 1.3) + 0.25 * (fibre - 0.5) + 0.30 * grain) *
        (1.0 - 0.7 * crossing);
    DVec3 colour = glm::mix(palette.crack, palette.side, high);
    colour = glm::mix(colour, palette.crest, bleached);
    // Where a layer has just gone, and in fissures that still open, the fresh bark shows.
    const double fresh =
        smoothstep(0.10, 0.50, place.noise({1.6 * s, 3.0 * s}, 4, 13)) * (1.0 - bleached) * high;
    colour = glm::mix(colour, palette.accent, 0.5 * fresh);
    colour *= 1.0 + 0.22 * grain + 0.12 * (fibre - 0.5) + 0.14 * place.noise({0.12, 0.17}, 3, 14);
    point.colour = colour;
    point.roughness = clamp01(0.93 - 0.08 * bleached + 0.06 * grain);
    point.cover = place.cover();
    return point;
}

}  // namespace treerec::bark
