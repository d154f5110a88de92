// Black shapes with smooth edges: triangles drawn as the share of each pixel that they cover.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/vec.h"
#include "mesh/image.h"

namespace treerec {

class SampleMask {
  public:
    static constexpr int kSamples = 4;  // across a pixel and down it

    // In pixels, of either sign of the y axis.
    SampleMask(int width, int height);

    // Covers the samples whose centres lie in the triangle. corners: in samples.
    void fill(const DVec2 (&corners)[3]);
    // Those of them where the picture, of four channels, is at least half opaque. uvs: of the corners, 0..1,
    // v downwards; the picture is laid on flat.
    void fill(const DVec2 (&corners)[3], const Vec2 (&uvs)[3], const Image& cut_out);

    // How many of pixel (x, y)'s kSamples * kSamples are covered.
    int covered(int x, int y) const;

  private:
    // The samples of a row that lie in the triangle, first and last; first > last for none.
    struct Span {
        int first = 0, last = -1;
    };
    Span span_of(const DVec2 (&corners)[3], int row) const;
    Span rows_of(const DVec2 (&corners)[3]) const;
    void set(int row, int begin, int end);

    int width_, height_;  // in samples
    size_t words_;        // of a row
    std::vector<uint64_t> bits_;
};

}  // namespace treerec
