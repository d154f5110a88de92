// The flood as Zhang 2013 prints it (chapter 5), to be compared with ours.
#pragma once

#include <vector>

#include "skeleton/flood/flood.h"
#include "tree/tree.h"

namespace treerec {

struct PaperFloodOptions {
    int dimension = 200;          // d: voxels along each axis (algorithm 3)
    double threshold = 0.3;       // lambda: the flood goes on while more voxels than that share come in
    double least_density = 0.03;  // of the neighbourhood's points: a direction with fewer is dropped (5.3)
    bool keep_steps = false;      // fill FloodResult::steps
};

struct PaperFlood {
    FloodResult flooded;   // `owner` by the voxels of this flood
    double reached = 0.0;  // share of the points
};

// Algorithm 3: each axis of the cloud is stretched to d voxels of its own, so that these are no cubes.
// Algorithm 4: from the voxel of a node, all its 26 neighbours that hold points and were not flooded yet,
// then theirs, while the share of new ones stays above the threshold; nodes of one generation flood side by
// side. The 26 directions from the node are what its neighbourhood is parted into, by the voxels' middles
// (5.3); each that is dense enough is a child: at twice the mean projection on its line (algorithm 7), twice
// as thick as the mean distance from that (algorithm 6). Equations 5.1 to 5.3 leave t open: it is a point's
// distance from the node. Nothing is done about gaps: there the flood ends. points: metres. root: where the
// first node is. Throws Error for a dimension out of range, Cancelled.
PaperFlood flood_as_printed(const std::vector<Vec3>& points, const DVec3& root,
                            const PaperFloodOptions& options, Progress& progress);

// The points and, within the wood of `tree` (same space), as many random ones as make it solid (5.4: photos
// and scanners see the skin alone, and algorithm 6 is for points that fill the wood evenly): in each voxel as
// many as a voxel of the skin holds, but four times the points at most. spacing: between the points of the
// skin, metres.
std::vector<Vec3> filled_solid(const std::vector<Vec3>& points, const Tree& tree, double spacing,
                               double voxel, uint64_t seed);

}  // namespace treerec
