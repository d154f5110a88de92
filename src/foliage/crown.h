// The rough shape of a whole tree: what sways, what the sky sees, which way is outward.
#pragma once

#include "geometry/vec.h"
#include "tree/tree.h"

namespace treerec {

// An ellipsoid about the tips, and the height that sway is measured along. Metres, tree space.
struct Crown {
    DVec3 centre{0.0};
    DVec3 radii{1.0};         // half axes; x = z
    double ground = 0.0;      // the root's y
    double height = 1.0;      // from the root to the highest node; positive
    double coordinate = 1.0;  // the largest coordinate of the tree, by magnitude: the scale of float errors

    // 0 at the root, 1 at the top: the channel COLOR.r of design.md.
    double sway(const DVec3& p) const;
    // 1 in the open .. 0 at the crown's centre.
    double openness(const DVec3& p) const;
    // Unit: out of the crown's surface at p, up where p is its centre.
    DVec3 outward(const DVec3& p) const;
};

// Precondition: the tree is not empty.
Crown measure_crown(const Tree& tree);

// 0..1: the wind's phase of the branch that ends at `tip` (COLOR.b of design.md).
double branch_phase(NodeId tip);

}  // namespace treerec
