// Points that are half sky.
#pragma once

#include "progress.h"
#include "scan/point_cloud.h"

namespace treerec {

// Leaves out of a cloud with colours the points that are much lighter than those around them, towards the
// sky's grey level: what matching makes of pixels that show part of both, at the edges of leaves. Neither
// green nor dark, they would pass for wood among the leaves. A birch's bark, which is light all around,
// stays. sky: its colour, 0 to 255 (SkyCarver::colour()); zeros where it is not known. How many went. Throws
// Cancelled.
size_t drop_sky_blends(PointCloud& cloud, const DVec3& sky, const Progress* progress = nullptr);

}  // namespace treerec
