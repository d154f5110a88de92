// Printed square markers in a picture (S. Garrido-Jurado et al., "Automatic generation and detection of
// highly reliable fiducial markers under occlusion", 2014, section 4).
#pragma once

#include <array>
#include <vector>

#include "geometry/vec.h"
#include "photos/grey_pyramid.h"
#include "progress.h"

namespace treerec {

struct FoundMarker {
    int id = 0;
    // Of the black square, in the order upper left, upper right, lower right, lower left of the print,
    // however it lies; in pixels as COLMAP counts: the upper left pixel's middle is (0.5, 0.5).
    std::array<DVec2, 4> corners{};
    int mended = 0;  // cells of the code that were read wrongly

    DVec2 centre() const { return 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]); }
    double mean_side() const;  // pixels
};

struct MarkerOptions {
    int most_pixels = 2048;   // the longer side of the picture that is searched; corners are of the whole one
    double least_side = 9.0;  // pixels of the searched picture: the mean side of a marker that is looked at
};

// The markers that a picture shows, by id, then from left to right; one that is seen from behind or printed
// mirrored is none. Dark squares on anything lighter are looked for by a threshold that follows the light, in
// windows of several sizes; their cells are then read in the whole picture, and the corners are where lines
// meet that are fitted to the edges there. An empty picture has none. Throws Cancelled.
std::vector<FoundMarker> find_markers(const GreyPicture& picture, const MarkerOptions& options = {},
                                      const Progress* progress = nullptr);

}  // namespace treerec
