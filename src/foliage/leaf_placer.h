// Puts leaves onto branches by the rules alone. Internal to foliage/.
#pragma once

#include <cstdint>
#include <vector>

#include "foliage/branch_axis.h"
#include "foliage/crown.h"
#include "foliage/leaves.h"
#include "foliage/wind.h"
#include "tree/branches.h"
#include "tree/tree.h"

namespace treerec {

// The rules' lengths in the measure of one tree.
struct ScaledLeaf {
    double internode, twig_length, maximum_radius, leaf_size;
};

struct LeafPlacer {
    const Tree& tree;
    const LeafRules& rules;
    const BranchList list;
    const Crown crown;
    const WindGroups wind;
    const ScaledLeaf size;
    const uint64_t seed;

    // The tree and the rules must outlive it.
    LeafPlacer(const Tree& t, const LeafRules& r, uint64_t s);

    // One leaf. radial: unit, out of the bark at `at`. angle: degrees between the twig and the leaf. number:
    // counts from the tip, so that the leaf keeps its random numbers whatever happens below it.
    LeafPlacement leaf_at(const AxisPoint& at, const DVec3& radial, double angle, NodeId tip,
                          uint64_t number) const;
    LeafPlacement tip_leaf(const Branch& branch, const AxisPoint& end) const;

    // Adds the branch's leaves, the one at its tip first. share: of them that the rules bear, the tip's
    // always among them unless it is 0.
    void bear(const Branch& branch, double share, std::vector<AxisPoint>& axis,
              std::vector<LeafPlacement>& leaves) const;

  private:
    double density_at(const Branch& branch, const AxisPoint& at) const;
    DVec3 first_side(const DVec3& direction) const;
};

}  // namespace treerec
