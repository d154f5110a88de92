// A missing branch, found by flooding the points that the tree does not explain (Zhang 2013, 8.2).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "progress.h"
#include "scan/point_cloud.h"
#include "tree/tree.h"

namespace treerec {

// Lengths in metres of the tree's space; 0 is automatic.
struct CompleteOptions {
    double tolerance = 0.0;  // points so near to the bark, or inside it, are explained; 0: 2 cm
    double voxel = 0.0;      // of the flood; 0: as in skeletonize()
    double reach = 0.0;  // how far from the node the missing wood may begin; 0: a tenth of the tree's size
    double angle = 0.6;  // radians off the direction that it may lie
    uint64_t seed = 1;   // of the robust fits
};

struct Completion {
    std::vector<NodeId> added;  // parents first; the first hangs on the node
    size_t points = 0;          // that the new wood was fitted to
    double length = 0.0;        // metres that were added
};

// For many completions of one tree, each adding to it.
class Completer {
  public:
    // Throws Error where the cloud has no wood or the options are out of range.
    Completer(const Tree& tree, const PointCloud& cloud, const CompleteOptions& options = {},
              const std::vector<uint8_t>& wood = {}, Progress* progress = nullptr);
    // As complete_branch(). tree: the one of the constructor, with what was added since. reach: metres, 0 as
    // in the options.
    Completion complete(Tree& tree, NodeId node, const DVec3& direction, double reach = 0.0,
                        Progress* progress = nullptr);

  private:
    CompleteOptions options_;
    double voxel_ = 0.0;
    std::vector<Vec3> left_;  // that no branch explains
};

// The flood restarts at the unexplained points nearest to `node` along `direction` and goes on through what
// hangs together with them; the branches that it finds are added as the node's last child, never thicker than
// it, the first segment marked as a guess where it crosses a gap. cloud: in any frame; the tree's says where
// it is. `wood`: empty, or one per point of the cloud, 0 for what is left out (leaves). Only the tree's
// children of `node` change. Throws Error for an unknown node, a direction without length, or where nothing
// is found there; Cancelled on request; the tree is then as it was. The order of the points changes nothing.
Completion complete_branch(Tree& tree, const PointCloud& cloud, NodeId node, const DVec3& direction,
                           const CompleteOptions& options = {}, const std::vector<uint8_t>& wood = {},
                           Progress* progress = nullptr);

// The completion as commands of an edit (edit/commands/script.h), one "grow" for each node, so that it can be
// undone, logged, and replayed without the cloud. grown: with the completion; the commands are for the tree
// before it. (A log does not say which segment was a guess.)
std::string completion_script(const Tree& grown, const Completion& completion);

}  // namespace treerec
