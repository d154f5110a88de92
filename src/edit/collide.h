// Where new wood runs into wood that stands already: capsules against capsules, through a grid.
#pragma once

#include <limits>
#include <vector>

#include "progress.h"
#include "tree/tree.h"

namespace treerec {

// Two segments, each named by its upper node, that are nearer to each other than their radii and the
// clearance allow.
struct Collision {
    NodeId grafted = kNoNode;  // of the new wood
    NodeId other = kNoNode;    // of the wood that stood already
    double depth = 0.0;        // metres by which they overlap, the clearance included
    DVec3 place{0.0};          // in tree space, halfway between the two axes where they are nearest
};

struct CollisionOptions {
    double clearance = 0.0;  // metres of air to keep between bark and bark
    // New wood whose axis is within `joint_reach` metres of `joint` (tree space) touches nothing: it grows
    // out of the wood there.
    DVec3 joint{0.0};
    double joint_reach = 0.0;
    // The search may end once it has found more than so many: whoever has a better place already need not
    // know them all.
    size_t most = std::numeric_limits<size_t>::max();
};

// The segments of a tree as capsules, kept for several questions while the tree grows.
class StandingWood {
  public:
    struct Segment {
        DVec3 a, b;     // tree space
        double ra, rb;  // metres, at either end; between them it tapers
        NodeId id;      // of its upper node
    };

    explicit StandingWood(const Tree& tree);
    // Only what comes near the box: for a question about what lies within.
    StandingWood(const Tree& tree, const Bounds& within);
    // The segments that end at `ids`, which are new in the tree and not its root.
    void add(const Tree& tree, const std::vector<NodeId>& ids);

    // Runs of neighbouring segments, and the box about each.
    struct Run {
        std::vector<Segment> segments;
        Bounds box;
    };
    const std::vector<Run>& runs() const { return runs_; }

  private:
    void add(const Segment& segment);

    std::vector<Run> runs_;
};

// The collisions of `wood`, a tree of its own in the same tree space, with what stands; Collision::grafted is
// an id of `wood`. By ascending ids. A segment starts at most 1.6 times as thick as it ends. Linear where the
// wood is not crowded. Throws Cancelled.
std::vector<Collision> find_collisions(const StandingWood& standing, const Tree& wood,
                                       const CollisionOptions& options, const Progress* progress = nullptr);

// The collisions of the subtree on the segment to `child` with the rest of its tree, about their joint
// excepted as graft() excepts it. Throws Error for an unknown id or a negative clearance.
std::vector<Collision> find_collisions(const Tree& tree, NodeId child, double clearance,
                                       const Progress* progress = nullptr);

// How far from `joint` new wood of radius `own` that leaves it along unit vector `away` still grows out of
// what is there: at this distance it is clear of the joint's other wood, `own_child` (or kNoNode) not
// counted. Metres.
double joint_reach(const Tree& tree, NodeId joint, NodeId own_child, double own, const DVec3& away,
                   double clearance);

}  // namespace treerec
