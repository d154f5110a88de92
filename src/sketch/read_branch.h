// Branches drawn over a scan, as a file.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "geometry/scan_frame.h"
#include "sketch/sketch_branch.h"

namespace treerec {

// {"format": "treerec branch", "version": 1, "space": "scan",
//  "camera": {"position": [x, y, z], "right": [x, y, z], "up": [x, y, z], "focal": pixels,
//             "size": [w, h], "principal": [x, y]},
//  "strokes": [{"points": [[x, y], ...]}, ...]}
// space: "scan" (where it is missing, too): position, right and up in the scan's own coordinates, axes and
// units; "tree": in the tree's space, metres, Y up. right and up are directions of the picture; up is made
// square to right. principal: where the view's axis falls, pixels from the upper left corner; the picture's
// middle where it is missing. "treerec limb" is the format's old name. Each stroke is one branch. frame: the
// tree's. who: begins a sentence about it,
// "'branch.json'". Throws Error, naming what is wrong.
std::vector<BranchStroke> parse_branch_json(std::string_view text, const ScanFrame& frame,
                                            const std::string& who = "The branch");
std::vector<BranchStroke> read_branch_strokes(const std::string& path, const ScanFrame& frame);
// Whether the file says that it is one. Throws Error where there is no such file.
bool is_branch_file(const std::string& path);

// Of strokes from one camera, in tree space; parse_branch_json() reads back the same. Precondition: not
// empty.
std::string branch_json(const std::vector<BranchStroke>& strokes);

}  // namespace treerec
