// Which photos are worth tracking into which: neighbours by name, and those that look most alike.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "photos/match_pair.h"
#include "progress.h"

namespace treerec {

struct PhotoPairOptions {
    bool sequence = false;  // only neighbours by name, and the last photos with the first ones, are compared
    size_t steps = 10;      // how far neighbours by name may be apart then
    size_t closing = 10;    // photos at both ends that are compared then
    size_t alike = 8;       // of each photo: so many that look most like it
    size_t corners = 400;   // of a photo, that are compared: the strongest ones
    size_t least = 8;       // patches that two photos share
};

// features: by name. Pairs (i, j) with i < j, in that order; the next one by name is always one. Two
// milliseconds of one core for each comparison. Throws Cancelled.
std::vector<std::pair<size_t, size_t>> choose_photo_pairs(const std::vector<PhotoFeatures>& features,
                                                          const PhotoPairOptions& options,
                                                          Progress* progress = nullptr);

}  // namespace treerec
