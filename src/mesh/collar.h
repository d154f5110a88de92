// The collar of a stout branch: its first vertices lie on its parent's bark, and a curved web leads from
// there to its own. Internal to mesh/.
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/tube_rings.h"
#include "mesh/uneven_section.h"

namespace treerec {

// A tube as it is drawn: a prism through framed rings.
struct TubeShape {
    const Ring* rings = nullptr;
    size_t count = 0;  // two or more
    uint32_t sides = 0;
    const UnevenSection* section = nullptr;
};

// One vertex. Metres, tree space.
struct CollarVertex {
    DVec3 position;
    DVec3 normal;
    DVec3 tangent;      // unit, along +u
    double around;      // rounds of the branch whose picture this vertex has; not always 0 .. 1
    double v;           // metres along the branch whose bark's picture this vertex has
    double along;       // metres from the branch's start
    double radius;      // of the wood, which gives the picture its scale
    double own;         // 0 on the parent's bark .. 1 where the branch has its own light
    DVec3 host_centre;  // the nearest place on the parent's axis,
    double host_along;  // and how far along that is
};

// Rows of vertices, each of the columns of the branch's tube: first the base, on the parent's bark; then
// twice the same places, once with the picture of the branch's bark and once with the parent's; then on along
// the branch, up to a whole ring of it. Faces join row 0 to 2, 1 to 3, 3 to 4 and so on.
struct Collar {
    uint32_t rows = 0;       // 0: there is none
    uint32_t next_ring = 0;  // the branch's first ring after it
};

// Appends the rows to `out`. host_span: about which of the host's rings the branch starts;
// fine: more rows on thick wood. No collar where
// the branch does not come out of the host's bark all round, or has not the room for it. A corner's base lies
// within the host, by about a hundredth of its radius.
Collar make_collar(const TubeShape& branch, const TubeShape& host, size_t host_span, bool fine,
                   std::vector<CollarVertex>& out);

}  // namespace treerec
