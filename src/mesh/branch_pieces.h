// The trunk and the stout branches as few straight pieces: what shapes for a physics engine are made of.
// Internal to mesh/.
#pragma once

#include <vector>

#include "tree/tree.h"

namespace treerec {

// Metres, tree space.
struct BranchPiece {
    DVec3 from;
    DVec3 to;
    double from_radius;
    double to_radius;
    double mean_radius;  // along its length
    NodeId node;         // at the upper end
};

// At most `maximum` of them; wood thinner than minimum_radius is left out. Begins with the trunk as one
// piece. Then goes where most error is left: gives that branch its first piece, or parts a piece in two where
// its wood strays farthest from it by more than the tolerance (all metres). Error is how far the wood is from
// the surface of the shape that stands for it, summed along its length; that of wood without a shape is its
// diameter. tapered: whether that shape is a cone or as thick all along. The trunk's pieces come first, those
// of a branch from its base to its tip.
std::vector<BranchPiece> part_branches(const Tree& tree, int maximum, double minimum_radius, double tolerance,
                                       bool tapered);

}  // namespace treerec
