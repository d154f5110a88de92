// A seamless piece of bark in metres, and what its height fields are made of.
#pragma once

#include "geometry/vec.h"
#include "textures/texture_noise.h"

namespace treerec::bark {

using texture::cell_number;
using texture::clamp01;
using texture::mix;
using texture::smoothstep;
using texture::wrap;

// What the bark is like at one point.
struct BarkPoint {
    double height = 0.0;  // metres above the deepest cracks' floor or so; any origin will do
    DVec3 colour{0.5};    // sRGB, 0..1
    double roughness = 0.9;
    double cover =
        0.5;  // 0..1: where lichen begins (low) and moss (high); half of the bark lies on each side
};

// Distance to the nearest line of a net, and what its two sides are called.
struct Line {
    double distance;  // metres
    double side;      // of the noise, less that value
};

// The topmost of overlapping flakes.
struct Flake {
    double level = 0.0;   // 0 (there is none) .. 1 (the topmost)
    double inside = 0.0;  // 0 at its edge, 1 in its middle
    double number = 0.0;  // belongs to it, [0, 1)
    DVec2 offset{0.0};    // from its middle, in its half sizes
};

// A point of a piece of bark that repeats both ways. Sizes are metres, around and along.
struct Place {
    DVec2 at;      // 0..1
    DVec2 metres;  // of the piece
    uint64_t seed;

    Place moved(DVec2 by) const { return {at + by / metres, metres, seed}; }

    // Gradient noise (Perlin, "Improving Noise", 2002), octaves twice as fine and half as strong; about
    // -1..1.
    double noise(DVec2 size, int octaves, uint64_t salt) const;
    // Where such noise has one value: sinuous lines that close, fork and run together where it is stretched.
    Line line(DVec2 size, int octaves, uint64_t salt) const;
    // Worley's cells; the border's distance is in metres.
    texture::Cell cell(DVec2 size, uint64_t salt) const;
    // share: of the lattice's places that have one. ragged: how far edges stray, in half sizes.
    Flake flake(DVec2 size, double share, double overlap, double ragged, uint64_t salt) const;
    // 1 in the middle of the lens-shaped mark that lies here, 0 outside: lenticels.
    double lens(DVec2 spacing, DVec2 least, DVec2 most, double share, uint64_t salt) const;
    // What BarkPoint::cover says, with round blots of lichen.
    double cover() const;

  private:
    glm::ivec2 lattice(DVec2 size) const;
};

}  // namespace treerec::bark
