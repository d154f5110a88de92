// Leaves of trees in photos, by their colour beside the stem's.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/vec.h"
#include "progress.h"
#include "scan/point_cloud.h"

namespace treerec {

// By point of a cloud with colours: 1 for what has not the bark's colour, whatever the light and however much
// of the sky a pixel shows beside the wood: green leaves, and yellow and red ones, too. A colour that bark
// and sky can give is a sum of shares of both, so the angle between it and the nearest such sum tells. Points
// are told together with their neighbours. bark: points of the stem, by index; sky: its colour, 0 to 255,
// zeros where it is not known: then it is taken for grey. Empty without colours, or where the bark's own
// colours differ so much that they tell nothing. Throws Cancelled.
std::vector<uint8_t> unlike_bark(const PointCloud& cloud, std::span<const uint32_t> bark, const DVec3& sky,
                                 const Progress* progress = nullptr);

}  // namespace treerec
