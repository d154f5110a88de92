// The lines of a picture of a drawing, as pixels. Internal to sketch/.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "mesh/image.h"

namespace treerec {

// Where there is ink: 1, else 0; rows from the top.
struct LineMask {
    int width = 0;
    int height = 0;
    std::vector<uint8_t> ink;

    LineMask(int w, int h) : width(w), height(h), ink(static_cast<size_t>(w) * static_cast<size_t>(h), 0) {}

    size_t place(int x, int y) const {
        return static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x);
    }
    bool at(int x, int y) const {
        return x >= 0 && y >= 0 && x < width && y < height && ink[place(x, y)] != 0;
    }
};

// What differs from the paper around it, whatever the colours: dark on light, light on dark; or, where most
// of the picture is transparent, what is not. Split by the threshold of Otsu (1979). picture: 4 channels.
// Throws Error where there is nothing, or no lines but areas. who: the subject of its sentences.
LineMask ink_of(const Image& picture, const std::string& who);

// How far each pixel of ink is from the nearest one without, in pixels (chamfer distance: Borgefors 1986, by
// steps of 3 and 4, within 6 %); 0 elsewhere. What is outside of the picture counts as ink.
std::vector<float> depths_of(const LineMask& mask);

// About how wide the lines are, in pixels, by the depths of their ink.
double line_width(const LineMask& mask, const std::vector<float>& depths);

// How long a line is at least, and what is smaller is a speck: pixels.
double speck_size(const LineMask& mask, double width);

// Takes away specks, and fills holes that are smaller than the lines are wide.
void clean_mask(LineMask& mask, double width);

// Thins lines to one pixel: Guo and Hall 1989, 'Parallel thinning with two-subiteration algorithms', A1.
void thin_mask(LineMask& mask);

}  // namespace treerec
