// How well a tree of photos has the outline that they show.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fidelity/photo_fidelity.h"
#include "fidelity/photo_judge.h"
#include "fidelity/photo_overlap.h"
#include "pipeline/reconstruct.h"
#include "progress.h"

namespace treerec {

struct OutlineJudgement {
    size_t hold_out = 0;  // every how many photos one was held out; 0: the tree was made of those that judge
    OutlineSource source = OutlineSource::kMasks;
    PhotoFidelity cloud;    // of the cleaned points
    OutlineOverlap shapes;  // of the tree, with its leaves; by the sky precision alone
};

// What one photo says of both.
struct JudgedPhoto {
    const PhotoHits* hits = nullptr;   // of the cloud's points
    const Overlap* overlap = nullptr;  // of the tree's outline; null where the mask is black
};
// In the photos' order.
std::vector<JudgedPhoto> judged_photos(const OutlineJudgement& judgement);

// Where what judges is.
struct OutlineFolders {
    std::string model;   // COLMAP's, in the scan's coordinates
    std::string masks;   // read_masks(); empty: the sky of the photos judges
    std::string photos;  // only needed without masks
};

// The photos of a model that judge: those that were held out, or where none were (hold_out 0), all. cloud: in
// the model's scan coordinates. Throws Error with a sentence, or Cancelled.
PhotoJudge photo_judge(const OutlineFolders& folders, size_t hold_out, const PointCloud& cloud,
                       Progress* progress = nullptr);

// parts: of the tree (outline_parts()). Throws as photo_judge() does.
OutlineJudgement judge_outline(const Reconstruction& result, const OutlineFolders& folders, size_t hold_out,
                               std::span<const OutlinePart> parts, Progress* progress = nullptr);

}  // namespace treerec
