// How alike what a pixel shows is in both photos, and nothing else: beside the outline of what stands in
// front, most of a window shows that, and the ground behind gets its disparity, too (foreground fattening).
#pragma once

#include <array>
#include <vector>

#include "photos/rectify.h"

namespace treerec {

struct LikenessOptions {
    int window = 4;         // pixels to each side
    double colour = 30.0;   // grey levels, summed over the channels, by which a neighbour counts e times less
    double distance = 4.0;  // pixels, likewise
    double least_slope = 1;  // grey levels: a smaller standard deviation tells nothing
};

// The correlation of the two pictures' windows, in which a pixel counts by how near it is to the middle one
// and how alike in colour (K.-J. Yoon and I. S. Kweon, "Adaptive support-weight approach for correspondence
// search", PAMI 28, 2006; by correlation: J. L. Schoenberger and others, "Pixelwise view selection for
// unstructured multi-view stereo", 2016).
class Likeness {
  public:
    explicit Likeness(const LikenessOptions& options = {});

    // Of the left picture's pixel (x, y) and its place in the right one: -1..1. 0 where the window leaves
    // a picture or shows nothing.
    double at(const RectifiedPair& pair, int x, int y, float disparity) const;

  private:
    LikenessOptions options_;
    std::vector<double> by_distance_;  // by pixel of the window
    std::array<double, 766> by_colour_{};
};

}  // namespace treerec
