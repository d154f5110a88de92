// Completes a tree cluster by cluster, as a user would who accepts every proposal.
#pragma once

#include <cstdint>
#include <vector>

#include "completion/complete.h"

namespace treerec {

struct CompleteAllOptions {
    CompleteOptions branch;
    size_t most = 1000;         // proposals that are followed
    size_t least_points = 12;   // of a cluster
    double least_length = 0.0;  // metres: shorter finds are taken back; 0: as skeletonize()'s shortest branch
};

struct CompletedTree {
    std::vector<Completion> branches;  // that stayed, in the order in which they were found
    size_t refused = 0;                // proposals that led to nothing
    double explained_before = 0.0;     // share of the points within 2 cm of the bark
    double explained_after = 0.0;
};

// The largest cluster of unexplained points first (completion/unexplained.h): complete_branch() at its joint,
// towards it. What would run off into nothing, or is shorter than the shortest branch, is taken back. The
// tree is as it was where Cancelled or Error is thrown. wood: as in complete_branch().
CompletedTree complete_all(Tree& tree, const PointCloud& cloud, const CompleteAllOptions& options = {},
                           const std::vector<uint8_t>& wood = {}, Progress* progress = nullptr);

}  // namespace treerec
