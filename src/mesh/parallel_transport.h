// Frames along a tube that do not wind about it. Internal to mesh/.
#pragma once

#include <cstddef>

#include "mesh/tube_rings.h"

namespace treerec {

// Parallel transport (rotation-minimising frames): each ring's x is the last one's by the smallest turn that
// takes its normal to this one. rings: from the root; turn: radians that the first one's is turned by.
void parallel_transport(Ring* rings, size_t count, double turn = 0.0);

}  // namespace treerec
