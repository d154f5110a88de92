// The geometry of SVG 1.1: transforms, path data, and curves as lines. Internal to sketch/.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "geometry/vec.h"

namespace treerec {

// (x, y) -> (a x + c y + e, b x + d y + f): SVG 1.1, 7.4.
struct Affine {
    double a = 1.0, b = 0.0, c = 0.0, d = 1.0, e = 0.0, f = 0.0;

    DVec2 operator()(const DVec2& p) const { return {a * p.x + c * p.y + e, b * p.x + d * p.y + f}; }
    // First `inner`, then this.
    Affine operator*(const Affine& inner) const;
};

// The next number of a list with blanks and a comma between, and takes it (and the comma behind it) away; or
// nothing, and takes nothing.
std::optional<double> take_svg_number(std::string_view& text);

// A whole list of numbers (polygon's points); nothing where it holds anything else.
std::optional<std::vector<double>> parse_svg_numbers(std::string_view text);

// The value of a transform attribute: matrix, translate, scale, rotate, skewX, skewY (degrees), in a row.
// Nothing where it is none.
std::optional<Affine> parse_svg_transform(std::string_view text);

// Lines along curves, each a polyline of two points or more; a closed one ends with its first point.
class SvgLines {
  public:
    // tolerance: how far a line may be from its curve, in what `to_canvas` maps to. most_points: as many are
    // made and no more, then full() is true.
    SvgLines(const Affine& to_canvas, double tolerance, size_t most_points)
        : to_canvas_(to_canvas), tolerance_(tolerance), most_points_(most_points) {}

    // Path data (SVG 1.1, 8.3): M L H V C S Q T A Z, relative and absolute. Gives how many characters were
    // understood: less than all where it is damaged.
    size_t add_path(std::string_view data);
    // Straight from point to point, in the element's own coordinates.
    void add_polyline(const std::vector<DVec2>& points, bool closed);
    void add_ellipse(const DVec2& centre, const DVec2& radii);

    bool full() const { return count_ >= most_points_; }
    // What was added so far. Of a lone point there is none.
    std::vector<std::vector<DVec2>> take();

  private:
    friend class SvgPath;
    void move_to(const DVec2& p);
    void line_to(const DVec2& p);
    void quadratic_to(const DVec2& control, const DVec2& p);
    void cubic_to(const DVec2& first, const DVec2& second, const DVec2& p);
    void arc_to(DVec2 radii, double degrees, bool large, bool sweep, const DVec2& p);
    void close();
    void finish();
    void push(const DVec2& on_canvas);

    Affine to_canvas_;
    double tolerance_;
    size_t most_points_;
    size_t count_ = 0;
    std::vector<std::vector<DVec2>> lines_;
    std::vector<DVec2> line_;  // being drawn
    DVec2 at_{0.0}, start_{0.0};
};

}  // namespace treerec
