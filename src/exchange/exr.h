// OpenEXR pictures of one channel: heights in metres, which 8-bit pictures cannot hold.
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace treerec {

// Rows from the top, one 32-bit float a pixel, in the channel R, which Godot opens as FORMAT_RF (Y would
// become three channels); without compression, scan line by scan line (F. Kainz, R. Bogart, P. Stanczyk,
// "Technical Introduction to OpenEXR", and its file layout). values: width times height of them, finite.
std::string exr_bytes(size_t width, size_t height, std::span<const float> values);

}  // namespace treerec
