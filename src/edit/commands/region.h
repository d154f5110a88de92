// Parts of space that wood can be cut out of: boxes, spheres, half-spaces.
#pragma once

#include "geometry/scan_frame.h"
#include "geometry/vec.h"

namespace treerec {

// Metres, tree space.
struct Region {
    enum class Shape { kBox, kSphere, kSide };
    Shape shape = Shape::kBox;
    DVec3 a{0.0};         // the lower corner; the centre; a place on the plane
    DVec3 b{0.0};         // the upper corner; unused; the plane's unit normal, towards the half meant
    double radius = 0.0;  // of the sphere

    // Throw Error for a box or a sphere without inside, or a normal without direction.
    static Region box(const DVec3& one_corner, const DVec3& other_corner);
    static Region sphere(const DVec3& centre, double radius);
    static Region side(const DVec3& place, const DVec3& normal);

    bool contains(const DVec3& p) const;
    // Where the way from `outside` to `inside` first meets the region, 0..1.
    double entry(const DVec3& outside, const DVec3& inside) const;
};

// What was meant in one frame, said in another, so that it stays where it was in the scan.
DVec3 point_between(const ScanFrame& from, const ScanFrame& to, const DVec3& p);
DVec3 direction_between(const ScanFrame& from, const ScanFrame& to, const DVec3& v);
double length_between(const ScanFrame& from, const ScanFrame& to, double metres);

}  // namespace treerec
