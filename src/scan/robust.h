// Order statistics that no stray point upsets. Internal to scan/.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "geometry/quantile.h"
#include "geometry/vec.h"

namespace treerec {

struct Range {
    double low = 0.0;
    double high = 0.0;

    double size() const { return high - low; }
    bool contains(double v) const { return v >= low && v <= high; }
};

// The extent along each axis of the points that are not absurdly far out: beyond the middle 98 % by more than
// twice its width. A trunk much longer than its dense crown stays in.
inline std::array<Range, 3> robust_ranges(std::span<const Vec3> points) {
    std::array<Range, 3> ranges;
    if (points.empty()) return ranges;
    std::vector<float> values(points.size());
    for (int axis = 0; axis < 3; axis++) {
        for (size_t i = 0; i < points.size(); i++)
            values[i] = points[i][axis];
        const double q01 = quantile(values, 0.01);
        const double q99 = quantile(values, 0.99);
        const double reach = 2.0 * (q99 - q01);
        Range range{q01, q99};
        for (const float v : values) {
            if (v < q01 - reach || v > q99 + reach) continue;
            range.low = std::min<double>(range.low, v);
            range.high = std::max<double>(range.high, v);
        }
        ranges[static_cast<size_t>(axis)] = range;
    }
    return ranges;
}

}  // namespace treerec
