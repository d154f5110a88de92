// Sketches from pictures of a drawing. Internal to sketch/.
#pragma once

#include <string>
#include <string_view>

#include "mesh/image.h"
#include "sketch/strokes.h"

namespace treerec {

// A PNG, JPEG, BMP from its bytes: see read_sketch(). Throws Error. who: the subject of its sentences.
Sketch parse_sketch_picture(std::string_view bytes, const std::string& who);

// The same of its pixels, with 4 channels.
Sketch sketch_of_picture(const Image& picture, const std::string& who);

}  // namespace treerec
