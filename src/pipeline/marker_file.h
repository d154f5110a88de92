// A marker to print, as a file.
#pragma once

#include <string>

namespace treerec {

// Throws Error where the name of `path` ends in neither .svg nor .png.
void require_marker_format(const std::string& path);

// Writes a page with the marker (photos/marker_page.h): an SVG in millimetres, or a PNG at 300 dpi, which it
// says of itself, by the name's end. side: of the black square, metres. Throws Error with a sentence.
void write_marker(const std::string& path, int id, double side);

}  // namespace treerec
