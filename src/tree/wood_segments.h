// A tree's wood as segments.
#pragma once

#include <vector>

#include "geometry/capsule_tree.h"
#include "tree/tree.h"

namespace treerec {

// All segments, in depth-first order of their child nodes.
std::vector<WoodSegment> wood_segments(const Tree& tree);

}  // namespace treerec
