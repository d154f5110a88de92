#include "pipeline/judge_outline.h"

#include "error.h"
#include "photos/colmap_model.h"

namespace treerec {

PhotoJudge photo_judge(const OutlineFolders& folders, size_t hold_out, const PointCloud& cloud,
                       Progress* progress) {
    PhotoModel model = read_photo_model(folders.model, nullptr);
    if (hold_out > 0) model = held_out(model, hold_out);
    if (model.photos.empty()) {
        if (hold_out == 0) throw Error("The COLMAP model in '" + folders.model + "' has no photos.");
        throw Error("Every " + std::to_string(hold_out) +
                    "th photo was to judge the tree, but there are fewer of them.");
    }
    if (!folders.masks.empty()) return PhotoJudge::by_masks(model, folders.masks, cloud, progress);
    return PhotoJudge::by_sky(model, folders.photos, cloud, progress);
}

// Both lists are in the photos' order.
std::vector<JudgedPhoto> judged_photos(const OutlineJudgement& judgement) {
    std::vector<JudgedPhoto> photos;
    size_t next = 0;
    for (const PhotoHits& hits : judgement.cloud.photos) {
        photos.push_back({&hits, nullptr});
        if (next < judgement.shapes.photos.size() && judgement.shapes.photos[next].name == hits.name)
            photos.back().overlap = &judgement.shapes.photos[next++].overlap;
    }
    return photos;
}

OutlineJudgement judge_outline(const Reconstruction& result, const OutlineFolders& folders, size_t hold_out,
                               std::span<const OutlinePart> parts, Progress* progress) {
    const PhotoJudge judge = photo_judge(folders, hold_out, result.cloud, progress);
    return {hold_out, judge.source(), judge.cloud(), judge.judge(parts, result.tree.frame(), progress)};
}

}  // namespace treerec
