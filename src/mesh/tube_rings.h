// The rings that a branch's tube is hung on. Internal to mesh/.
#pragma once

#include <cstddef>

#include "geometry/vec.h"

namespace treerec {

// Metres, tree space.
struct Ring {
    DVec3 centre;
    DVec3 normal;  // unit, towards the tip
    double radius;
    double along;  // from the branch's start
    DVec3 x{0.0};  // unit, across the normal: where the ring's first corner lies; set by parallel_transport()
    double way = 0.0;      // AxisPoint::way
    double stretch = 1.0;  // of the bark's picture: the radius that it goes around by, over this one
    DVec3 y() const { return glm::cross(normal, x); }  // a quarter turn on
};

// Two rings must not cross on the inner side of a bend: turns both towards their mean until they clear.
void limit_tilt(Ring* rings, size_t count);

// Whether a trunk stands, rather than lies on the ground. rings: from the root.
bool stands(const Ring* rings, size_t count);

// Where the wood widens or thins within a short way, the bark's picture would wind about it if it kept its
// scale, since more of it goes around at one end. Up to `height` metres along it stretches instead, so that
// it slants little.
void limit_slant(Ring* rings, size_t count, double height);

// How much wider the tube becomes per metre at ring i, by its neighbours; -1..1.
double ring_slope(const Ring* rings, size_t count, size_t i);

}  // namespace treerec
