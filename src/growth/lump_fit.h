// Lumps and dents of one branch's unrolled bark. Internal to growth/.
#pragma once

#include <vector>

#include "growth/bark_map.h"
#include "progress.h"

namespace treerec::growth {

// Share of its wood's age after which a proposed burl grows: late, so that it is as wide as it is told to be.
inline constexpr double kLumpFrom = 0.7;

struct Lump {
    double along = 0.0, around = 0.0;  // metres of the axis, 0..1 of a round
    double radius = 0.0, inner = 0.0;  // R and R', metres
    double height = 0.0;               // metres, in the end
};

struct Dent {
    double along = 0.0, around = 0.0;  // of its middle
    double width = 0.0, length = 0.0;  // metres, across and along the branch
    double depth = 0.0;                // metres
};

struct Lumps {
    std::vector<Lump> lumps;  // highest first
    std::vector<Dent> dents;
};

// longest: T_s, metres, below which nothing can be shown. Throws Cancelled.
Lumps fit_lumps(const BarkMap& map, double longest, const Progress* progress);

// The bark without them: lower by its lumps, and not known in its dents.
void take_off(const Lumps& lumps, BarkMap& map);

}  // namespace treerec::growth
