// The slices' tree as branches - chains from a fork to a tip - without those that are no branches.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "progress.h"
#include "skeleton/branches/slices.h"
#include "skeleton/passes.h"

namespace treerec {

// One chain of slices. A branch grows out of station `attach` of its parent branch.
struct SkeletonBranch {
    int32_t parent = -1;               // index of the parent branch; -1 for the first
    int32_t attach = 0;                // station (index into the parent's `slices`)
    std::vector<int32_t> slices;       // from the base to the tip
    std::vector<int32_t> merged;       // slices that lie across from the branch's own on the same wood
    std::vector<int32_t> merged_at;    // and the station that each of them lies at
    std::vector<int32_t> absorbed;     // slices of side chains that are part of this branch's own surface
    std::vector<int32_t> absorbed_at;  // and the station that each of them lies at
};

struct BranchOptions {
    double minimum_branch = 0.05;  // metres from its parent's axis that a branch must be long
    double least_escape = 0.025;   // metres that it must reach out of its parent's surface
    double widest_loop = 0.25;     // metres: what lies further aside is no bark of its parent
    PassSet left_out;
};

// The shortest branch where the user states none, metres. extent: of the tree, from its root.
inline double automatic_branch(double extent) {
    constexpr double kLeast = 0.05;
    constexpr double kShare = 0.003;
    return std::max(kLeast, kShare * extent);
}

// Splits the tree of slices at its forks; the child with the most wood on its way to a tip continues the
// branch. A side chain that does not reach `minimum_branch` (or, on sparse scans, a few point spacings) out
// of its parent's surface is absorbed by the parent: it is a strip of the parent's own bark, a snag or noise
// (AdTree, Du et al. 2019, 2.3, removes by subtree length instead, which leaves such strips in place). What
// grows on an absorbed chain is tried again as a side branch of the parent. What lies beyond a gap five times
// as long as all the wood behind it is left out as stray. Parents come before children. A side chain that
// leaves its parent and touches it again further on is no branch, for wood has no loops: it is another side
// of the same stem, and is merged with the parent's slices.
std::vector<SkeletonBranch> branches_of_slices(const Slices& slices, const std::vector<Vec3>& points,
                                               const LocalScale& scale, const BranchOptions& options,
                                               const Progress& progress);

}  // namespace treerec
