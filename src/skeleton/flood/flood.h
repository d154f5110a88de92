// The voxel-flood skeleton (Zhang 2013, chapter 5): a tree grown from its root through the voxels.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "skeleton/flood/flood_grid.h"
#include "skeleton/flood/flood_steps.h"

namespace treerec {

struct FloodOptions {
    double threshold = 0.3;      // a neighbourhood stops growing at a smaller share of new voxels (5.2)
    double least_share = 0.004;  // of the neighbourhood's points: a direction with fewer is dropped (5.3)
    double longest_gap = std::numeric_limits<double>::infinity();  // metres that the flood goes over
    uint64_t seed = 1;                                             // of the robust fits
    bool keep_steps = false;                                       // fill FloodResult::steps
};

struct FloodNode {
    int32_t parent = -1;
    int32_t generation = 0;
    DVec3 position{0.0};
    double radius = 0.0;    // metres, of the way here from the parent; 0 where no point told it
    double scatter = 0.0;   // metres: mean deviation of the points from the mean distance
    uint32_t points = 0;    // on the way here from the parent
    bool measured = false;  // the points surround the way: position and radius are a circle's
    bool bridged = false;   // the way here crosses a gap
};

struct FloodResult {
    std::vector<FloodNode> nodes;  // parents before children; the root is 0
    std::vector<int32_t> owner;    // by voxel: the node that its points lie on the way to; -1 for none
    std::vector<FloodStep> steps;  // in the order in which they were made
    CloudKind kind = CloudKind::kSurface;
    bool kind_told = false;  // false where no wood is thick enough to tell
};

// Floods from the root: all nodes of a generation at once, shell by shell through the 26 neighbours, until
// the share of new voxels falls below the threshold (algorithm 4) and the neighbourhood is as long as thick.
// The voxels are retired. What the last shells leave apart are directions; those that lie on one cylinder are
// one, and those with too small a share of the points are dropped. Each direction is fitted by least squares
// through the node (equations 5.1 to 5.3, with t along the line), its length is twice the mean projection
// (algorithm 7; counted from where its points begin) and its radius the mean distance (algorithm 6), which is
// the radius itself on a surface and two thirds of it in a solid; the paper's factor 2 fits neither. Where
// the flood ends before the cloud does it goes on over the gaps. root: of `seeds`, the voxels to begin with.
// Deterministic. Throws Cancelled.
FloodResult flood(const FloodGrid& grid, const std::vector<Vec3>& points, const DVec3& root,
                  const std::vector<uint32_t>& seeds, const FloodOptions& options, Progress& progress);

}  // namespace treerec
