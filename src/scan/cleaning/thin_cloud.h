// Fewer points of a cloud, to be looked at.
#pragma once

#include <cstddef>

#include "progress.h"
#include "scan/point_cloud.h"

namespace treerec {

// The least number that thin_cloud() may be asked for.
inline constexpr size_t kFewestPoints = 1000;

// Leaves at most `most` points, one to each cell of a grid, as evenly as the cloud allows: each is a scanned
// point with its colour and normal. Which ones does not depend on their order. A cloud that has no more stays
// as it is. Throws Error where `most` is less than kFewestPoints, Cancelled.
void thin_cloud(PointCloud& cloud, size_t most, const Progress* progress = nullptr);

}  // namespace treerec
