// Photos that judge a tree, again and again while it is edited: by masks of the tree's outline, or where
// there are none, by the sky, which tells what is too much and not what is missing.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "fidelity/photo_fidelity.h"
#include "fidelity/photo_overlap.h"
#include "photos/colmap_model.h"
#include "progress.h"
#include "scan/point_cloud.h"

namespace treerec {

enum class OutlineSource {
    kMasks,  // white is the tree
    kSky,    // what is no sky may be the tree: R_3d and precision are at least as high as with masks
};

class PhotoJudge {
  public:
    // masks: their folder (read_masks()). cloud: R_3d's, in the model's scan coordinates. A mask is in memory
    // only while it is looked at; what is kept has 1024 pixels on its longer side at most. Throws Error as
    // read_masks() and measure_photos() do, or Cancelled.
    static PhotoJudge by_masks(const PhotoModel& model, const std::string& masks, const PointCloud& cloud,
                               Progress* progress = nullptr);

    // photos: the folder of the photos. Photos that can't be read, or in which no sky is sure
    // (photos/sky_mask.h), don't judge. Throws Error where that is so of all, or Cancelled.
    static PhotoJudge by_sky(const PhotoModel& model, const std::string& photos, const PointCloud& cloud,
                             Progress* progress = nullptr);

    OutlineSource source() const { return source_; }
    // I is that of all photos of the model; the rest is of those that judge. By the sky, R_3d is an upper
    // bound.
    const PhotoFidelity& cloud() const { return cloud_; }
    // By the sky recall and IoU are 0: they are not known. Throws Cancelled.
    OutlineOverlap judge(std::span<const OutlinePart> parts, const ScanFrame& frame,
                         const Progress* progress = nullptr) const;
    // Of the photos that judge: 255 where the tree may be.
    std::span<const OutlineMask> masks() const { return masks_; }

  private:
    OutlineSource source_ = OutlineSource::kMasks;
    PhotoFidelity cloud_;
    std::vector<OutlineMask> masks_;
};

// What stands for a judge's source in files and scripts: "masks" or "sky".
const char* outline_source_name(OutlineSource source);

}  // namespace treerec
