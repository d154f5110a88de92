// How a tree's wood weighs and turns when it falls.
#pragma once

#include "geometry/vec.h"
#include "tree/tree.h"

namespace treerec {

struct WoodMass {
    double mass = 0.0;   // kg
    DVec3 centre{0.0};   // of mass, metres, tree space
    DVec3 inertia{0.0};  // kg m^2 about the centre, around each of the axes
    DVec3 axes[3] = {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};  // principal: unit, right-handed
};

// Of all segments as cone frusta, each turning like a cylinder of its mean square radius. density: kg per
// cubic metre. The volume is that of measure(). The axes are those of the inertia tensor (its eigenvectors,
// by Jacobi's rotations), nearest to x, y and z in this order. A lone root weighs nothing. Throws Error for a
// density that is not positive.
WoodMass weigh_wood(const Tree& tree, double density);

}  // namespace treerec
