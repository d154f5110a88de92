// Order statistics that no stray point upsets. Internal to scan/.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "geometry/quantile.h"
#include "geometry/vec.h"
#include "progress.h"

namespace treerec {

struct Range {
    double low = 0.0;
    double high = 0.0;

    double size() const { return high - low; }
    bool contains(double v) const { return v >= low && v <= high; }
};

// About `wanted` of the points, or all of them where they are few: chosen by their own coordinates, so that
// their order does not matter.
std::vector<Vec3> some_of(std::span<const Vec3> points, size_t wanted, const Progress* progress = nullptr);

// The extent along each axis of the points that are not absurdly far out: beyond the middle 98 % by more than
// twice its width. A trunk much longer than its dense crown stays in. points: finite.
std::array<Range, 3> robust_ranges(std::span<const Vec3> points, const Progress* progress = nullptr);

}  // namespace treerec
