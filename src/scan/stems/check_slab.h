// Slices that were cut out of scans. Internal to scan/.
#pragma once

#include <array>

#include "progress.h"
#include "scan/point_cloud.h"
#include "scan/robust.h"

namespace treerec {

// Throws Error, a sentence, where the cloud is a flat slice through one or more trunks: hardly thick for its
// width, and nearly all of it on sections of round bark that go through from one face to the other, as what
// foresters cut out at breast height. What is made of such a slice has neither a way up nor a size. cloud: in
// the scan's own axes and units. ranges: robust_ranges() of it.
void refuse_slab(const PointCloud& cloud, const std::array<Range, 3>& ranges,
                 const Progress* progress = nullptr);

}  // namespace treerec
