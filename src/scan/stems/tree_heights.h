// Heights as shares of a tree's own. Internal to scan/.
#pragma once

#include <vector>

#include "geometry/quantile.h"
#include "geometry/vec.h"

namespace treerec {

class TreeHeights {
  public:
    // points: at least one; a few stray ones above and below are no matter.
    explicit TreeHeights(const std::vector<Vec3>& points) {
        std::vector<float> values;
        values.reserve(points.size());
        for (const Vec3& p : points)
            values.push_back(p.y);
        low_ = quantile(values, 0.002);
        metres_ = quantile(values, 0.998) - low_;
    }

    static constexpr double kFootTop = 0.15;

    double metres() const { return metres_; }
    double of(const Vec3& p) const { return (p.y - low_) / metres_; }
    // Where wood is always seen.
    bool at_foot(const Vec3& p) const {
        constexpr double kFootLow = 0.02;
        const double h = of(p);
        return h > kFootLow && h < kFootTop;
    }

  private:
    double low_, metres_;
};

}  // namespace treerec
