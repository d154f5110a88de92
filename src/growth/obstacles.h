// What stands in the way of growth and does not yield: fences, stones, walls.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geometry/vec.h"
#include "growth/box_grid.h"

namespace treerec::growth {

// Triangles, metres, tree space; open sheets and wires, too.
class Obstacles {
  public:
    // cell: metres, about as large as the triangles that are asked with.
    explicit Obstacles(double cell) : grid_(cell) {}

    void add(const DVec3& a, const DVec3& b, const DVec3& c);
    bool empty() const { return triangles_.empty(); }
    const std::vector<std::array<DVec3, 3>>& triangles() const { return triangles_; }
    // Whether a triangle comes nearer than `gap` metres.
    bool meets(const DVec3 (&triangle)[3], double gap) const;
    // Metres to what is nearest to the box, at most `reach`; never more than the true distance.
    double distance(const Box& box, double reach) const;

  private:
    std::vector<std::array<DVec3, 3>> triangles_;
    std::vector<Box> boxes_;
    BoxGrid grid_;
};

}  // namespace treerec::growth
