// A missing branch drawn over a scan, from any camera, as a graft.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "photos/pinhole_view.h"
#include "progress.h"
#include "scan/point_cloud.h"
#include "tree/tree.h"

namespace treerec {

// One stroke along a branch, in pixels of the view, either end first. view: the camera, in the tree's space.
struct BranchStroke {
    PinholeView view;
    std::vector<DVec2> points;
};

struct SketchedBranchOptions {
    uint64_t seed = 1;        // of the twigs that are drawn by chance
    double jitter = 3.0;      // pixels that the stroke may lie beside the branch
    double tolerance = 0.02;  // metres: points so near to the bark, or inside it, are explained
    bool twigs = true;
};

// A place on the branch's axis, tree space, metres.
struct BranchPlace {
    DVec3 position{0.0};
    double radius = 0.0;
    bool measured = false;  // points of the scan show it; else its depth is a guess
};

struct SketchedBranch {
    NodeId host = kNoNode;          // the node that it grows from
    std::vector<BranchPlace> axis;  // from the host's node to the tip
    Tree scion;                     // the whole branch, as edit/graft/scion.h has it
    std::string command;            // of an edit (edit/commands/script.h): one "graft", for the tree as it is
    size_t twigs = 0;               // on the axis
    double length = 0.0;            // metres of the axis,
    double measured = 0.0;          // and the share of it that the scan shows
    std::vector<std::string> remarks;  // sentences for the user
};

// The stroke is cleaned (Ma and Liu 2020, 2.1) and hung on the wood that its tail falls on. Its depth comes
// from the points there that no wood explains; where there are none, from the slope of what was found, else
// from how the tree's own branches branch (sketch/branch_plane.h). Its radii, twigs' angles and internodes
// are the tree's own (sketch/branch_statistics.h), and its twigs copies of the tree's. cloud: null for none;
// in any frame, the tree's says where it is. wood: empty, or one per point of the cloud, 0 for what is left
// out (leaves). The order of the points changes nothing. Throws Error, with a sentence, for a camera, stroke
// or options that are no such thing, a stroke outside of the picture, a tree without wood, or a stroke near
// no wood; Cancelled on request.
SketchedBranch sketch_branch(const Tree& tree, const PointCloud* cloud, const BranchStroke& stroke,
                             const SketchedBranchOptions& options = {}, const std::vector<uint8_t>& wood = {},
                             Progress* progress = nullptr);

}  // namespace treerec
