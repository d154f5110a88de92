// How the branches of one tree are: what a drawn branch takes from its siblings.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "tree/branches.h"
#include "tree/tree.h"

namespace treerec {

// A side branch where it leaves its parent. Metres and radians.
struct SideBranch {
    int32_t branch = -1;     // place in BranchList::branches
    double along = 0.0;      // metres from the parent branch's base
    double share = 0.0;      // the same, of the parent's length
    double internode = 0.0;  // to the sibling before it; of the first one to the base
    bool first = false;
    // Between the parent's direction and the way it sets out (scion_direction()), and the azimuth of that
    // about the parent, from the side of it that is up (frame_about()): flat sprays stay flat.
    double angle = 0.0;
    double azimuth = 0.0;
    // The same of its chord, from its base to its tip, but the azimuth in a frame that is carried along the
    // parent without turning.
    double lean = 0.0;
    double chord_azimuth = 0.0;
    double chord = 0.0;
};

// r(s) = base radius by length, and the profile along a branch.
struct RadiusLaw {
    double intercept = 0.0;  // of log(base radius) on log(length), both in metres
    double slope = 0.0;
    // Radius over the base radius at 0, 0.1 .. 1 of the length.
    std::array<double, 11> profile{};
    double least = 0.0;  // metres: the tree's thinnest tips
    bool known = false;  // false: the tree has no branch to learn from

    double base_radius(double length) const;
    double share_at(double share) const;
    // At each point of a branch's line, metres: `stouter` times what the law says of its length, tapering by
    // the profile, but from `least` to `most`.
    std::vector<double> radii_along(const std::vector<DVec3>& points, double stouter, double most) const;
};

// The value at `share` (0..1) of a branch, between those at its tenths.
double profile_at(const std::array<double, 11>& profile, double share);

class BranchStatistics {
  public:
    // Copies nothing: the tree must outlive it, and stay as it is. Precondition: not empty.
    explicit BranchStatistics(const Tree& tree);

    const BranchList& list() const { return list_; }
    // The side branches of a branch, from its base on.
    const std::vector<SideBranch>& sides(int32_t branch) const { return sides_[static_cast<size_t>(branch)]; }
    // A frame at each of a branch's nodes (attach or root first), carried along without turning: column 1 is
    // the direction in which the wood arrives.
    std::vector<DMat3> frames(int32_t branch) const;

    // Robust: Theil and Sen's line (the median of the slopes of all pairs) and the medians of the profiles of
    // the branches of that order; the line is of all orders above 0 where there are fewer than five of it.
    RadiusLaw radius_law(int32_t order) const;
    // Branches (places in list()) to take twigs from: of that order, and as thick at the base within a factor
    // of two. Where these have too few side branches, those of that order; then all but the trunk.
    std::vector<int32_t> kindred(int32_t order, double base_radius) const;
    double base_radius(int32_t branch) const;
    // Radius over the base radius at 0, 0.1 .. 1 of the branch's length, as it was measured.
    std::array<double, 11> profile(int32_t branch) const;

  private:
    std::vector<SideBranch> measure_sides(int32_t branch, const std::vector<int32_t>& children) const;

    const Tree& tree_;
    BranchList list_;
    std::vector<std::vector<SideBranch>> sides_;
};

}  // namespace treerec
