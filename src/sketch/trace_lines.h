// Thinned lines as polylines. Internal to sketch/.
#pragma once

#include <string>
#include <vector>

#include "geometry/vec.h"
#include "sketch/line_mask.h"

namespace treerec {

struct TracedLine {
    std::vector<DVec2> points;  // pixels, a pixel's middle at .5; of a closed line the last is the first
    bool closed = false;
};

// The lines of a thinned mask; where lines meet, the straightest ways go on as one, and a line across the
// one with the lowest end (the trunk) that reaches far to both sides is two. A large loop that leaves a place
// and comes back to it is one closed line. The longest first. An open line begins at the trunk, else where it
// meets another, else at its lower end. depths: of the mask before it was thinned. spacing: between points,
// pixels. shortest: a line that is shorter, in pixels, is none. Throws Error for more lines than a drawing
// has. who: the subject of its sentence.
std::vector<TracedLine> trace_lines(const LineMask& thin, const std::vector<float>& depths, double spacing,
                                    double shortest, const std::string& who);

}  // namespace treerec
