// A photo's grey levels at its own size and at halves of it (Zhang 2013, 4.2).
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/vec.h"
#include "mesh/image.h"

namespace treerec {

// Rows from the top; the middle of the first pixel is (0, 0).
struct GreyPicture {
    int width = 0;
    int height = 0;
    std::vector<uint8_t> pixels;  // height * width

    GreyPicture() = default;
    GreyPicture(int w, int h)
        : width(w), height(h), pixels(static_cast<size_t>(w) * static_cast<size_t>(h)) {}

    const uint8_t* row(int y) const {
        return pixels.data() + static_cast<size_t>(y) * static_cast<size_t>(width);
    }
    uint8_t* row(int y) { return pixels.data() + static_cast<size_t>(y) * static_cast<size_t>(width); }

    // Whether at() may be asked: a pixel stands on each side, also after rounding to float.
    bool has(double x, double y) const {
        constexpr double kRounding = 0.001;
        return x >= 0.0 && y >= 0.0 && x < width - 1 - kRounding && y < height - 1 - kRounding;
    }
    // Between four pixels.
    float at(float x, float y) const {
        const int left = static_cast<int>(x), top = static_cast<int>(y);
        const float s = x - static_cast<float>(left), t = y - static_cast<float>(top);
        const uint8_t *above = row(top) + left, *below = above + width;
        const float up = static_cast<float>(above[0]) + s * static_cast<float>(above[1] - above[0]);
        const float down = static_cast<float>(below[0]) + s * static_cast<float>(below[1] - below[0]);
        return up + t * (down - up);
    }
};

// Rec. 601's luma of a picture of 1 or 3 channels, so small that its longer side has no more than most_pixels
// (more than 0): each pixel the mean of what it covers.
GreyPicture grey_of(const Image& picture, int most_pixels);

// Smoothed by the binomial 1 4 6 4 1, what is beyond the border as the border.
GreyPicture smoothed(const GreyPicture& picture);

struct GreyPyramid {
    // The first is the picture itself; the next ones are half as wide and high, smoothed before. Pixel (x, y)
    // of level L is the pixel (x, y) 2^L of the picture.
    std::vector<GreyPicture> levels;
    DVec2 to_photo{1.0};  // the photo's pixels in one of the picture's, to the right and down

    // A place in the picture as COLMAP counts in the photo: the middle of the first pixel is (0.5, 0.5).
    DVec2 in_photo(const DVec2& place) const { return (place + 0.5) * to_photo; }
};

// As many levels as keep 24 pixels on the shorter side, five at most, and one at least.
GreyPyramid pyramid_of(const Image& picture, int most_pixels);

}  // namespace treerec
