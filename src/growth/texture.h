// Where on its branch a vertex is (papers/001, 9). Internal to growth/.
#pragma once

#include <vector>

#include "geometry/vec.h"
#include "growth/plan.h"

namespace treerec::growth {

// Cylindrical coordinates about a branch's axis, whose zero goes along it without turning (parallel
// transport).
class BranchCoordinates {
  public:
    explicit BranchCoordinates(const GrowthBranch& branch);

    // 0..1 of a round about the axis at `along` metres.
    double around(const DVec3& place, double along) const;
    // Unit: from the axis at `along` metres to where around() is `round`.
    DVec3 direction(double along, double round) const;

  private:
    void frame(double along, DVec3& centre, DVec3& x, DVec3& y) const;

    const GrowthBranch& branch_;
    std::vector<DVec3> x_;  // by place of the axis: unit, across it
};

}  // namespace treerec::growth
