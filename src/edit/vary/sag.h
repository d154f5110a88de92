// Branches that bend under their weight.
#pragma once

#include <vector>

#include "tree/tree.h"

namespace treerec {

struct SagOptions {
    // How much of the wood's own weight is added; the scanned tree carries its own already. Less than zero
    // takes weight off: branches rise.
    double weight = 1.0;
    double load = 0.0;       // kg per metre of wood: leaves, fruit, snow
    double density = 900.0;  // kg per cubic metre, of green wood
    double stiffness = 8e9;  // Pa: the modulus of elasticity
    int steps = 8;  // the weight is added in so many parts, since what bends has less leverage; 1..100
};

// Every segment that ends in one of `nodes` turns, with all that grows from it, by the bending of a beam
// under what it bears: moment times length over E I, where I = pi r^4 / 4. No wood bends past straight down
// (or up). Lengths and radii stay. Linear in the nodes times the steps. Throws Misfit for an unknown node,
// Error for values that are not finite or out of range. Returns the nodes that moved, in depth-first order.
std::vector<NodeId> sag(Tree& tree, const std::vector<NodeId>& nodes, const SagOptions& options = {});

}  // namespace treerec
