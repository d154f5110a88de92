// A tree over the photos that it was made of, so that one sees at once whether it lies on them.
#pragma once

#include <string>

#include "mesh/image.h"
#include "photos/colmap_model.h"
#include "progress.h"
#include "tree/tree.h"

namespace treerec {

struct CompareSheetOptions {
    size_t photos = 4;  // as far from each other as they were taken
    int longest = 640;  // pixels of a photo's longer side
};

// Two rows of photos without their lens's distortion, each beside itself, darkened, with the wood drawn on it
// where its camera would see it; three channels. The tree's scan coordinates are the model's. folder: of the
// photos, by their names in the model. Photos that can't be read are passed over. Throws Error where none can
// be, or Cancelled.
Image compare_sheet(const Tree& tree, const PhotoModel& model, const std::string& folder,
                    const CompareSheetOptions& options = {}, const Progress* progress = nullptr);

}  // namespace treerec
