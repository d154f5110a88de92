// A circle through noisy points of a branch's cross-section.
#pragma once

#include <optional>
#include <span>

#include "geometry/random.h"
#include "geometry/vec.h"

namespace treerec {

struct CircleFit {
    DVec2 centre{0.0};
    double radius = 0.0;
    double spread = 0.0;    // median distance of the points from the circle
    double coverage = 0.0;  // share of the circle's 16 sectors that hold points on the circle, 0..1
    double error = 0.0;     // standard error of the radius, as the spread of the points tells
    double inside = 0.0;    // share of the points that lie well inside the circle
};

// Robust fit: three-point circles by random sampling, the one with the smallest median residual, refined by
// Gauss-Newton steps on the geometric residuals with Tukey's biweights (Holland and Welsch 1977). points: 2D,
// metres; of more than 128, evenly chosen ones are looked at. Nothing where there are fewer than 5 points,
// they lie on a line, or no circle comes near them. Radii above max_radius are not considered.
std::optional<CircleFit> fit_circle(std::span<const DVec2> points, double max_radius, Random random);

// For a section that is closed but not round (fluted, buttressed, oval): the centre from which the points of
// all directions are on average equally far, and the radius of the circle of the same area, every direction
// counting once. `spread` is the median deviation from that radius and `inside` counts points nearer than 0.4
// of it. Nothing where there are fewer than 16 points or a third of the directions is empty.
std::optional<CircleFit> fit_ring(std::span<const DVec2> points);

}  // namespace treerec
