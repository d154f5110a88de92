// How much leaf a crown bears: the area of blades over that of the ground below them. Internal to foliage/.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "foliage/foliage.h"
#include "foliage/leaf_placer.h"

namespace treerec {

// Square metres of blades, one side of them, on a card of size 1.
double blade_area(const LeafRules& rules);

// By how much more leaf a slender crown bears than its ground says, 1 or more: it has light from the sides,
// too.
double light_on(const Crown& crown);

// The ground that a crown covers, in squares: leaves are counted above each by itself, so that what changes
// in one part of a crown leaves the others alone.
class CrownGround {
  public:
    // Half a metre along an edge, or a power of two less on a small tree.
    explicit CrownGround(const Crown& crown);

    double edge() const { return edge_; }
    // x and z are the square's.
    std::array<int64_t, 3> cube_of(const DVec3& p) const;

  private:
    double edge_;
};

// Square metres: of blades, and of the squares of ground below them.
struct LeafBudget {
    double blades = 0.0;
    double ground = 0.0;
};
LeafBudget measure_leaves(const LeafPlacer& placer, const std::vector<const LeafSpot*>& spots);

// Square metres of the ground below a scan's leaves.
double covered_ground(const CrownGround& ground, const Foliage& foliage);

// Takes leaves from above those squares that bear more blades than `index` times their area: first those in
// the shade of others. The spots that stay keep their order.
void thin_to_index(const LeafPlacer& placer, double index, std::vector<const LeafSpot*>& spots);

}  // namespace treerec
