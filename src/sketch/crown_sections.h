// The crown's shape in depth, from its outline (Ma and Liu 2020, 3.2).
//
// At every height the outline's width becomes a section through the crown: a circle over it, or, as printed,
// a square. An outline that has several widths at a height, as a cloud's, has a section over each.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/vec.h"

namespace treerec {

class CrownSections {
  public:
    struct Section {
        double left, right;  // x, metres
    };

    // outline: a simple polygon, metres, x to the right, y up; the crown stands about the plane z = 0.
    // Throws Error where it encloses nothing.
    CrownSections(const std::vector<DVec2>& outline, bool square);

    double bottom() const { return bottom_; }
    double top() const { return top_; }
    double left() const { return left_; }
    double right() const { return right_; }
    // Half of the largest width of a section.
    double reach() const { return reach_; }
    double area() const { return area_; }      // of the outline, square metres
    double volume() const { return volume_; }  // cubic metres

    // Those at a height, from left to right; none above or below the crown.
    std::span<const Section> at(double y) const;
    // Whether the outline encloses it.
    bool encloses(double x, double y) const;
    // How far the crown reaches before and behind (x, y); negative outside the outline.
    double half_depth(double x, double y) const;
    // Whether p lies in the crown and, where margin is positive, at least about that far from its surface.
    bool contains(const DVec3& p, double margin = 0.0) const;

  private:
    double bottom_ = 0.0, top_ = 0.0, left_ = 0.0, right_ = 0.0;
    double reach_ = 0.0, area_ = 0.0, volume_ = 0.0;
    bool square_ = false;
    std::vector<Section> sections_;
    std::vector<uint32_t> rows_;  // where each row's sections begin
};

}  // namespace treerec
