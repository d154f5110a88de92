// Grafting: a scion (edit/graft/scion.h) is put onto a node, turned, scaled and blended to fit (Chen
// 2025, 3.2.4, algorithms 6 to 8).
//
// Differences from the paper, on purpose: algorithm 7 offsets the scion by 1.001 times the node's position,
// which moves it off the node the farther the node is from the origin; here it starts at the node. Algorithm
// 8 gives every node the radius ratio^depth, so that a finely divided branch thins in no time; here radii
// keep their own profile, blended into the host's over a length, unless `thinning` asks for that.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "edit/collide.h"
#include "edit/graft/graft_vary.h"
#include "progress.h"
#include "tree/tree.h"

namespace treerec {

// kAuto: on a tip the scion goes on in the tip's direction; elsewhere it keeps its own branching angle, or
//        leans 45 degrees off where it has none to speak of (under 20), into the widest gap between the
//        branches there.
// kOnward: in the direction of the host's wood, on a tip or not.
// kOwn: as it stood on the wood it was taken from, relative to the host's wood.
// kLean: `lean` degrees off the host's direction, into the widest gap.
// kDirection: towards `direction`.
enum class GraftAim { kAuto, kOnward, kOwn, kLean, kDirection };

// kAuto: kRadius on a tip, else kFit.
// kRadius: the scion's root becomes as thick as the joint allows (joint_ratio).
// kFit: made smaller where it is thicker than that, else left as it is.
// kLength: its longest path becomes `length` metres.
// kFactor: by `factor`.
enum class GraftScale { kAuto, kRadius, kFit, kLength, kFactor };

struct GraftOptions {
    uint64_t seed = 1;
    Variation variation;
    GraftAim aim = GraftAim::kAuto;
    double lean = 45.0;              // degrees, 0..180
    DVec3 direction{0.0, 1.0, 0.0};  // tree space, any length but zero
    double roll = 0.0;               // degrees, about the way it goes (kOwn: the host's direction)
    bool mirror = false;             // left and right of the scion change sides
    GraftScale scale = GraftScale::kAuto;
    double length = 1.0;  // metres, positive
    double factor = 1.0;  // positive
    // The scion's radius at the joint over the host's, at most: 0 for 1 on a tip and 0.8 (algorithm 5)
    // elsewhere. 0..1.
    double joint_ratio = 0.0;
    // Radii: never thicker than the joint allows, and none thicker than its parent's; on a tip the main
    // branch blends from the host's radius into its own. Off: they are the scion's, scaled.
    bool smooth = true;
    // Above 0: algorithm 8 as printed, in place of `smooth`: each node's radius is the host's times this to
    // the power of how many nodes it lies beyond the host. 0..1; the paper's is 0.8.
    double thinning = 0.0;
    double clearance = 0.0;  // metres of air that collisions are reported within
    // Up to so many seeds are tried, from `seed` on, until one is free of collisions; else the best stays.
    // Each further one also turns the scion about its own direction. 1..1000.
    int tries = 1;
    // More are not added.
    size_t most_nodes = size_t{1} << 22;
};

struct GraftResult {
    NodeId host = kNoNode;
    std::vector<NodeId> added;  // in the scion's depth-first order, its root left out
    double scale = 1.0;
    uint64_t seed = 0;  // by which it varies: options.seed at the first try
    double spin = 0.0;  // degrees by which it was turned about its own direction to avoid collisions
    int tries = 0;
    std::vector<Collision> collisions;  // Collision::grafted is an id of the tree
};

// Puts the scion onto `host`. No node that stood before changes, but that the host has more children. Throws
// Error, before anything changes, for an unknown host, no scion, or options out of range; Cancelled likewise.
GraftResult graft(Tree& tree, NodeId host, const Tree& scion, const GraftOptions& options,
                  const Progress* progress = nullptr);

// The same for many hosts, one after another, so that later ones keep clear of earlier ones: each gets one of
// the scions and a seed of its own, drawn by options.seed and its place in the list. All or nothing.
std::vector<GraftResult> graft_many(Tree& tree, std::span<const NodeId> hosts, std::span<const Tree> scions,
                                    const GraftOptions& options, const Progress* progress = nullptr);

// Algorithm 8, as meant. wood: a scion, scaled, its root on the joint. Thins all of it evenly where its root
// is thicker than most = ratio * host_radius; where it is thinner and `blend`, thickens the start of its main
// branch to that; and leaves no node thicker than its parent, the host being the root's. Radii only.
void smooth_joint(Tree& wood, double host_radius, double ratio, bool blend);

// Algorithm 8 as printed: every node gets host_radius * ratio^depth, depth being 0 at the scion's root, which
// lies on the host; at least a nanometre. Radii only.
void smooth_by_depth(Tree& wood, double host_radius, double ratio);

}  // namespace treerec
