// Scans a tree virtually, as a terrestrial laser scanner would from several stations around it.
#pragma once

#include <cstdint>
#include <vector>

#include "progress.h"
#include "scan/point_cloud.h"
#include "synth/grow.h"
#include "tree/tree.h"

namespace treerec {

// Lengths in metres.
struct VirtualScanOptions {
    size_t points = 40000;     // of the whole cloud; fewer if the tree cannot return so many
    int stations = 5;          // evenly around the tree, 8 to 15 m away, 1.5 m above its base
    double noise = 0.003;      // standard deviation of the range
    double occlusion = 0.0;    // 0..0.95: share of each station's view hidden by things in front of the tree
    double leaves = 0.0;       // 0..1: 0 a winter tree, 1 full foliage
    int fronds = 0;            // of a palm's crown, at the top; always there, whatever `leaves` says
    int buttresses = 0;        // planks of wood around the base, not part of the tree
    double beam_exit = 0.004;  // diameter of the beam where it leaves the scanner
    double beam_divergence = 0.00025;  // growth of that diameter per metre
    double mixed = 0.3;    // of the beams split by an edge, the share that reports a range in between
    double stray = 0.001;  // share of points anywhere (dust, birds)
    uint64_t seed = 1;
};

// The defaults, with what a habit carries beside its wood: a palm's fronds, buttresses.
VirtualScanOptions scan_options_for(Habit habit);

struct VirtualScan {
    PointCloud cloud;             // in the tree's frame; colours of bark and leaf
    std::vector<uint8_t> origin;  // per point, see ScanOrigin
    std::vector<NodeId> node;  // per point: whose wood or leaf it is; of a mixed beam, the nearer; or kNoNode
};

enum ScanOrigin : uint8_t { kFromWood, kFromLeaf, kMixedBeam, kStray };

// Every station is a grid of beams in azimuth and elevation; each returns the first tapered cylinder or leaf
// disc that it meets, so that wood hides wood, density falls with the distance, and one side of a branch may
// stay unseen. A beam is as wide as a real one: what only its rim meets echoes too, from the beam's middle,
// so that twigs look thicker than they are, edges blur, and a beam split by an edge may report a place in the
// air behind it. tree: Y up, metres. The same arguments give the same cloud. Throws Error for a tree without
// wood, no points or options out of range.
VirtualScan scan_tree(const Tree& tree, const VirtualScanOptions& options, Progress* progress = nullptr);

}  // namespace treerec
