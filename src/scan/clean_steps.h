// The steps of clean_cloud(), each on sample points in canonical order. Internal to scan/.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/vec.h"
#include "progress.h"

namespace treerec {

// All take points in metres, Y up, and return one flag per point: 1 where it should go.

// Points whose mean distance to their k nearest neighbours is beyond the median of all points by `deviations`
// robust standard deviations (1.4826 x the median absolute deviation), and stands out among its neighbours
// too: a sparse twig is thin everywhere and stays (papers/000, 3.2.1, made local). spacing: gets the mean
// distance that 95 % of the points stay under.
std::vector<uint8_t> find_outliers(const std::vector<Vec3>& points, int k, double deviations, double& spacing,
                                   const Progress* progress);

// Small clusters far from the rest. spacing: as from find_outliers().
std::vector<uint8_t> find_fragments(const std::vector<Vec3>& points, double spacing);

// The ground around the stem, where there is any: a wide, thin, well filled layer with a slope below 35
// degrees that has nothing under it. The stem's foot stays.
std::vector<uint8_t> find_ground(const std::vector<Vec3>& points);

}  // namespace treerec
