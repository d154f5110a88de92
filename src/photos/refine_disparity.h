// The part of a pixel that a census does not know.
#pragma once

#include "photos/rectify.h"

namespace treerec {

struct RefineOptions {
    int window = 2;     // pixels to each side, whose grey levels tell
    int steps = 3;      // of Gauss and Newton
    float most = 1.0F;  // pixels that the disparity was out by
};

// The disparity by which the window around the left picture's pixel (x, y) becomes most alike in both
// pictures, but for a level that all of one picture has more (B. Lucas and T. Kanade, "An iterative image
// registration technique with an application to stereo vision", 1981). `disparity` itself where the window
// has no slope, leaves the picture, or tells of one that is farther away.
float refine_disparity(const RectifiedPair& pair, int x, int y, float disparity,
                       const RefineOptions& options = {});

}  // namespace treerec
