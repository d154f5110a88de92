// Where on its branch a vertex is (Mizoguchi and Miyata 2014, 9). Internal to growth/.
#pragma once

#include <vector>

#include "geometry/vec.h"
#include "growth/plan.h"

namespace treerec::growth {

// Cylindrical coordinates about a branch's axis, whose zero goes along it without turning (parallel
// transport).
class BranchCoordinates {
  public:
    // twist: radians a metre, by which the grain winds about it.
    explicit BranchCoordinates(const GrowthBranch& branch, double twist = 0.0);

    // 0..1 of a round about the axis at `along` metres, from where the grain that began at 0 has come to.
    double around(const DVec3& place, double along) const;
    // Unit: from the axis at `along` metres `round` rounds on, whatever the grain.
    DVec3 direction(double along, double round) const;

  private:
    void frame(double along, DVec3& centre, DVec3& x, DVec3& y) const;

    const GrowthBranch& branch_;
    const double twist_;
    std::vector<DVec3> x_;  // by place of the axis: unit, across it
};

}  // namespace treerec::growth
