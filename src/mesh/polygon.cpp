#include "mesh/polygon.h"

#include <array>

#include "geometry/portable_math.h"

namespace treerec {

namespace {

// Where a polygon's corners begin, all polygons standing one after another.
constexpr size_t first(uint32_t sides) {
    return sides * (sides + 1) / 2 - 6;
}

// A tree has thousands of tubes, of a few kinds.
struct Polygons {
    std::array<DVec2, first(kMostSides + 1)> corners;
    std::array<double, kMostSides + 1> flat{};

    Polygons() {
        for (uint32_t sides = 3; sides <= kMostSides; sides++) {
            flat[sides] = portable::cos(kPi / sides);
            for (uint32_t j = 0; j <= sides; j++) {
                const SineCosine turn = portable_sine_cosine(2.0 * kPi * (j % sides) / sides);
                corners[first(sides) + j] = {turn.cosine, turn.sine};
            }
        }
    }
};

const Polygons& polygons() {
    static const Polygons all;
    return all;
}

}  // namespace

const DVec2* polygon(uint32_t sides) {
    return polygons().corners.data() + first(sides);
}

double polygon_flat(uint32_t sides) {
    return polygons().flat[sides];
}

}  // namespace treerec
