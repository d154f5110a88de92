// Seeded variation of a scion, so that no two grafts look the same (Chen 2025, algorithm 6).
#pragma once

#include <cstdint>

#include "tree/tree.h"

namespace treerec {

struct Variation {
    double angle = 0.0;   // degrees, 0..180: what a branch turns and bends by, at most
    double length = 0.0;  // share, 0..0.9: what a branch grows longer or shorter by, at most

    // Every segment by itself, as the paper has it, in place of whole branches.
    bool by_segment = false;

    bool none() const { return angle == 0.0 && length == 0.0; }
};

// Throws Error for values outside these ranges.
void require_variation(const Variation& variation);

// The scion with every branch turned at its fork by up to `angle`, about any axis across it, bent along its
// way by up to `angle` in a smooth arc and by up to half of it in an S, and made longer or shorter by up to
// `length`; what it bears follows. The first branch leaves its root as before. The paper draws anew for each
// segment; on a scan's short segments that only makes them jagged, and evens out. Radii, ids and flags stay.
// The numbers drawn belong to (seed, branch): the same on every platform.
// by_segment: algorithm 6 as printed, in the scion's frame: the yaw atan2(z, x) and the pitch above the level
// of each segment change by up to `angle`, its length by up to the share `length`; the same as if the scion
// was written in the paper's dialect and read with this seed (lsystem/lstring.h).
// Throws Error as require_variation().
Tree vary_scion(const Tree& scion, const Variation& variation, uint64_t seed);

}  // namespace treerec
