// Frames along a tube that do not wind about it. Internal to mesh/.
#pragma once

#include <cstddef>

#include "mesh/tube_rings.h"

namespace treerec {

// Parallel transport (rotation-minimising frames): each ring's x is the last one's by the smallest turn that
// takes its normal to this one. rings: from the root.
void parallel_transport(Ring* rings, size_t count);

}  // namespace treerec
