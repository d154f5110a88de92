// A cloud reduced to what the cleaners look at. Internal to scan/.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geometry/vec.h"
#include "progress.h"
#include "scan/robust.h"

namespace treerec {

// Representatives in canonical order (by fine cells, then by x, y, z; all distinct), whatever the order of
// the cloud's points.
struct Samples {
    std::vector<Vec3> points;
    std::vector<uint32_t> of_point;  // by point of the cloud
    std::array<Range, 3> ranges;     // robust_ranges() of the cloud
};

// How many samples show each tree of a cloud as well as if it stood alone: 400,000 for each square of ground
// as wide as the cloud is high, but no more than 3 million. positions: metres, Y up.
size_t samples_for(const std::vector<Vec3>& positions, const Progress* progress = nullptr);

// Every distinct point, or one point per grid cell where there would be more than `limit`.
Samples take_samples(const std::vector<Vec3>& positions, size_t limit, const Progress* progress);

// The means of the points in each cell of a grid (metres), which evens out noise of less than a cell: the
// more, the denser the cloud. ranges: robust_ranges() of the points.
Samples average_points(const std::vector<Vec3>& positions, const std::array<Range, 3>& ranges, double cell,
                       const Progress* progress);

// Labels the points by connected component, where points in touching cells (26 neighbours) are connected.
// Labels are 0.. in the order of each component's first point. cell: metres.
// ranges: robust_ranges() of the points or of a cloud that holds them.
std::vector<uint32_t> connected_components(const std::vector<Vec3>& points,
                                           const std::array<Range, 3>& ranges, double cell,
                                           const Progress* progress = nullptr);

}  // namespace treerec
