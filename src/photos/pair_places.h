// What two photos see in common, pixel by pixel.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geometry/vec.h"
#include "photos/rectify.h"
#include "photos/sky_mask.h"

namespace treerec {

// A photo in two sizes: what is matched, and what tells parts of its pixels, which may have no picture.
struct PhotoSizes {
    LoadedPhoto matched;
    LoadedPhoto fine;
};

struct PairPlace {
    DVec3 place{0.0};     // in the model
    double unsure = 0.0;  // what half a pixel of disparity makes of it, in the model's unit
    std::array<uint8_t, 3> colour{};
};

// A place for each pixel that is matched and alike in both (likeness.h), but for the sky (of `one`). least,
// most: how far in front of the photo things may be, in the model's unit.
std::vector<PairPlace> places_of_pair(const PhotoSizes& one, const PhotoSizes& other, const PhotoSky& sky,
                                      double least, double most);

}  // namespace treerec
