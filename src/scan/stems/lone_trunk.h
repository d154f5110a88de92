// A stem without a crown.
#pragma once

#include <vector>

#include "geometry/vec.h"
#include "progress.h"

namespace treerec {

// Whether the cloud is nothing but a stem, or a piece of one, as photos of a trunk give it: at nearly all
// heights its points lie around one axis, at one distance. points: metres, Y up.
bool is_lone_trunk(const std::vector<Vec3>& points, const Progress& progress);

// One of a stump's sections.
struct TrunkRing {
    DVec3 centre{0.0};  // metres
    double radius = 0.0;
    double scatter = 0.0;  // the median distance of its points from the circle
};

// The sections, from the ground to the cut face, of what is nothing but a trunk that is hardly higher than
// wide: one piece of wood, on which nothing grows. Nothing for any other cloud.
std::vector<TrunkRing> stump_rings(const std::vector<Vec3>& points, const Progress* progress = nullptr);

// The same of what is known to be nothing but a trunk, however high, and whatever else lies around. Nothing
// where no half of it is round.
std::vector<TrunkRing> trunk_rings(const std::vector<Vec3>& points, const Progress* progress = nullptr);

}  // namespace treerec
