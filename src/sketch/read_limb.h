// Limbs drawn over a scan, as a file.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "geometry/scan_frame.h"
#include "sketch/limb.h"

namespace treerec {

// {"format": "treerec limb", "version": 1, "space": "scan",
//  "camera": {"position": [x, y, z], "right": [x, y, z], "up": [x, y, z], "focal": pixels,
//             "size": [w, h], "principal": [x, y]},
//  "strokes": [{"points": [[x, y], ...]}, ...]}
// space: "scan" (where it is missing, too): position, right and up in the scan's own coordinates, axes and
// units; "tree": in the tree's space, metres, Y up. right and up are directions of the picture; up is made
// square to right. principal: where the view's axis falls, pixels from the upper left corner; the picture's
// middle where it is missing. Each stroke is one limb. frame: the tree's. who: begins a sentence about it,
// "'limb.json'". Throws Error, naming what is wrong.
std::vector<LimbStroke> parse_limb_json(std::string_view text, const ScanFrame& frame,
                                        const std::string& who = "The limb");
std::vector<LimbStroke> read_limb(const std::string& path, const ScanFrame& frame);
// Whether the file says that it is one. Throws Error where there is no such file.
bool is_limb_file(const std::string& path);

// Of strokes from one camera, in tree space; parse_limb_json() reads back the same. Precondition: not empty.
std::string limb_json(const std::vector<LimbStroke>& strokes);

}  // namespace treerec
