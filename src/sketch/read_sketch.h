// Sketches as files: our own JSON, SVG paths, and pictures of a drawing.
#pragma once

#include <string>
#include <string_view>

#include "sketch/sketch.h"

namespace treerec {

// Reads JSON, SVG, PNG, JPEG or BMP (by what is in it, not by its name). A picture's canvas is its own
// pixels, upright; its strokes are the drawing, in any colours on paper of another, thinned to lines (Guo and
// Hall 1989), at a junction the straightest way on: points at even distances, 0.004 of its height or less.
// Throws Error, naming the file and what is wrong.
// options: gets what a JSON tells of them; the rest stays.
Sketch read_sketch(const std::string& path, SketchOptions* options = nullptr);

// Strokes are numbered in all that these give. who: begins a sentence about it, "'strokes.json'".
Sketch parse_sketch_json(std::string_view text, const std::string& who = "The sketch",
                         SketchOptions* options = nullptr);
// SVG 1.1: path, polyline, polygon, line, circle and ellipse with all transforms; what is hidden, or in defs
// and the like, is not there. Curves become lines within 0.25 pixels of a canvas that is kCanvasHeight high,
// their points where they need them and not at even distances; what is closed ends with its first point. The
// canvas is the viewBox, or width and height, or else lies around the drawing. A word 'trunk', 'outline' or
// 'branch' in an element's inkscape:label, id or class, or its group's, is its role.
Sketch parse_sketch_svg(std::string_view text, const std::string& who = "The drawing");

// Our own format, version 1; parse_sketch_json() reads back the same sketch to the last bit, if its strokes
// are numbered. Throws Error where check_sketch() does.
//   {"format": "treerec sketch", "version": 1, "canvas": [w, h], "height": 8, "species": "maple", "seed": 1,
//    "strokes": [{"id": 1, "role": "auto", "points": [[x, y], ...], "pressure": [p, ...]}, ...]}
// All but format, version and strokes may be missing, of a stroke all but its points. Options that are not as
// usual are written as "depth": "paper", "crown": "alpha", "trunk_radius": 0.2 (metres) and "density": 1.5;
// SketchOptions::leaves is not. Twigs of one's own are "twigs": {...} (twig_stock_json()).
std::string sketch_json(const Sketch& sketch, const SketchOptions& options = {});

}  // namespace treerec
