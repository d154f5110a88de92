// How a tree's outline agrees with masks, as text. Internal to cli/.
#pragma once

#include <cstdio>

#include "fidelity/photo_overlap.h"

namespace treerec {

inline void print_outline(const OutlineOverlap& outline) {
    std::printf("outline in %zu photos: recall %.3f, precision %.3f, intersection over union %.3f\n",
                outline.photos.size(), outline.mean.recall, outline.mean.precision, outline.mean.iou);
}

}  // namespace treerec
