// Lines and polygons in the plane of a drawing: lengths, nearest places, crossings.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "geometry/vec.h"

namespace treerec {

// Points one after another: pixels of a canvas that is kCanvasHeight high, y up. As a polygon, its last point
// is joined to its first.
using FlatLine = std::vector<DVec2>;

inline double cross(const DVec2& a, const DVec2& b) {
    return a.x * b.y - a.y * b.x;
}
// The same direction with length 1, or `fallback` where v has none.
inline DVec2 unit_or(const DVec2& v, const DVec2& fallback) {
    const double length = glm::length(v);
    return length > 1e-12 ? v / length : fallback;
}

// A place on a line.
struct LinePlace {
    size_t segment = 0;  // from point `segment` to the next one
    double along = 0.0;  // 0 at the one, 1 at the other
    DVec2 point{0.0};
    double distance = 0.0;  // of what was asked for from it
};

struct FlatBox {
    DVec2 low{0.0}, high{0.0};
    DVec2 size() const { return high - low; }
};

double line_length(const FlatLine& line);
// At each point, the length of the line up to it.
std::vector<double> line_arcs(const FlatLine& line);
FlatBox line_box(const FlatLine& line);
DVec2 line_centroid(const FlatLine& points, size_t begin, size_t end);
// Where a line of these arcs has come `arc` far; held to its ends. At least one point.
DVec2 point_at(const FlatLine& line, const std::vector<double>& arcs, double arc);
// A line of at least one point.
LinePlace nearest_on_line(const FlatLine& line, const DVec2& p);
// How far along the line a place is, by the line's arcs.
double arc_of(const LinePlace& place, const std::vector<double>& arcs);

// Where the segments a-b and c-d cross: x 0..1 along a-b, y along c-d. Nothing where they are parallel.
std::optional<DVec2> segments_cross(const DVec2& a, const DVec2& b, const DVec2& c, const DVec2& d);
// Places on `line`, in its order, where `other` crosses it.
std::vector<LinePlace> crossings(const FlatLine& line, const FlatLine& other);
// The first place on `other` that the segment from a to b meets; distance: from a.
std::optional<LinePlace> first_hit(const DVec2& a, const DVec2& b, const FlatLine& other);

// Square pixels, positive where the polygon runs counter-clockwise.
double polygon_area(const FlatLine& polygon);
// By the number of times that the polygon winds around it.
bool is_inside(const FlatLine& polygon, const DVec2& p);
// Counter-clockwise (Andrew 1979, "Another efficient algorithm for convex hulls in two dimensions").
FlatLine flat_hull(FlatLine points);

}  // namespace treerec
