// Where thinned lines end, meet and run. Internal to sketch/.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "geometry/vec.h"
#include "sketch/line_mask.h"

namespace treerec {

// A line between two nodes, or a ring.
struct LineEdge {
    static constexpr size_t kNone = static_cast<size_t>(-1);

    std::vector<DVec2> points;                  // pixel by pixel, with those of its nodes
    std::array<size_t, 2> nodes{kNone, kNone};  // at its beginning and end; kNone: a ring
    double length = 0.0;                        // pixels
    bool alive = true;
};

struct LineNode {
    double depth = 0.0;         // of the ink, pixels: half of how wide the line is there
    std::vector<size_t> edges;  // that begin or end here, a loop twice; ends[i]: which end of edges[i]
    std::vector<size_t> ends;
};

struct LineGraph {
    std::vector<LineNode> nodes;
    std::vector<LineEdge> edges;
};

// Of a mask of lines one pixel wide. Without spurs, ends at a junction that are shorter than the line is
// thick; junctions that lie within one another's ink are one. depths: of the mask before it was thinned.
// Throws Error where there are more lines than any drawing has. who: the subject of its sentence.
LineGraph graph_of_lines(const LineMask& thin, const std::vector<float>& depths, const std::string& who);

}  // namespace treerec
