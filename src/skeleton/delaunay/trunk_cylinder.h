// How thick the trunk is: the one radius of AdTree that is measured.
#pragma once

#include <optional>
#include <vector>

#include "geometry/vec.h"
#include "skeleton/delaunay/initial_skeleton.h"

namespace treerec {

struct TrunkCylinder {
    DVec3 middle{0.0};      // on the axis, metres
    DVec3 axis{0.0};        // unit, up the stem
    double radius = 0.0;    // metres
    double scatter = 0.0;   // metres: median distance of the points from the surface
    double reach = 0.0;     // metres from `middle` to the farthest tip, along the wood
    bool measured = false;  // else the points lie on no cylinder, and the radius is their median distance
};

// The cylinder through the ring of points that are as far from the root as breast height, or a tenth of the
// tree: a robust circle across it, then Levenberg's and Marquardt's (1963) non-linear least squares on the
// distances to the surface, with Tukey's biweights (Chen 2025, 2.2.2, step 3; Du et al. 2019, 3.3). skeleton:
// of the points, before any was moved. measure: without it, or where no cylinder fits, the radius is the
// points' median distance from the axis. Nothing where there are fewer than six points.
std::optional<TrunkCylinder> fit_trunk_cylinder(const std::vector<Vec3>& points,
                                                const InitialSkeleton& skeleton, bool measure, uint64_t seed);

// The radius of wood that carries tips `reach` metres away, by the trunk's: radius * (reach / its reach)^1.1
// (the allometry of Du et al. 2019, 3.3, after Livny et al. 2010). Never less than a millimetre.
double allometric_radius(const TrunkCylinder& trunk, double reach);

}  // namespace treerec
