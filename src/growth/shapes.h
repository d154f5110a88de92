// Obstacles and regions as triangles, counter-clockwise from outside; metres. Internal to growth/.
#pragma once

#include <array>
#include <vector>

#include "geometry/vec.h"

namespace treerec::growth {

using Triangles = std::vector<std::array<DVec3, 3>>;

// A closed prism about the way from a to b, whose sides lie at cos * x + sin * y. x, y: as long as its half
// axes.
Triangles prism(const DVec3& a, const DVec3& b, const DVec3& x, const DVec3& y, int sides);
// x, y, z: half edges, right-handed.
Triangles box(const DVec3& middle, const DVec3& x, const DVec3& y, const DVec3& z);
// One open sheet; x, y: half edges.
Triangles sheet(const DVec3& middle, const DVec3& x, const DVec3& y);
// axis: unit, of the ring; radius: to the middle of what is `thick` metres thick.
Triangles torus(const DVec3& middle, const DVec3& axis, double radius, double thick);

}  // namespace treerec::growth
