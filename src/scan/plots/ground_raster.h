// The ground of a plot as a raster of heights.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "geometry/vec.h"
#include "scan/robust.h"

namespace treerec {

struct Heightmap {
    size_t width = 0, depth = 0;  // pixels along x and z
    double pixel = 0.0;           // metres
    DVec2 first{0.0};             // x, z: the middle of the first pixel, tree space
    std::vector<float> heights;   // metres, tree space; z * width + x
    double seen = 0.0;            // share of the pixels in which ground is seen; the others lie between those
};

// Gathers points of the ground. Their order is no matter.
class GroundRaster {
  public:
    GroundRaster(const Range& x, const Range& z, double pixel);

    // p: tree space; what lies outside is left out.
    void add(const DVec3& p);
    // Nothing where no ground was seen. Each pixel is the mean of its points' heights; what is not seen is
    // as smooth as what lies around it allows.
    Heightmap finish() const;

  private:
    Heightmap map_;
    Range x_, z_;
    // The heights are summed in whole steps, so that their sum does not depend on the order.
    std::vector<int64_t> sums_;
    std::vector<uint32_t> counts_;
};

}  // namespace treerec
