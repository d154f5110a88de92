#include "pipeline/judge_outline.h"

#include "error.h"
#include "photos/colmap_model.h"

namespace treerec {

namespace {

constexpr int kLongest = 1024;  // pixels of a picture's longer side

}  // namespace

OutlineJudgement judge_outline(const Reconstruction& result, const std::string& model,
                               const std::string& masks, size_t hold_out, const LeafRules& rules,
                               const std::string& textures, uint64_t seed, Progress* progress) {
    PhotoModel photos = read_photo_model(model, progress);
    if (hold_out > 0) photos = held_out(photos, hold_out);
    if (photos.photos.empty())
        throw Error("Every " + std::to_string(hold_out) +
                    "th photo was to judge the tree, but there are fewer of them.");
    const std::vector<Image> pictures = read_masks(masks, photos, progress);
    OutlineJudgement judgement;
    judgement.hold_out = hold_out;
    judgement.cloud = measure_photos(result.cloud, photos, pictures, kInformationRatio, progress);
    const std::vector<OutlinePart> parts =
        outline_parts(result.tree, rules, textures, seed, result.foliage, progress);
    judgement.shapes = measure_overlap(parts, result.tree.frame(), photos, pictures, kLongest, progress);
    return judgement;
}

}  // namespace treerec
