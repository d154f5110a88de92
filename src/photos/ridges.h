// Thin dark or light lines in a photo: what twigs and boughs are against the sky.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/vec.h"
#include "photos/grey_pyramid.h"
#include "progress.h"

namespace treerec {

// A place on the middle of a line.
struct Ridge {
    DVec2 place{0.0};     // pixels; the middle of the first pixel is (0, 0)
    DVec2 way{1.0, 0.0};  // along the line, a unit vector
    double width = 0.0;   // pixels
};

struct RidgeOptions {
    size_t levels = 5;             // of the pyramid: each finds lines twice as wide as the one before
    double least_contrast = 10.0;  // grey levels between a line and both its sides
    double least_bend = 2.5;       // grey levels per pixel squared, across it, after smoothing
    size_t least_points = 10;      // of a line, about a pixel of its level apart
};

// Lines, each a row of places about a pixel of the picture apart. Found where the grey levels'
// second derivative across is largest (C. Steger, "An unbiased detector of curvilinear structures", 1998),
// and then moved to the middle between both edges. A line 1 to 4 pixels of a level wide is found there.
std::vector<std::vector<Ridge>> find_ridges(const GreyPyramid& pyramid, const RidgeOptions& options = {},
                                            const Progress* progress = nullptr);

}  // namespace treerec
