#include <algorithm>
#include <vector>

#include "error.h"
#include "foliage/leaves.h"
#include "geometry/parallel.h"
#include "textures/texture_noise.h"
#include "textures/textures.h"

namespace treerec {

namespace {

using namespace texture;

// What the bark is like at one point: height 0..1, colour (sRGB), roughness.
struct BarkPoint {
    double height;
    DVec3 colour;
    double roughness;
};

struct BarkColours {
    DVec3 crack;
    DVec3 plate;
    DVec3 crest;
};

BarkColours colours_of(const std::string& preset) {
    if (preset == "oak") return {{0.13, 0.11, 0.09}, {0.40, 0.36, 0.31}, {0.55, 0.51, 0.45}};
    if (preset == "maple") return {{0.16, 0.14, 0.12}, {0.46, 0.42, 0.37}, {0.60, 0.56, 0.50}};
    if (preset == "cherry") return {{0.14, 0.08, 0.06}, {0.38, 0.25, 0.20}, {0.52, 0.37, 0.30}};
    if (preset == "pine") return {{0.16, 0.09, 0.06}, {0.50, 0.33, 0.23}, {0.66, 0.47, 0.35}};
    if (preset == "willow") return {{0.15, 0.13, 0.10}, {0.45, 0.40, 0.32}, {0.60, 0.55, 0.45}};
    if (preset == "apple") return {{0.17, 0.14, 0.12}, {0.44, 0.39, 0.35}, {0.57, 0.53, 0.48}};
    if (preset == "spruce") return {{0.15, 0.10, 0.08}, {0.43, 0.31, 0.25}, {0.56, 0.45, 0.38}};
    if (preset == "ginkgo") return {{0.15, 0.125, 0.105}, {0.435, 0.395, 0.345}, {0.61, 0.575, 0.52}};
    if (preset == "poplar") return {{0.16, 0.145, 0.12}, {0.43, 0.415, 0.36}, {0.58, 0.565, 0.50}};
    if (preset == "palm") return {{0.20, 0.16, 0.12}, {0.50, 0.43, 0.34}, {0.63, 0.56, 0.46}};
    return {{0.14, 0.11, 0.085}, {0.42, 0.35, 0.285}, {0.57, 0.49, 0.405}};
}

// Long interlaced ridges between ragged fissures, with a finer net of cracks and fibres on them; nx ridges
// around, ny up.
BarkPoint fissured(DVec2 p, int nx, int ny, const BarkColours& colours, uint64_t seed) {
    const DVec2 warped =
        p + DVec2(0.060 * fractal(p, 5, 3, 5, seed + 10) + 0.012 * fractal(p, 30, 10, 3, seed + 15),
                  0.09 * fractal(p, 6, 4, 4, seed + 20));
    const Cell plate = cells(warped, nx, ny, seed + 30);
    const Cell flake = cells(warped + DVec2(0.02 * fractal(p, 24, 12, 3, seed + 40), 0.0), 31, 10, seed + 50);
    // Fissures run up the stem; what crosses them is shallow, and both come and go.
    const double presence = smoothstep(-0.30, 0.25, fractal(p, 7, 5, 3, seed + 60) + 0.12);
    const double deep = mix(0.30, 1.0, smoothstep(0.45, 0.9, plate.across)) * mix(0.45, 1.0, presence);
    const double width = 0.10 + 0.26 * deep * (0.8 + 0.5 * noise(p, 9, 6, seed + 65));
    const double fissure = 1.0 - deep * (1.0 - smoothstep(0.0, width, plate.border));
    const double dome = smoothstep(0.0, 0.5, plate.border);
    const double crack = 1.0 - mix(0.3, 1.0, flake.across) * (1.0 - smoothstep(0.0, 0.16, flake.border));
    const double fibre = 1.0 - std::abs(2.0 * fractal(warped, 44, 6, 3, seed + 70));
    const double grain = fractal(p, 80, 40, 3, seed + 80);
    BarkPoint point;
    point.height = clamp01(0.44 * fissure + 0.18 * dome + fissure * (0.17 * crack + 0.14 * fibre) +
                           0.10 * (plate.number - 0.5) * fissure + 0.10 * grain);
    const double tone = 1.0 + 0.14 * (plate.number - 0.5) + 0.16 * (flake.number - 0.5) + 0.45 * grain +
                        0.25 * fractal(p, 3, 2, 4, seed + 90);
    const double body = smoothstep(0.06, 0.70, point.height);
    const double crest = smoothstep(0.62, 0.98, point.height);
    DVec3 colour = glm::mix(colours.crack, colours.plate, body);
    colour = glm::mix(colour, colours.crest, 0.85 * crest);
    // A breath of algae in some places, a warm cast in others.
    const double patch = smoothstep(0.05, 0.45, fractal(p, 3, 4, 4, seed + 110));
    colour = glm::mix(colour, DVec3(0.36, 0.39, 0.25) * (0.5 + body), 0.25 * patch * body);
    const double warm = fractal(p, 4, 3, 3, seed + 130);
    colour *= tone * DVec3(1.0 + 0.05 * warm, 1.0, 1.0 - 0.06 * warm);
    point.colour = colour;
    point.roughness = clamp01(0.94 - 0.16 * crest + 0.08 * grain);
    return point;
}

// Scales that overlap like shingles, nx of them around and ny up: each stands out at its lower edge and runs
// under the one above it. deep: how far the gaps between them go in, 0..1.
BarkPoint scaly(DVec2 p, int nx, int ny, double deep, const BarkColours& colours, uint64_t seed) {
    const DVec2 warped =
        p + DVec2(0.045 * fractal(p, 6, 5, 5, seed + 10) + 0.010 * fractal(p, 26, 22, 3, seed + 15),
                  0.050 * fractal(p, 5, 6, 5, seed + 20));
    const Cell scale = cells(warped, nx, ny, seed + 30);
    const Cell flake =
        cells(warped + DVec2(0.012 * fractal(p, 22, 22, 3, seed + 40)), 2 * nx + 1, 3 * ny, seed + 50);
    // Gaps come and go, so that scales hang together in groups.
    const double presence = smoothstep(-0.25, 0.30, fractal(p, 7, 7, 4, seed + 60));
    const double width = 0.05 + 0.13 * presence;
    const double gap = 1.0 - deep * mix(0.25, 1.0, presence) * (1.0 - smoothstep(0.0, width, scale.border));
    const double edge =
        1.0 - 0.35 * (1.0 - smoothstep(0.0, 0.10, flake.border)) * mix(0.3, 1.0, 1.0 - flake.across);
    const double curl =
        smoothstep(0.05, 0.45, scale.border) * (1.0 - 0.4 * smoothstep(0.3, 0.6, scale.border));
    const double fibre = fractal(warped, 30, 9, 4, seed + 70), grain = fractal(p, 80, 60, 3, seed + 80);
    BarkPoint point;
    point.height = clamp01(gap * edge * (0.50 + 0.16 * curl + 0.24 * (scale.number - 0.4) + 0.16 * fibre) +
                           0.12 * grain);
    const double body = smoothstep(0.02, 0.52, point.height), crest = smoothstep(0.52, 0.90, point.height);
    DVec3 colour = glm::mix(colours.crack, colours.plate, body);
    colour = glm::mix(colour, colours.crest, 0.8 * crest);
    const double lichen = smoothstep(0.05, 0.45, fractal(p, 3, 4, 5, seed + 90)) * body;
    colour = glm::mix(colour, DVec3(0.45, 0.46, 0.40), 0.30 * lichen);
    const double tone = 1.0 + 0.16 * (scale.number - 0.5) + 0.10 * (flake.number - 0.5) + 0.35 * grain +
                        0.30 * fibre + 0.25 * fractal(p, 3, 2, 4, seed + 100);
    point.colour = colour * tone;
    point.roughness = clamp01(0.92 - 0.12 * crest + 0.08 * grain);
    return point;
}

// The rings that fallen fronds leave, with fibres between them.
BarkPoint ringed(DVec2 p, const BarkColours& colours, uint64_t seed) {
    constexpr int kRings = 14;
    const double turn =
        p.y * kRings + 0.9 * fractal(p, 3, 3, 3, seed + 10) + 0.25 * fractal(p, 12, 6, 3, seed + 20);
    const double ring = turn - std::floor(turn);
    // A scar's lip stands out over the ring below it.
    const double lip = smoothstep(0.0, 0.10, ring) * (1.0 - smoothstep(0.16, 0.55, ring));
    const double groove = 1.0 - smoothstep(0.0, 0.07, std::min(ring, 1.0 - ring));
    const double fibre = 1.0 - std::abs(2.0 * fractal(p + DVec2(0.004 * noise(p, 20, 9, seed + 30), 0.0), 70,
                                                      5, 3, seed + 40));
    const double crack = smoothstep(0.32, 0.45, fractal(p, 40, 4, 4, seed + 50));
    const double grain = fractal(p, 60, 60, 3, seed + 60);
    BarkPoint point;
    point.height =
        clamp01(0.40 + 0.26 * lip - 0.34 * groove + 0.16 * (fibre - 0.5) - 0.25 * crack + 0.08 * grain);
    const double body = smoothstep(0.04, 0.50, point.height), crest = smoothstep(0.50, 0.80, point.height);
    DVec3 colour = glm::mix(colours.crack, colours.plate, body);
    colour = glm::mix(colour, colours.crest, 0.75 * crest);
    colour *= 1.0 + 0.35 * grain + 0.22 * fractal(p, 3, 5, 4, seed + 70) + 0.12 * (fibre - 0.5);
    point.colour = colour;
    point.roughness = clamp01(0.92 - 0.10 * crest);
    return point;
}

// White, papery bark with dark lenticels lying across and rough black scars.
BarkPoint birch(DVec2 p, uint64_t seed) {
    const DVec2 warped = p + DVec2(0.02 * fractal(p, 4, 8, 3, seed + 10), 0.012 * fractal(p, 3, 5, 4, seed));
    const double bands = fractal(warped, 3, 22, 4, seed + 20);
    const double grain = fractal(p, 60, 100, 3, seed + 30);
    const Cell slit = cells(warped, 7, 46, seed + 40);
    // A lenticel is the core of some cells, thin because its cell is wide and low.
    const double lenticel = slit.number > 0.55 ? smoothstep(0.24, 0.34, slit.border + 0.1 * grain) : 0.0;
    const double scar_field = fractal(warped, 5, 6, 6, seed + 60);
    const double scar = smoothstep(0.36, 0.45, scar_field);
    const double ridge = scar * (0.5 + 0.5 * fractal(p, 18, 40, 3, seed + 70));
    const double peel = smoothstep(0.0, 0.05, std::abs(bands - 0.18));
    BarkPoint point;
    point.height = clamp01(0.55 + 0.08 * bands + 0.05 * grain - 0.16 * lenticel - 0.12 * scar + 0.45 * ridge -
                           0.10 * (1.0 - peel));
    DVec3 colour = glm::mix(DVec3(0.80, 0.775, 0.735), DVec3(0.885, 0.875, 0.85), 0.5 + bands);
    colour = glm::mix(colour, DVec3(0.74, 0.62, 0.52),
                      0.45 * smoothstep(0.05, 0.35, fractal(p, 2, 6, 4, seed + 80)));
    colour *= 1.0 + 0.12 * grain;
    colour = glm::mix(DVec3(0.58, 0.50, 0.44), colour, 0.45 + 0.55 * peel);
    colour = glm::mix(colour, DVec3(0.25, 0.21, 0.18), 0.85 * lenticel);
    colour = glm::mix(colour, DVec3(0.115, 0.10, 0.09) * (0.8 + ridge), 0.92 * scar);
    point.colour = colour;
    point.roughness = clamp01(0.66 + 0.24 * scar + 0.10 * lenticel + 0.10 * grain);
    return point;
}

// The nearest of marks that are scattered evenly, nx around and ny up.
struct Mark {
    DVec2 offset;   // from it, in its share of the picture
    double number;  // belongs to it, [0, 1)
};

Mark nearest_mark(DVec2 p, int nx, int ny, uint64_t seed) {
    const double x = p.x * nx, y = p.y * ny;
    const int ix = static_cast<int>(std::floor(x)), iy = static_cast<int>(std::floor(y));
    Mark nearest{DVec2(1e9), 0.0};
    for (int i = 0; i < 9; i++) {
        const int cx = ix + i % 3 - 1, cy = iy + i / 3 - 1;
        const int wx = wrap(cx, nx), wy = wrap(cy, ny);
        const DVec2 offset(x - cx - 0.2 - 0.6 * cell_number(wx, wy, seed),
                           y - cy - 0.2 - 0.6 * cell_number(wx, wy, seed + 1));
        if (glm::dot(offset, offset) < glm::dot(nearest.offset, nearest.offset))
            nearest = {offset, cell_number(wx, wy, seed + 2)};
    }
    return nearest;
}

// Smooth and pale, with diamond-shaped lenticels; where it is old it has broken into furrows.
BarkPoint poplar(DVec2 p, const BarkColours& colours, uint64_t seed) {
    const DVec2 warped =
        p + DVec2(0.012 * fractal(p, 6, 8, 3, seed + 210), 0.010 * fractal(p, 7, 6, 3, seed + 220));
    const double grain = fractal(p, 70, 60, 3, seed + 230), cloud = fractal(p, 3, 4, 4, seed + 240);
    const double wrinkle = fractal(warped, 6, 44, 3, seed + 250);
    const Mark mark = nearest_mark(warped, 11, 10, seed + 260);
    // A pit with a lip, some of them run together into a row across.
    const double size = mix(0.10, 0.40, mark.number * mark.number);
    const double rhombus = std::abs(mark.offset.x) / size + std::abs(mark.offset.y) / (1.15 * size);
    const double there = mark.number > 0.22 ? 1.0 : 0.0;
    const double pit = there * (1.0 - smoothstep(0.45, 0.80, rhombus + 0.45 * grain));
    const double lip = there * smoothstep(0.62, 0.90, rhombus) * (1.0 - smoothstep(0.95, 1.45, rhombus));
    BarkPoint point;
    point.height = clamp01(0.52 + 0.05 * wrinkle + 0.05 * grain + 0.10 * cloud + 0.12 * lip - 0.34 * pit);
    DVec3 colour =
        glm::mix(DVec3(0.53, 0.525, 0.465), DVec3(0.735, 0.725, 0.67), clamp01(0.55 + 0.9 * cloud));
    colour = glm::mix(colour, DVec3(0.52, 0.535, 0.42),
                      0.35 * smoothstep(0.0, 0.4, fractal(p, 2, 3, 4, seed + 270)));
    colour *= 1.0 + 0.20 * grain + 0.10 * wrinkle + 0.10 * lip;
    colour = glm::mix(colour, DVec3(0.22, 0.19, 0.155), 0.88 * pit);
    const double old = smoothstep(0.18, 0.30, fractal(warped, 7, 2, 4, seed + 280));
    const BarkPoint furrow = fissured(p, 11, 3, colours, seed);
    point.height = mix(point.height, furrow.height, old);
    point.colour = glm::mix(colour, furrow.colour, old);
    point.roughness = mix(clamp01(0.78 + 0.14 * pit + 0.10 * grain), furrow.roughness, old);
    return point;
}

// Smooth and grey, with small bumps, faint rings and blots of lichen.
BarkPoint pimpled(DVec2 p, uint64_t seed) {
    const DVec2 warped =
        p + DVec2(0.014 * fractal(p, 5, 6, 3, seed + 10), 0.014 * fractal(p, 6, 5, 3, seed + 20));
    const double grain = fractal(p, 80, 80, 3, seed + 30), cloud = fractal(p, 3, 3, 4, seed + 40);
    const double ring = fractal(warped, 3, 30, 4, seed + 50);
    const auto bumps = [&](int nx, int ny, double share, uint64_t own) {
        const Mark mark = nearest_mark(warped, nx, ny, seed + own);
        if (mark.number > share) return 0.0;
        const double size = mix(0.16, 0.40, mark.number / share);
        // A little wider than high, as lenticels are.
        const double away = glm::length(DVec2(mark.offset.x * 0.8, mark.offset.y)) / size;
        return 1.0 - smoothstep(0.25, 1.0, away);
    };
    const double bump = std::max(bumps(16, 15, 0.6, 60), 0.8 * bumps(33, 31, 0.5, 70));
    const double fold = 0.5 * smoothstep(0.20, 0.36, ring);
    BarkPoint point;
    point.height = clamp01(0.42 + 0.34 * bump + 0.10 * cloud + 0.06 * grain - 0.10 * fold);
    DVec3 colour = glm::mix(DVec3(0.47, 0.46, 0.44), DVec3(0.62, 0.61, 0.585), clamp01(0.5 + 0.9 * cloud));
    colour = glm::mix(colour, DVec3(0.56, 0.52, 0.465),
                      0.3 * smoothstep(0.0, 0.4, fractal(p, 4, 3, 4, seed + 80)));
    const double lichen = smoothstep(0.20, 0.30, fractal(p, 6, 7, 5, seed + 90));
    colour = glm::mix(colour, DVec3(0.68, 0.69, 0.63), 0.5 * lichen);
    colour *= 1.0 + 0.20 * grain - 0.16 * fold + 0.16 * bump;
    colour = glm::mix(colour, DVec3(0.50, 0.45, 0.39), 0.6 * bump);
    point.colour = colour;
    point.roughness = clamp01(0.76 + 0.10 * lichen + 0.10 * grain);
    return point;
}

BarkPoint bark_at(const std::string& preset, DVec2 p, const BarkColours& colours, uint64_t seed) {
    if (preset == "birch") return birch(p, seed);
    if (preset == "palm") return ringed(p, colours, seed);
    if (preset == "spruce") return scaly(p, 19, 13, 0.75, colours, seed);
    if (preset == "apple") return scaly(p, 11, 6, 0.65, colours, seed);
    if (preset == "ginkgo") return fissured(p, 9, 2, colours, seed);
    if (preset == "poplar") return poplar(p, colours, seed);
    if (preset == "magnolia") return pimpled(p, seed);
    return fissured(p, 13, 3, colours, seed);
}

}  // namespace

BarkTextures make_bark_textures(const std::string& preset, int size, uint64_t seed) {
    leaf_preset(preset);  // throws for an unknown name
    if (size < 16 || size > 4096) throw Error("A texture's size must be between 16 and 4096 pixels.");
    const BarkColours colours = colours_of(preset);
    // Metres of relief over metres of pixel.
    const double relief = preset == "birch"      ? 0.010
                          : preset == "magnolia" ? 0.008
                          : preset == "ginkgo"   ? 0.027
                                                 : 0.021;
    BarkTextures textures{Image(size, size, 3), Image(size, size, 3), Image(size, size, 3)};
    std::vector<float> height(static_cast<size_t>(size) * size);
    parallel_for(static_cast<size_t>(size), 16, [&](size_t begin, size_t end) {
        for (int y = static_cast<int>(begin); y < static_cast<int>(end); y++) {
            for (int x = 0; x < size; x++) {
                const DVec2 p((x + 0.5) / size, (y + 0.5) / size);
                const BarkPoint point = bark_at(preset, p, colours, seed);
                height[static_cast<size_t>(y) * size + x] = static_cast<float>(point.height);
                for (int c = 0; c < 3; c++)
                    textures.albedo.at(x, y)[c] = to_byte(point.colour[c]);
                textures.roughness.at(x, y)[0] = to_byte(mix(0.35, 1.0, smoothstep(0.05, 0.7, point.height)));
                textures.roughness.at(x, y)[1] = to_byte(point.roughness);
            }
        }
    });
    const auto at = [&](int x, int y) {
        return height[static_cast<size_t>(wrap(y, size)) * size + wrap(x, size)];
    };
    const double steepness = relief * size;
    parallel_for(static_cast<size_t>(size), 32, [&](size_t begin, size_t end) {
        for (int y = static_cast<int>(begin); y < static_cast<int>(end); y++) {
            for (int x = 0; x < size; x++) {
                const double dx = 0.5 * (at(x + 1, y) - at(x - 1, y));
                const double dy = 0.5 * (at(x, y - 1) - at(x, y + 1));  // upwards in the picture
                const DVec3 normal = glm::normalize(DVec3(-dx * steepness, -dy * steepness, 1.0));
                for (int c = 0; c < 3; c++)
                    textures.normal.at(x, y)[c] = to_byte(0.5 + 0.5 * normal[c]);
            }
        }
    });
    return textures;
}

}  // namespace treerec
