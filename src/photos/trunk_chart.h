// The clear part of a trunk, unrolled to a plane.
#pragma once

#include <optional>
#include <vector>

#include "geometry/vec.h"
#include "tree/tree.h"

namespace treerec {

// A section of the stem, in the tree's space (metres, Y up).
struct ChartRing {
    DVec3 centre{0.0};
    double radius = 0.0;          // metres
    double along = 0.0;           // metres along the axis from the clear part's lower end
    DVec3 ahead{0.0};             // unit vector along the stem, towards its tip
    DVec3 side{0.0}, other{0.0};  // unit vectors across it; side x other = ahead
    double slope = 0.0;           // how much the radius grows per metre along
};

// Without root flare and stout branches. Metres are true both ways: rows go along the stem, the uppermost
// first, columns around it, to the right as one sees them from outside, as far as a quarter of a round beyond
// a whole one, so that a piece of the chart may lie anywhere on the stem.
class TrunkChart {
  public:
    struct Spot {
        DVec3 place{0.0};
        DVec3 normal{0.0};  // unit vector, outwards
    };

    double length() const { return rings_.empty() ? 0.0 : rings_.back().along; }
    double mean_radius() const;
    double width() const { return 2.0 * half_width_; }  // metres
    // The bark at so many metres along the stem from the lower end of the clear part, and around it from the
    // middle of the chart; nothing for what is beyond the chart.
    std::optional<Spot> at(double around, double along) const;
    // How far outside of the bark a place is, metres; of the nearest end's stem for one above or below.
    double beside(const DVec3& place) const;
    // Nodes on the stem, from the root on.
    const std::vector<NodeId>& stem() const { return stem_; }

  private:
    friend TrunkChart chart_trunk(const Tree& tree, double longest);

    std::vector<ChartRing> rings_;  // from below, at least two, or none
    std::vector<NodeId> stem_;
    double half_width_ = 0.0;
};

// Of the tree's trunk (main_child() from the root on): begins above the root flare, ends below the first
// branch of two fifths of the stem's radius, or where the stem is half as thick as at its base, or `longest`
// metres further. Empty for a tree without such a stem.
TrunkChart chart_trunk(const Tree& tree, double longest);

}  // namespace treerec
