// Wood drawn without an engine, for small pictures: several samples per pixel, the nearest wins.
#pragma once

#include <cmath>
#include <limits>
#include <vector>

#include "geometry/vec.h"
#include "mesh/image.h"

namespace treerec {

class SampleCanvas {
  public:
    static constexpr int kOver = 3;  // samples per pixel and axis

    // Samples from the upper left corner, y downwards; z towards the eye.
    struct Ball {
        DVec3 place;
        double radius;
    };

    // A square of `size` pixels, with nothing on it.
    explicit SampleCanvas(int size)
        : size_(size), samples_(static_cast<size_t>(size) * size * kOver * kOver) {}

    int side() const { return size_ * kOver; }
    // Round wood between two ends. Colours here: 0..255 each. Lit from above, the left and the eye.
    void draw_wood(const Ball& p, const Ball& q, const DVec3& color);
    // Four channels; transparent where there is nothing.
    Image finish() const;

  private:
    struct Sample {
        double depth = -std::numeric_limits<double>::infinity();
        DVec3 color{0.0};
    };

    int size_;
    std::vector<Sample> samples_;
};

}  // namespace treerec
