// Corners: places that look like no place beside them (C. Harris and M. Stephens, "A combined corner and edge
// detector", 1988).
#pragma once

#include <vector>

#include "geometry/vec.h"
#include "photos/grey_pyramid.h"

namespace treerec {

struct HarrisOptions {
    double k = 0.04;      // of det(M) - k trace(M)^2
    size_t most = 2500;   // corners, the strongest of each part of the picture
    int apart = 3;        // pixels: the strongest within so many
    double least = 15.0;  // response: to the fourth power in grey levels per pixel
    int border = 8;       // pixels without corners along the edges
};

struct Corner {
    DVec2 place{0.0};  // in the picture, to a part of a pixel; the first pixel's middle is (0, 0)
    double response = 0.0;
};

// The strongest first; in every part of the picture about as many as it is large, so that bright leaves
// before the sky do not take those of dark bark. Nothing for a picture that is too small or all alike.
std::vector<Corner> harris_corners(const GreyPicture& picture, const HarrisOptions& options = {});

}  // namespace treerec
