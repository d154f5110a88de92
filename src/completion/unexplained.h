// Wood that a scan saw and the tree does not have.
#pragma once

#include <cstdint>
#include <vector>

#include "fidelity/fidelity.h"
#include "progress.h"
#include "scan/point_cloud.h"
#include "tree/tree.h"

namespace treerec {

// A cluster of points that no branch explains: they lie at least twice the tolerance outside of all bark,
// since what is nearer is mostly the blurred edge of wood that is there. Positions and lengths in the tree's
// space, metres.
struct UnexplainedCluster {
    std::vector<uint32_t> points;  // indices into the cloud, ascending
    DVec3 centre{0.0};             // mean of the points
    double size = 0.0;             // diagonal of the box around them
    NodeId joint = kNoNode;        // the node that a branch through them would grow from
    double gap = 0.0;              // from it to the nearest of the points
    DVec3 direction{0.0};          // unit: where the branch would set out from the joint
};

struct UnexplainedOptions {
    double gap = 0.0;  // metres: points so near belong together; 0: found out from the points' spacing
    size_t least_points = 12;  // smaller clusters are noise
};

// Largest first (by points, then by place). `wood`: empty, or one per point of the cloud, 0 for what is no
// wood and stays out (leaves). fidelity: of this tree and this cloud. Any order of the points gives the same
// clusters. O(n log n). Throws Error where the arguments do not belong together or are out of range, or
// Cancelled.
std::vector<UnexplainedCluster> find_unexplained(const Tree& tree, const PointCloud& cloud,
                                                 const Fidelity& fidelity,
                                                 const std::vector<uint8_t>& wood = {},
                                                 const UnexplainedOptions& options = {},
                                                 const Progress* progress = nullptr);

}  // namespace treerec
