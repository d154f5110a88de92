// What stands in the way of growth and does not yield: fences, stones, walls.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geometry/vec.h"
#include "growth/box_grid.h"
#include "growth/feature.h"

namespace treerec::growth {

// Triangles, metres, tree space; open sheets and wires, too. Of large ones only what bark may come to is
// kept.
class Obstacles {
  public:
    // cell: metres, about as large as the triangles that are asked with. within: where bark may come to.
    Obstacles(double cell, const Box& within) : most_(4.0 * cell), within_(within), grid_(cell) {}

    // What follows belongs to an obstacle of its own, beside which bark swells so. Returns its index.
    int32_t begin(const Lip& lip);
    // Throws Error for corners that are no numbers.
    void add(const DVec3& a, const DVec3& b, const DVec3& c);
    bool empty() const { return triangles_.empty(); }
    const std::vector<std::array<DVec3, 3>>& triangles() const { return triangles_; }
    const std::vector<Lip>& lips() const { return lips_; }
    // The obstacle that a triangle comes nearer to than `gap` metres; -1: none.
    int32_t meets(const DVec3 (&triangle)[3], double gap) const;
    // Metres to what is nearest to the box, at most `reach`; never more than the true distance.
    double distance(const Box& box, double reach) const;

  private:
    const double most_;  // metres: longer edges are cut for the grid
    const Box within_;
    std::vector<Lip> lips_;
    std::vector<int32_t> owners_;  // by triangle
    std::vector<std::array<DVec3, 3>> triangles_;
    std::vector<Box> boxes_;
    BoxGrid grid_;
};

}  // namespace treerec::growth
