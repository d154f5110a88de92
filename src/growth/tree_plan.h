// How the surface comes to grow into a given tree. Internal to growth/.
#pragma once

#include <vector>

#include "growth/plan.h"
#include "tree/branches.h"
#include "tree/tree.h"

namespace treerec::growth {

struct TreePlan {
    GrowthPlan plan;
    std::vector<int32_t> branch_of;  // by branch of the plan: the one of BranchList
    std::vector<double> covered;     // by branch of BranchList: metres along its axis; 0: none of it
};

// Age goes by thickness: with one S_c for all wood (Mizoguchi and Miyata 2014 has one for a tree) what is
// twice as thick is twice as old, so an axis's tip is where it is thin when there is as little time left.
// Branches whose radius is under `shortest` (T_m, metres) where they begin stay tubes (Mizoguchi and Miyata
// 2014, 5.3), and those that are covered are so up to where they become thinner. steps: 0 for as many as the
// tree needs. Throws Error for a tree with nothing to cover.
TreePlan plan_tree(const Tree& tree, const BranchList& list, double longest, double shortest, int steps);

}  // namespace treerec::growth
