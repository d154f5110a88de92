// Finds the wood nearest to a point: a bounding-volume hierarchy over its segments.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "geometry/bounds.h"
#include "geometry/vec.h"

namespace treerec {

// A segment of wood as a cylinder, the child's radius on its whole length. `from_radius` is the parent's, for
// the solid of two balls and a frustum that Zhang 2013 (7.3) makes of it.
struct WoodSegment {
    DVec3 from;
    DVec3 to;
    double radius = 0.0;
    int32_t child = -1;  // the node at its end
    double from_radius = 0.0;
};

double distance_to_segment(const DVec3& p, const DVec3& from, const DVec3& to);

// Distance to the axis - radius: metres, negative inside the cylinder (with round ends).
double bark_error(const WoodSegment& segment, const DVec3& p);

// Whether p lies in the ball of either end or in the frustum between them, or at most `tolerance` metres
// outside of them (Zhang 2013, 7.3).
bool solid_holds(const WoodSegment& segment, const DVec3& p, double tolerance);

// The bark nearest to a point.
struct BarkHit {
    int32_t child = -1;
    double error = std::numeric_limits<double>::infinity();  // bark_error()
    int32_t segment = -1;                                    // of the tree that found it
};

class CapsuleTree {
  public:
    // O(n log n). Keeps its own copy.
    explicit CapsuleTree(std::vector<WoodSegment> segments);

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
    // Replaces `best` where bark is nearer to p than it (the smallest |error|), or as near and of a child
    // with a smaller id, so that what is found depends on p and the segments alone.
    void find_bark(const DVec3& p, BarkHit& best) const;
    // A segment whose solid holds p within the tolerance, or -1. `hint`: one that probably does, or -1.
    int32_t find_solid(const DVec3& p, double tolerance, int32_t hint = -1) const;

  private:
    struct Cell {
        Bounds box;  // of the axes
        double least_radius = 0.0;
        double largest_radius = 0.0;
        double largest_end = 0.0;  // likewise, the parents' radii too
        int32_t begin = 0;         // of segments_
        int32_t end = 0;
        int32_t right = -1;  // second child; the first follows its parent; -1 for a leaf
    };
    struct Key {
        double along;  // twice the middle's coordinate
        int32_t segment;
    };
    int32_t build(int32_t begin, int32_t end, std::vector<Key>& keys);

    std::vector<WoodSegment> segments_;
    std::vector<Cell> cells_;
};

}  // namespace treerec
