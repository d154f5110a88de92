// What a physics engine collides with where capsules are too round: tapered prisms along the trunk and the
// stout branches.
#pragma once

#include <vector>

#include "tree/tree.h"

namespace treerec {

struct ConvexPart {
    std::vector<DVec3> points;  // of the tree's space; all of them are corners of their convex hull
    NodeId node = kNoNode;      // the node at the upper end of its wood
};

struct ConvexOptions {
    int maximum = 32;              // how many at most
    double minimum_radius = 0.03;  // metres; thinner wood is left out
    double tolerance = 0.01;       // metres: wood this near to a part's surface needs no better one
    int sides = 8;                 // of a part: it has twice as many points
    bool trunk_only = false;       // no branches
};

// Parts are chosen as capsules are (mesh/capsules.h), but follow the wood's taper, so that a trunk needs
// fewer. A part's cross-sections have the area of the wood's. Its ends are cut across its axis, so that what
// stands on a cut stands flat. Empty for a lone root. Throws Error for options out of range.
std::vector<ConvexPart> fit_convex_parts(const Tree& tree, const ConvexOptions& options = {});

// The enclosed volume of the hull of a part of fit_convex_parts(), in cubic metres.
double volume_of(const ConvexPart& part);

}  // namespace treerec
