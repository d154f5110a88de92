// From the chance of each cell to be leaf to which are, and what the skeleton should follow. Internal to
// scan/.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/vec.h"
#include "progress.h"
#include "scan/leaves/hidden_branches.h"
#include "scan/leaves/leaf_cells.h"
#include "scan/leaves/leaf_paths.h"
#include "scan/stems/round_stems.h"

namespace treerec {

// The share of leaves under which the chances agree with themselves, by expectation maximisation (Saerens,
// Latinne and Decaestecker 2002). logits: of being leaf at even odds. weights: points by cell.
double find_leaf_share(const std::vector<float>& logits, const std::vector<uint32_t>& weights,
                       const Progress& progress);

// Of logits, under that share of leaves: the most likely one at a trust of 1, the even-handed one at 0.
float leaf_threshold(double share, double trust);

// The logit below which that share of all wood is to be expected. logits: by point. share: of leaves.
float wood_reach(const std::vector<float>& logits, double share, double recall);

// Values by cell, each drawn `times` to its neighbours' mean.
void smooth_over_cells(std::vector<float>& values, int times, const Cells& cells, const Progress& progress);

struct LeafVerdict {
    std::vector<float> logits;  // by cell
    float threshold = 0.0F;
    std::vector<uint8_t> leaf;   // by cell: what lies above it, but for small mistakes
    std::vector<uint8_t> other;  // by cell: 1 for what is none of the tree; empty where there is none
    FollowedBranches followed;
};

// palms: whether one is looked for.
LeafVerdict judge_cells(std::vector<float> logits, float threshold, const Cells& cells,
                        const CellShapes& shapes, const CellPaths& paths, bool palms,
                        const Progress& progress);

// Bark that is seen between leaves is wood, however bushy it looks; what lies around the stems' feet grows by
// itself. points: those that the cells were made of. Of a tree that is no palm.
void keep_stems(const std::vector<RoundStem>& stems, const std::vector<Vec3>& points, const Cells& cells,
                const CellShapes& shapes, const CellPaths& paths, LeafVerdict& verdict,
                const Progress& progress);

}  // namespace treerec
