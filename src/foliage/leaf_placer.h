// Puts leaves onto branches by the rules alone. Internal to foliage/.
#pragma once

#include <cstdint>
#include <vector>

#include "foliage/branch_axis.h"
#include "foliage/crown.h"
#include "foliage/leaves.h"
#include "foliage/wind.h"
#include "geometry/random.h"
#include "tree/branches.h"
#include "tree/tree.h"

namespace treerec {

// The rules' lengths in the measure of one tree.
struct ScaledLeaf {
    double internode, twig_length, maximum_radius, leaf_size;
};

// Where a leaf will stand: all that it is made from, for many are passed over before they are made.
struct LeafSpot {
    AxisPoint at;
    DVec3 radial;     // unit, out of the bark at `at`
    double angle;     // degrees between the twig and the leaf
    NodeId tip;       // of its branch
    uint64_t number;  // counts from the tip, which has 0, so that the leaf keeps its random numbers whatever
                      // happens below it
    double red = -1.0;   // 0..1, how little green the scan is there; below 0 where it has no colours
    bool spare = false;  // the rules' shares by height, radius and order leave it out
};

struct LeafPlacer {
    const Tree& tree;
    const LeafRules& rules;
    const BranchList list;
    const Crown crown;
    const WindGroups wind;
    const ScaledLeaf size;
    Crown leafy;  // with the leaves that stand out of it
    const uint64_t seed;

    // The tree and the rules must outlive it.
    LeafPlacer(const Tree& t, const LeafRules& r, uint64_t s);

    LeafPlacement leaf_at(const LeafSpot& spot) const;
    // The size of that leaf, in a fraction of the time.
    float size_of(const LeafSpot& spot) const;
    LeafSpot tip_spot(const Branch& branch, const AxisPoint& end) const;

    // Adds the spots of the branch's leaves, that at its tip first. share: of them that the rules bear, the
    // tip's always among them unless it is 0. crowding: how many times as close as the internode they stand.
    void bear(const Branch& branch, double share, double crowding, std::vector<AxisPoint>& axis,
              std::vector<LeafSpot>& spots) const;

  private:
    float random_size(Random& random) const;
    double density_at(const Branch& branch, const AxisPoint& at) const;
    DVec3 first_side(const DVec3& direction) const;
};

}  // namespace treerec
