// Lines through a node, fitted to the points of voxels (Zhang 2013, 5.3 and 5.4).
#pragma once

#include <cstdint>
#include <vector>

#include "skeleton/flood/flood_grid.h"

namespace treerec {

struct LineFit {
    DVec3 direction{0.0, 1.0, 0.0};  // of unit length
    double length = 0.0;             // metres
    double radius = 0.0;             // metres: mean distance of the points from the line
    double deviation = 0.0;          // metres: mean deviation from that
    size_t points = 0;
};

// The half line from `node` that is nearest to the voxels' points in the sense of least squares: minimizes
// sum |node + t d - p|^2 over d for given t (5.3), then takes each point's projection for its t, twice. Begun
// with the mean direction, so that a short piece of a thick stem does not turn the line across it. The length
// is twice the mean projection (algorithm 7), counted from where the points begin: a side branch's points do
// not begin at the node.
LineFit fit_line(const FloodGrid& grid, const std::vector<Vec3>& points, const DVec3& node,
                 const std::vector<uint32_t>& voxels);

// The distances of points from a line, metres.
struct Ring {
    double mean = 0.0;
    double deviation = 0.0;  // mean, from the mean
    double farthest = 0.0;
    size_t within = 0;  // points nearer than `inner`
};
Ring ring_around(const FloodGrid& grid, const std::vector<Vec3>& points, const DVec3& node,
                 const DVec3& direction, const std::vector<uint32_t>& voxels, double inner = 0.0);

// The circle through the voxels' points, seen along the direction: true, with the middle beside `end` and the
// radius (metres), where they surround it well enough. seed: of the robust fit.
bool surround(const FloodGrid& grid, const std::vector<Vec3>& points, const DVec3& direction,
              const std::vector<uint32_t>& voxels, double most_radius, uint64_t seed, DVec3& end,
              double& radius);

}  // namespace treerec
