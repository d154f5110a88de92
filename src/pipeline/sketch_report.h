// What is told about a tree that was made of strokes.
#pragma once

#include <span>
#include <string>

#include "fidelity/photo_overlap.h"
#include "progress.h"
#include "sketch/sketch.h"

namespace treerec {

// How well a sketched tree fills the outline that was drawn: its leaves' cards with their holes and its wood,
// above the crown's base, seen from the front without perspective, against the filled outline.
struct CrownOverlap {
    Overlap overlap;
    double outside = 0.0;     // share of what is seen of the tree that lies outside the outline
    double side_width = 0.0;  // metres of the crown, seen from the side, and from the front
    double front_width = 0.0;
};

// rows: pixels of the outline's height. parts: outline_parts() of the tree. Throws Cancelled.
CrownOverlap measure_crown_overlap(const SketchedTree& sketched, const Sketch& sketch,
                                   std::span<const OutlinePart> parts, int rows = 512,
                                   const Progress* progress = nullptr);

// JSON, UTF-8, numbers finite or null. Keys:
//   format_version 1, version, species, seed, metres_per_pixel, base [x y] (canvas pixels)
//   strokes [{stroke (from 1), role, repairs [name], attach [x y] (canvas pixels) or null, fault (or ""),
//   left_out}], remarks [sentence]
//   nodes, tips, height_m, crown_radius_m, crown_base_m, length_m
//   crown {iou, recall, precision, outside, side_width_m, front_width_m}, where it was measured
std::string sketch_report_json(const Sketch& sketch, const SketchedTree& sketched,
                               const CrownOverlap* overlap = nullptr);

}  // namespace treerec
