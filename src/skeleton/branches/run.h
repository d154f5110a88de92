// The way that a piece of wood runs.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/vec.h"

namespace treerec {

// A line through `middle` along `axis` (unit), or no direction.
struct Run {
    DVec3 middle{0.0};
    DVec3 axis{0.0};
    bool known = false;

    // How far off the line `to` lies, as a share of the way there: 0 straight ahead, 1 straight aside.
    double aside(const DVec3& to) const;
};

// around: indices of points, metres. toward: where the axis is looked for first. Unknown where the points are
// few or no longer than wide.
Run run_of(const std::vector<Vec3>& points, const std::vector<uint32_t>& around, const DVec3& toward);

}  // namespace treerec
