// How true a reconstruction is to its scan and its photos, judged and in pictures.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "foliage/leaves.h"
#include "mesh/image.h"
#include "pipeline/judge_outline.h"
#include "pipeline/reconstruct.h"
#include "progress.h"

namespace treerec {

struct ShowOptions {
    std::string name;                           // the sheets' title
    LeafRules leaves = leaf_preset("generic");  // as in ExportOptions
    std::string textures = "generic";
    uint64_t seed = 1;
    std::optional<OutlineFolders> photos = {};  // of a tree of photos, in the scan's coordinates
    size_t hold_out = 0;
    bool stages = true;  // which sheets are drawn
    bool fidelity = true;
};

struct ShownFidelity {
    std::optional<OutlineJudgement> outline;
    double skeleton = 0.0;                  // R_s, of the cloud's wood
    std::string lacks;                      // a sentence: why photos don't judge, where there are some
    std::optional<Image> stages, fidelity;  // stages_sheet() and fidelity_sheet()
};

// That photos can't judge is no reason to fail. Throws Error for a tree without wood or a model that can't be
// read, or Cancelled.
ShownFidelity show_fidelity(const Reconstruction& result, const ShowOptions& options,
                            Progress* progress = nullptr);

// tree_picture() of it: a small part of the work. Of the options only leaves, textures and seed matter.
Image show_tree(const Reconstruction& result, const ShowOptions& options, Progress* progress = nullptr);

}  // namespace treerec
