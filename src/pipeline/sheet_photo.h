// A photo of a tree, cut to the tree. Internal to pipeline/.
#pragma once

#include <optional>
#include <vector>

#include "photos/colmap_model.h"
#include "photos/pinhole_view.h"
#include "pipeline/sheets.h"

namespace treerec {

struct CutPhoto {
    Photo photo;
    PinholeView view;   // of the part that is shown, as large as the picture
    double away = 0.0;  // metres from the camera to the tree
    Image picture;
};

// The photo that shows most of the tree, and one that shows it from the side, 50 to 130 degrees further
// around, each in a picture that fits into this size. Nothing for those that there are none of; photos that
// can't be read are passed over. Where a judge is given, photos that judge.
std::vector<CutPhoto> front_and_side(const SheetSubject& subject, const PhotoJudge* judge, size_t most,
                                     int width, int height, const Progress* progress);

// The photo, pale, with the tree's parts on it: green where mask and tree agree, red where the mask alone
// has something, blue where the tree alone has; without a mask orange.
Image outline_panel(const CutPhoto& photo, std::span<const OutlinePart> parts, const PhotoJudge* judge,
                    const Progress* progress);

}  // namespace treerec
