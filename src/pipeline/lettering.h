// Words in pictures, in letters of our own that are drawn with strokes, at any size.
#pragma once

#include <string_view>

#include "fidelity/picture.h"
#include "mesh/image.h"

namespace treerec {

// size: pixels from the baseline to the top of a capital. Letters, digits and . , : ; - + = % ( ) / _ ' < >
// ?; each other character, of UTF-8, is drawn as a question mark.
double text_width(std::string_view text, double size);

// Onto a picture of three channels, or in grey, of which `color` has the first; what lies outside of it is
// left out. x: of the left end, y: of the baseline, in pixels from the upper left corner.
void draw_text(Image& image, double x, double y, std::string_view text, double size, const Rgb& color);

}  // namespace treerec
