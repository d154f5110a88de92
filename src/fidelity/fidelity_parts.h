// From what was found for each point to the figures. Internal to fidelity/.
#pragma once

#include <vector>

#include "fidelity/fidelity.h"
#include "geometry/capsule_tree.h"

namespace treerec {

// One entry per point, in the tree's space.
struct MeasuredPoints {
    const std::vector<DVec3>& points;
    const std::vector<BarkHit>& bark;
    const std::vector<NodeId>& within;  // see FidelityTracker
    const std::vector<NodeId>& inside;
};

// Linear in points and nodes. Throws Cancelled.
Fidelity sum_up(const Tree& tree, const MeasuredPoints& measured, const FidelityOptions& options,
                const Progress* progress);

}  // namespace treerec
