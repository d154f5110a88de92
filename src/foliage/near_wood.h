// Finds the branch that a leaf hangs on. Internal to foliage/.
#pragma once

#include <cstdint>
#include <vector>

#include "foliage/branch_axis.h"
#include "tree/branches.h"
#include "tree/tree.h"

namespace treerec {

struct WoodSample {
    AxisPoint at;
    uint32_t branch;  // place in BranchList::branches
};

// Points on the axes of all branches, in a grid over the tree. Metres, tree space.
class NearWood {
  public:
    // reach: how far nearest() looks. slender: thicker wood counts as further away, by twice what it is
    // thicker.
    NearWood(const Tree& tree, const BranchList& list, double reach, double slender, double least);

    // The nearest wood within reach of p, or nullptr. Of two as near, the one that comes first in the tree.
    const WoodSample* nearest(const DVec3& p) const;

  private:
    DVec3 low_{0.0};
    double cell_;
    double reach_;
    double slender_;
    int64_t count_[3] = {0, 0, 0};
    std::vector<uint32_t> begin_;  // by cell, into samples_
    std::vector<WoodSample> samples_;
};

}  // namespace treerec
