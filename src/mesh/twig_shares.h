// Fewer, wider twigs for coarser levels of detail. Internal to mesh/.
#pragma once

#include <vector>

#include "foliage/crown.h"
#include "tree/branches.h"

namespace treerec {

// By branch: how many twigs like it a twig stands for, and so how many times its width it is drawn; 0 for
// those that are not drawn. What is wider than a little under a pixel, where a level of such coarseness is
// first seen (see mesh/levels.h), is 1: itself. Of thinner ones an even share stays, each side of a branch
// keeps its own, and twigs cover as much of the picture as before. What stays at one coarseness stays at all
// smaller ones, and with a branch all that bears it. coarseness <= 0: all are 1.
std::vector<float> share_twigs(const Tree& tree, const BranchList& list, const Crown& crown,
                               double coarseness);

}  // namespace treerec
