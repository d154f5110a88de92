// Which branch a place in the crown belongs to (Ma and Liu 2020, 3.2, equation 3).
#pragma once

#include <cstddef>
#include <vector>

#include "sketch/crown_bound.h"
#include "sketch/crown_sections.h"
#include "sketch/sketch_axes.h"

namespace treerec {

class AxisCells : public CrownBound {
  public:
    // Each line is a branch of its own; a place belongs to the nearest, of equal ones to the first.
    // The crown must outlive it.
    AxisCells(const CrownSections& crown, const std::vector<std::vector<DVec3>>& lines);

    size_t nearest(const DVec3& p) const;
    double reach(const DVec3& from, const DVec3& way, size_t axis, double step, double margin) const override;

  private:
    bool within(const DVec3& p, size_t axis, double margin) const;

    struct Part {
        DVec3 a, b;
    };
    struct Ball {
        DVec3 centre;
        double radius;
    };
    const CrownSections& crown_;
    std::vector<std::vector<Part>> parts_;
    std::vector<Ball> balls_;
};

}  // namespace treerec
