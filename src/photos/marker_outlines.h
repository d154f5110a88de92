// Dark four-sided shapes in a picture: what may be a printed marker's black border.
#pragma once

#include <array>
#include <vector>

#include "geometry/vec.h"
#include "photos/grey_pyramid.h"
#include "progress.h"

namespace treerec {

// Corners clockwise as the picture shows them; pixels, from the outer corner of the upper left pixel.
using Outline = std::array<DVec2, 4>;

// Where two lines meet that go through a and c with the directions b and d; nothing for parallel ones.
bool meet(const DVec2& a, const DVec2& b, const DVec2& c, const DVec2& d, DVec2& at);

double mean_side(const Outline& outline);

// Whether it turns clockwise at each corner, by 3 degrees or more.
bool is_convex(const Outline& outline);

// The outlines of connected pixels that are darker than the mean of a window around them, in windows of
// several sizes, as far as four straight lines follow them: a marker may be found several times.
// least_side: pixels. Throws Cancelled.
std::vector<Outline> dark_outlines(const GreyPicture& picture, double least_side,
                                   const Progress* progress = nullptr);

}  // namespace treerec
