// Fewer, wider twigs for coarser levels of detail. Internal to mesh/.
#pragma once

#include <vector>

#include "foliage/crown.h"
#include "tree/branches.h"

namespace treerec {

// What of a picture a branch covers at level 0, on average over the ways one can look and without its side
// branches, in square metres: half its circumference by its length, roughly. A twig has few sides, starts
// within what bears it and runs out in a point; what that costs was measured on grown trees.
double drawn_area(const Tree& tree, const BranchList& list, const Branch& branch);

// By branch: how many times its own drawn_area() it is to cover; 0 for those that are not drawn. What is
// wider than a little under a pixel, where a level of such coarseness is first seen (see mesh/levels.h),
// stays. Of thinner ones, and of short ones, an even share stays, each side of a branch keeps its own, and
// what goes is covered by what stays beside it, or else by what bore it: nothing is lost. What stays at one
// coarseness stays at all smaller ones, and with a branch all that bears it. coarseness <= 0: all are 1.
std::vector<float> share_twigs(const Tree& tree, const BranchList& list, const Crown& crown,
                               double coarseness);

}  // namespace treerec
