// Finds the wood nearest to a point: a bounding-volume hierarchy over a tree's segments.
#pragma once

#include <vector>

#include "geometry/bounds.h"
#include "tree/tree.h"

namespace treerec {

// A segment of wood as a cylinder, the child's radius on its whole length.
struct WoodSegment {
    DVec3 from;
    DVec3 to;
    double radius = 0.0;
    NodeId child = kNoNode;
};

// All segments, in depth-first order of their child nodes.
std::vector<WoodSegment> wood_segments(const Tree& tree);

double distance_to_segment(const DVec3& p, const DVec3& from, const DVec3& to);

class SegmentTree {
  public:
    // O(n log n). Keeps its own copy.
    explicit SegmentTree(std::vector<WoodSegment> segments);

    bool empty() const { return segments_.empty(); }
    const WoodSegment& segment(int32_t index) const { return segments_[index]; }

    struct Hit {
        int32_t segment = -1;  // for segment(); -1 where the tree is empty
        double distance = 0.0;
    };
    // The segment whose axis is nearest to `p`. `hint`: a segment that is probably near (a neighbour's hit),
    // which makes the search faster and changes nothing else but which of equals is returned.
    Hit nearest_axis(const DVec3& p, int32_t hint = -1) const;
    // The smallest |distance to the axis - radius| over all segments. `hint`: likewise, and then the segment
    // that was found.
    double surface_distance(const DVec3& p, int32_t& hint) const;

  private:
    struct Cell {
        Bounds box;  // of the axes
        double least_radius = 0.0;
        double largest_radius = 0.0;
        int32_t begin = 0;  // of segments_
        int32_t end = 0;
        int32_t right = -1;  // second child; the first follows its parent; -1 for a leaf
    };
    int32_t build(int32_t begin, int32_t end);

    std::vector<WoodSegment> segments_;
    std::vector<Cell> cells_;
};

}  // namespace treerec
