// What a physics engine collides with: few capsules along the trunk and the stout branches.
#pragma once

#include <vector>

#include "tree/tree.h"

namespace treerec {

// The points within `radius` metres of the segment between two points of the tree's space.
struct Capsule {
    DVec3 from{0.0};
    DVec3 to{0.0};
    double radius = 0.0;
    NodeId node = kNoNode;  // the node at the upper end of its wood
};

struct CapsuleOptions {
    int maximum = 32;              // how many at most
    double minimum_radius = 0.03;  // metres; thinner wood is left out
    double tolerance = 0.01;       // metres: wood this near to a capsule's surface needs no better one
};

// Begins with the trunk as one capsule. Then, while there are fewer than the maximum, goes where most error
// is left: gives that branch its first capsule, or parts that capsule in two where its wood strays farthest
// from it. The error of wood is its distance from the capsule's surface, summed along its length; that of
// wood without a capsule is its diameter. The trunk's capsules come first, those of a branch from its base to
// its tip. Empty for a lone root. Throws Error for options out of range.
std::vector<Capsule> fit_capsules(const Tree& tree, const CapsuleOptions& options = {});

}  // namespace treerec
