// What pictures of leaves are drawn on, and with. Internal to textures/.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/vec.h"
#include "textures/leaf_shapes.h"

namespace treerec::texture {

// Coordinates of the spray: x from -0.5 to 0.5, y from 0 at the lower edge to 1.

struct Leaf {
    DVec2 base;       // of the blade
    DVec2 direction;  // unit, of the midrib
    double length;
    double bend;  // sideways curve of the midrib, over the length
    double brightness;
    double hue;
    double shown = 1.0;  // of its width: the rest is turned away from whoever looks
    double dry = 0.0;    // 0 green .. 1 brown from its margin inwards
    double torn = 0.0;   // what a caterpillar took of its margin, over the length
};

struct Sample {
    float r = 0, g = 0, b = 0, a = 0;
    float relief = 0;  // in spray units
    int16_t leaf = -1;
};

// Where the twig in the middle is at `f` of its way, 0 at the lower edge .. 1 at its end `top`.
DVec2 twig_at(double f, double sway, double top);

// The twig itself, thinner towards its end: half its width at the lower edge and at the end.
void draw_twig(std::vector<Sample>& canvas, int size, const Spray& spray, double sway, double top,
               double wide_base, double wide_end, int pieces);

// A line of the given half width from a to b, over what is there.
void draw_stalk(std::vector<Sample>& canvas, int size, DVec2 a, DVec2 b, double wide_a, double wide_b,
                const DVec3& colour);

// A blade, over what is there, which it shades. index: tells it from the others.
void draw_leaf(std::vector<Sample>& canvas, int size, const Spray& spray, const Leaf& leaf, int16_t index,
               uint64_t seed);

// All that a spray's picture shows. The canvas has size x size samples.
void draw_spray(std::vector<Sample>& canvas, int size, const Spray& spray, uint64_t seed);

}  // namespace treerec::texture
