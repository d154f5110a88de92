// How well a tree of photos has the outline that masks say it has.
#pragma once

#include <string>

#include "fidelity/photo_fidelity.h"
#include "fidelity/photo_overlap.h"
#include "pipeline/reconstruct.h"
#include "progress.h"

namespace treerec {

struct OutlineJudgement {
    size_t hold_out = 0;  // every how many photos one was held out; 0: the tree was made of those that judge
    PhotoFidelity cloud;  // of the cleaned points
    OutlineOverlap shapes;  // of the tree, with its leaves
};

// model: the folder of COLMAP's model, in the scan's coordinates. masks: a folder (read_masks()), of the
// photos that were held out, or where none were, of all. rules, textures, seed: of the tree's leaves, as in
// ExportOptions. Throws Error with a sentence, or Cancelled.
OutlineJudgement judge_outline(const Reconstruction& result, const std::string& model,
                               const std::string& masks, size_t hold_out, const LeafRules& rules,
                               const std::string& textures, uint64_t seed, Progress* progress = nullptr);

}  // namespace treerec
