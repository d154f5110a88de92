// A drawn branch, still flat: cleaned, and hung on the wood that its tail falls on.
#pragma once

#include <string>
#include <vector>

#include "sketch/branch_statistics.h"
#include "sketch/sketch_branch.h"

namespace treerec {

// Places that are closer than 3 pixels to the last kept one go, then equation 1 of Ma and Liu 2020 (2.1):
// weights .07 .13 .60 .13 .07, both ends kept. Pixels.
std::vector<DVec2> clean_stroke(const std::vector<DVec2>& points);

// The line every `step` pixels, both ends among the places, with what is shorter than `smooth` pixels evened
// out: at each place the line that fits best around it (local linear regression, Gaussian weights).
std::vector<DVec2> even_stroke(const std::vector<DVec2>& points, double step, double smooth);

// Where a branch may hang.
struct BranchHost {
    NodeId child = kNoNode;  // the upper end of the segment
    NodeId node = kNoNode;   // the end of it that is nearer to where the stroke falls on it
    double depth = 0.0;      // metres before the camera, of the wood there
    bool on = false;         // the stroke falls on it
};

struct HungStroke {
    std::vector<DVec2> points;      // from the tail to the tip, pixels
    std::vector<BranchHost> hosts;  // at least one, the likeliest first; of distinct branches
    std::vector<std::string> remarks;
};

// The tail is the end that lies on wood, or nearer to it in the picture; where both lie on some, the one on
// wood that is clearly thicker, else where the stroke begins. Its host is the segment that it falls on, the
// one in front where several of about the same thickness do; or the nearest within 15 % of the stroke's
// length; other wood so near is told after it, for the points to choose. Wood that is clearly thinner than a
// branch of that length is no host where there is other. What lies beyond the host's axis is cut off, if it
// is the shorter part. Throws Error where there is no wood near.
HungStroke hang_stroke(const Tree& tree, const BranchStatistics& statistics, const BranchStroke& stroke,
                       double jitter, const Progress* progress);

}  // namespace treerec
