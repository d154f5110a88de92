// The trunk and its branches of the first order, in space.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "geometry/vec.h"
#include "sketch/species.h"

namespace treerec {

// The least radius of wood, metres: what is thinner is a leaf's stalk.
inline constexpr double kLeastRadius = 0.002;

// A line of wood from its tail to its tip, metres, Y up.
struct SketchAxis {
    std::vector<DVec3> points;  // at least two
    std::vector<double> radii;  // of each
    int32_t stroke = -1;        // that it was drawn by (place in Sketch::strokes); -1: not drawn
    double along = 0.0;         // of a branch: metres along its parent's line to where it grows
    int32_t parent = -1;        // of a branch of the second order: place in Branches::branches; -1: the trunk
    uint64_t seed = 0;          // of what is drawn by chance on it
};

// Parents come before what grows from them.
struct SketchAxes {
    SketchAxis trunk;
    std::vector<SketchAxis> branches;
    std::optional<WoodTaper> taper;  // of this tree's height; nothing: equation 2
};

double length_of(const std::vector<DVec3>& points);
// The place at so many metres along the line; its ends beyond them.
DVec3 place_along(const std::vector<DVec3>& points, double along);
// Of the line there, from its tail to its tip; unit.
DVec3 direction_along(const std::vector<DVec3>& points, double along);
// place_along() for the values at its points.
double value_along(const std::vector<DVec3>& points, const std::vector<double>& values, double along);
// The place on the line that is nearest to p: metres along it.
double nearest_along(const std::vector<DVec3>& points, const DVec3& p);

// d / l = R_i / R (Ma and Liu 2020, equation 2): at each point, from `base` at the first to 0 at the last,
// but at least `least`. Metres.
std::vector<double> tapered(const std::vector<DVec3>& points, double base, double least);

}  // namespace treerec
