// How far what stands in one picture of a rectified pair is shifted in the other: semi-global matching
// (H. Hirschmueller, "Stereo processing by semiglobal matching and mutual information", PAMI 30, 2008), with
// the census of 9 x 7 pixels as its cost.
#pragma once

#include <vector>

#include "photos/rectify.h"

namespace treerec {

// By pixel of the left picture, its x less that of the same place in the right one, to a part of a pixel; NaN
// where nothing is sure: outside of either picture, without texture, where the way back from the right
// picture ends more than a pixel beside, or in a spot of few pixels. least, most: of the disparities looked
// for, 0 < most - least <= kMostDisparities. Memory: 3 bytes per pixel and disparity.
inline constexpr int kMostDisparities = 256;
std::vector<float> match_rectified(const RectifiedPair& pair, int least, int most);

}  // namespace treerec
