// Sketches as files: our own JSON, SVG paths, and pictures of a drawing.
#pragma once

#include <string>
#include <string_view>

#include "sketch/strokes.h"

namespace treerec {

// Reads .json, .svg or .png (by what is in it, not by its name alone). The canvas of an SVG is its viewBox; a
// picture's is its own, and its strokes are the drawing thinned to lines (Zhang and Suen 1984, or better), at
// a junction the straightest way on. Strokes are numbered. Throws Error, naming the file and what is wrong.
Sketch read_sketch(const std::string& path);

// who: begins a sentence about it, "'strokes.json'".
Sketch parse_sketch_json(std::string_view text, const std::string& who = "The sketch");
Sketch parse_sketch_svg(std::string_view text, const std::string& who = "The drawing");

// Our own format, version 1; parse_sketch_json() reads back the same sketch.
//   {"format": "treerec sketch", "version": 1, "canvas": [w, h], "height": 8, "species": "maple", "seed": 1,
//    "strokes": [{"id": 1, "role": "auto", "points": [[x, y], ...], "pressure": [p, ...]}, ...]}
// All but format, version and strokes may be missing, of a stroke all but its points.
std::string sketch_json(const Sketch& sketch);

}  // namespace treerec
