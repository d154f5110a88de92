// The way of a drawn branch through the points of a scan.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "geometry/point_tree.h"
#include "sketch/branch_statistics.h"
#include "sketch/sketch_branch.h"

namespace treerec {

// Points of the cloud that fall within `reach` pixels of the line and that no wood explains: they lie more
// than twice the tolerance outside of all bark (nearer ones are mostly the blurred edge of wood that is
// there). Tree space, in an order of their own. Throws Error for marks of wood that are not the cloud's.
std::vector<Vec3> points_beside(const Tree& tree, const PointCloud& cloud, const std::vector<uint8_t>& wood,
                                const PinholeView& view, const std::vector<DVec2>& line, double reach,
                                double tolerance, const Progress* progress);

// Where the line was found in space.
struct BranchPath {
    struct Stop {
        size_t sample;  // place in the line
        DVec3 place;    // tree space
    };
    std::vector<Stop> stops;  // from the tail on
    double score = 0.0;       // how much better than no points at all; 0 where nothing was found
};

// From the joint (tree space) through groups of the points, at most one for each sample of the line: the way
// whose support by points, less its bends, its leaps through air and its distance from the line in the
// picture, is the greatest. Dynamic programming over pairs of successive stops (Amini, Weymouth, Jain 1990),
// so that a bend has its cost. What lies at another depth than the branch is only reached by two sharp bends
// and a leap. jitter: pixels.
BranchPath find_path(const std::vector<Vec3>& points, const PinholeView& view, const std::vector<DVec2>& line,
                     const DVec3& joint, double jitter, const Progress* progress);

// How thick a branch is along its path.
struct PathRadius {
    const RadiusLaw& law;
    double base = 0.0;     // metres
    double covered = 1.0;  // the share of the branch that the path covers

    // share: of the path.
    double at(double share) const { return std::max(base * law.share_at(share * covered), law.least); }
};

// The axis of the wood around the path: its places every `step` metres from the joint to the last stop, drawn
// to where the points around them lie on bark of the branch's radius (Gauss and Newton's method on the circle
// across the branch, damped: points on one side of it are enough).
std::vector<DVec3> centre_path(const std::vector<Vec3>& points, const DVec3& joint, const BranchPath& path,
                               double step, const PathRadius& radius, const Progress* progress);

// The share of the points around the axis that lie on bark of that radius, 0..1, each place counting alike.
double bark_share(const std::vector<Vec3>& points, const std::vector<DVec3>& axis, const PathRadius& radius);

// Whether points show the places of an axis: within a branch's radius and 4 cm of it, near the place. Short
// gaps are closed, and short finds dropped.
std::vector<uint8_t> shown_places(const std::vector<Vec3>& points, const std::vector<DVec3>& axis,
                                  const PathRadius& radius);

}  // namespace treerec
