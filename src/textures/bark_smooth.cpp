#include <algorithm>
#include <cmath>

#include "textures/bark_kinds.h"

namespace treerec::bark {

BarkPoint smooth(const Place& place, const Skin& skin, const Palette& palette, const DVec3& lenticel) {
    const Place bent = place.moved({0.0, 0.0018 * place.noise({0.03, 0.03}, 3, 1)});
    const double rough = 0.5 * place.noise({0.0035, 0.0025}, 3, 2);
    const double mark = bent.lens(skin.spacing, skin.least, skin.most, skin.share, 3);
    const double core = smoothstep(0.10, 0.45, mark + rough * smoothstep(0.0, 0.1, mark));
    const double fine = place.noise({0.002, 0.0022}, 3, 4);
    const double cloud = place.noise({0.09, 0.11}, 4, 5);
    const double band = place.noise({0.30, 0.020}, 4, 6);
    // What growth tears: short fissures along the stem, some of them healed.
    const Line tear = place.moved({0.003 * place.noise({0.02, 0.03}, 3, 7), 0.0}).line({0.016, 0.09}, 2, 8);
    const double torn = skin.stretch * smoothstep(0.0, 0.4, place.noise({0.05, 0.12}, 3, 9) + 0.12) *
                        (1.0 - smoothstep(0.0004, 0.0026, tear.distance));
    const double wrinkle = place.noise({0.05, 0.0045}, 3, 10);

    BarkPoint point;
    point.height = skin.lip * core - 0.0016 * torn + 0.00012 * fine + 0.00035 * wrinkle * (0.4 + skin.bands) +
                   0.0012 * cloud;
    DVec3 colour =
        glm::mix(palette.side, palette.crest, clamp01(0.5 + 0.9 * cloud + skin.bands * 1.0 * band));
    colour = glm::mix(colour, palette.accent, 0.55 * smoothstep(0.05, 0.5, place.noise({0.06, 0.14}, 4, 11)));
    colour *= 1.0 + 0.14 * fine + 0.10 * wrinkle;
    colour = glm::mix(colour, palette.crack, 0.8 * torn);
    colour = glm::mix(colour, lenticel * (1.0 + 0.3 * rough), 0.85 * core);
    point.colour = colour;
    point.roughness = clamp01(mix(0.82, 0.5, skin.gloss) + 0.25 * core + 0.2 * torn + 0.08 * fine);
    point.cover = place.cover();
    return point;
}

BarkPoint birch(const Place& place, bool young) {
    const Place bent =
        place.moved({0.010 * place.noise({0.10, 0.12}, 3, 1), 0.004 * place.noise({0.08, 0.05}, 4, 2)});
    const double fine = place.noise({0.0025, 0.002}, 3, 3);
    const double cloud = place.noise({0.16, 0.10}, 4, 4);
    const double band = bent.noise({0.30, 0.014}, 4, 5);
    // Sheets of the skin end along lines across the stem and roll back from there.
    const double pile = 1.5 * bent.noise({0.20, 0.035}, 4, 6) + 4.0;
    const double rest = pile - std::floor(pile);
    const double edge = smoothstep(0.0, 0.03, rest), roll = edge * (1.0 - smoothstep(0.04, 0.22, rest));
    const double mark = std::max(bent.lens({0.055, 0.020}, {0.006, 0.0012}, {0.050, 0.0034}, 0.75, 7),
                                 bent.lens({0.022, 0.012}, {0.002, 0.0008}, {0.010, 0.0018}, 0.6, 8));
    const double slit = smoothstep(0.05, 0.35, mark + 0.3 * fine * smoothstep(0.0, 0.1, mark));

    BarkPoint point;
    point.height =
        0.0006 * edge + 0.0008 * roll - 0.0005 * slit + 0.0002 * band + 0.0010 * cloud + 0.00008 * fine;
    if (young) {
        DVec3 copper = glm::mix(DVec3(0.42, 0.29, 0.22), DVec3(0.60, 0.46, 0.36),
                                clamp01(0.5 + 0.8 * band + 0.5 * cloud));
        copper = glm::mix(copper, DVec3(0.80, 0.74, 0.67),
                          0.7 * smoothstep(0.08, 0.30, cloud + 0.5 * band) * edge);
        point.colour = glm::mix(copper, DVec3(0.76, 0.68, 0.58), 0.8 * slit) * (1.0 + 0.10 * fine);
        point.roughness = clamp01(0.58 + 0.2 * slit + 0.08 * fine);
        point.cover = place.cover();
        return point;
    }
    DVec3 colour = glm::mix(DVec3(0.73, 0.705, 0.665), DVec3(0.84, 0.83, 0.80),
                            clamp01(0.55 + 0.7 * band + 0.4 * cloud));
    // The bark below a sheet is pink and tan where it is fresh.
    colour = glm::mix(colour, DVec3(0.79, 0.66, 0.54),
                      0.6 * smoothstep(0.02, 0.4, place.noise({0.14, 0.05}, 4, 9)));
    colour = glm::mix(DVec3(0.52, 0.44, 0.37), colour, mix(0.35, 1.0, edge)) * (1.0 + 0.05 * roll);
    colour = glm::mix(colour, DVec3(0.30, 0.26, 0.22), 0.88 * slit);
    // Black corky scars: rhombs where the skin has burst, rough inside.
    const double ragged = 0.8 * place.noise({0.02, 0.012}, 4, 10);
    const double burst = std::max(place.lens({0.17, 0.15}, {0.03, 0.02}, {0.17, 0.11}, 0.7, 11),
                                  place.lens({0.09, 0.11}, {0.015, 0.008}, {0.06, 0.022}, 0.5, 12));
    const double scar = smoothstep(0.10, 0.30, burst + ragged * smoothstep(0.0, 0.25, burst));
    const double cork = 0.5 + 0.8 * place.noise({0.014, 0.030}, 4, 13);
    const Line cracked = place.line({0.018, 0.045}, 3, 14);
    const double crack = 1.0 - smoothstep(0.0, 0.003, cracked.distance);
    point.height += scar * (0.004 * cork - 0.004 * crack);
    const DVec3 corky =
        glm::mix(DVec3(0.245, 0.225, 0.205), DVec3(0.42, 0.39, 0.35), clamp01(cork * cork - 0.4 * crack));
    colour *= 1.0 + 0.07 * fine;
    // Its rim is stained.
    colour = glm::mix(colour, DVec3(0.62, 0.56, 0.49), 0.5 * smoothstep(0.0, 0.12, burst) * (1.0 - scar));
    point.colour = glm::mix(colour, corky, 0.95 * scar);
    point.roughness = clamp01(0.66 + 0.26 * scar + 0.12 * slit + 0.08 * fine);
    point.cover = place.cover();
    return point;
}

BarkPoint pimpled(const Place& place, const Palette& palette) {
    const Place bent =
        place.moved({0.008 * place.noise({0.10, 0.10}, 3, 1), 0.008 * place.noise({0.10, 0.10}, 3, 2)});
    const double fine = place.noise({0.004, 0.004}, 3, 3), cloud = place.noise({0.14, 0.16}, 4, 4);
    const double bump = std::max(bent.lens({0.022, 0.024}, {0.006, 0.004}, {0.016, 0.011}, 0.6, 5),
                                 0.8 * bent.lens({0.012, 0.013}, {0.003, 0.002}, {0.007, 0.005}, 0.5, 6));
    const double knob = smoothstep(0.0, 0.8, bump);
    const double fold = smoothstep(0.12, 0.32, bent.noise({0.30, 0.026}, 4, 7));
    BarkPoint point;
    point.height = 0.0030 * knob - 0.0014 * fold + 0.0030 * cloud + 0.0003 * fine;
    DVec3 colour = glm::mix(palette.side, palette.crest, clamp01(0.5 + 0.9 * cloud));
    colour = glm::mix(colour, palette.accent, 0.4 * smoothstep(0.0, 0.4, place.noise({0.12, 0.2}, 4, 8)));
    colour *= 1.0 + 0.16 * fine;
    colour = glm::mix(colour, palette.crack, 0.45 * fold);
    colour = glm::mix(colour, DVec3(0.50, 0.45, 0.39), 0.55 * knob);
    point.colour = colour;
    point.roughness = clamp01(0.80 + 0.08 * knob + 0.08 * fine);
    point.cover = place.cover();
    return point;
}

BarkPoint ringed(const Place& place, const Palette& palette) {
    constexpr double kRing = 1.0 / 14.0;
    const double turn = place.at.y * std::round(place.metres.y / kRing) +
                        0.45 * place.noise({0.2, 0.3}, 3, 1) + 0.16 * place.noise({0.05, 0.16}, 3, 2);
    const double ring = turn - std::floor(turn);
    // A scar's lip stands out over the ring below it.
    const double lip = smoothstep(0.0, 0.10, ring) * (1.0 - smoothstep(0.16, 0.55, ring));
    const double groove = 1.0 - smoothstep(0.0, 0.07, std::min(ring, 1.0 - ring));
    const Place bent = place.moved({0.002 * place.noise({0.03, 0.11}, 2, 3), 0.0});
    const double fibre = 1.0 - std::abs(1.8 * bent.noise({0.007, 0.20}, 3, 4));
    const Line split = bent.line({0.03, 0.16}, 2, 5);
    const double crack = (1.0 - smoothstep(0.0004, 0.0030, split.distance)) *
                         smoothstep(-0.1, 0.3, place.noise({0.08, 0.2}, 2, 6));
    const double grain = place.noise({0.005, 0.006}, 3, 7);
    BarkPoint point;
    point.height = 0.007 * lip - 0.006 * groove + 0.0016 * (fibre - 0.5) - 0.005 * crack + 0.0006 * grain;
    const double high = smoothstep(-0.006, 0.001, point.height),
                 crest = smoothstep(0.0, 0.0075, point.height);
    DVec3 colour = glm::mix(palette.crack, palette.side, high);
    colour = glm::mix(colour, palette.crest, 0.75 * crest);
    colour = glm::mix(colour, palette.accent, 0.4 * smoothstep(0.0, 0.4, place.noise({0.2, 0.15}, 4, 8)));
    colour *= 1.0 + 0.22 * grain + 0.12 * (fibre - 0.5);
    point.colour = colour;
    point.roughness = clamp01(0.92 - 0.10 * crest);
    point.cover = place.cover();
    return point;
}

}  // namespace treerec::bark
