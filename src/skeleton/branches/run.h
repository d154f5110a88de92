// The way that a piece of wood runs.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
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

// A link straight aside counts as so many times longer, and once.
inline constexpr double kAsideWeight = 2.5;

// For PointTree::search(): of the points that `may` be linked to, the one that best continues a run: the
// nearest, the farther the further it lies aside; of equals the first.
template <typename May>
struct Straightest {
    const std::vector<Vec3>& points;
    const Run& run;
    float longest;  // squared metres
    May may;
    double least = std::numeric_limits<double>::max();
    uint32_t to = 0;

    bool found() const { return least < std::numeric_limits<double>::max(); }
    // No link costs less than its length.
    float limit() const { return static_cast<float>(std::min<double>(longest, 1.0001 * least * least)); }
    void add(float squared, uint32_t v) {
        if (squared > longest || !may(v)) return;
        const double cost = std::sqrt(squared) * (1.0 + kAsideWeight * run.aside(DVec3(points[v])));
        if (cost > least || (cost == least && v > to)) return;
        least = cost;
        to = v;
    }
};
// Clang before 17 finds no type of an aggregate's arguments by itself.
template <typename May>
Straightest(const std::vector<Vec3>&, const Run&, float, May) -> Straightest<May>;

}  // namespace treerec
