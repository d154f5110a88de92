// How a branch stands out of the picture that it is drawn in, where nothing tells but the tree itself.
#pragma once

#include "sketch/branch_statistics.h"
#include "sketch/sketch_branch.h"

namespace treerec {

// The plane through `base` that faces the camera but is turned about the line across the stroke, so that the
// stroke leads away from the camera (or towards it) by `slope` radians. Camera space: x right, y up, z
// behind.
struct BranchPlane {
    DVec3 base{0.0};
    DVec3 normal{0.0, 0.0, 1.0};

    // base: camera space. along: the stroke's way in the picture, pixels (y down), not zero.
    BranchPlane(const DVec3& base, const DVec2& along, double slope);
    // Where the ray through a pixel meets it; at most `most` metres off the base, where they hardly meet.
    DVec3 meet(const PinholeView& view, const DVec2& pixel, double most) const;
};

// Camera space of a place, and back.
DVec3 into_camera(const PinholeView& view, const DVec3& place);
DVec3 out_of_camera(const PinholeView& view, const DVec3& place);

// The slope, radians (positive: away from the camera), that makes the branch most like its siblings: how far
// they lean off their host near there, how long they are there, and by which angle about the host one follows
// the other (kernel densities, Parzen 1962). Of all slopes the one with the least expected error.
double likely_slope(const Tree& tree, const BranchStatistics& statistics, const PinholeView& view,
                    NodeId host, const std::vector<DVec2>& line);

}  // namespace treerec
