// Twigs grow one after another, the longest first.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

#include "progress.h"
#include "skeleton/branches/skeleton_branches.h"
#include "skeleton/cylinders/axis.h"
#include "skeleton/cylinders/bark.h"
#include "skeleton/geodesics/paths.h"
#include "skeleton/sampling/point_graph.h"
#include "skeleton/twigs/twigs.h"

namespace treerec {

// What twigs grow on, and where every point lies.
struct TwigField {
    const std::vector<Vec3>& points;
    const PointGraph& graph;
    const LocalScale& scale;
    const PathTree& paths;
    const TwigOptions& options;
    // Of the branches that are given; twigs are numbered on from there.
    const std::vector<std::vector<Station>>& axes;
    int32_t foot_end = 0;  // of the first branch: the first station above the foot
    std::vector<int32_t> branch =
        {};  // by point: the branch whose bark it lies on, -1 for none: a free point
    std::vector<int32_t> station = {};  // and the station there
    // By free point: metres from the nearest branch's bark, twigs left aside, and that branch's radius there;
    // where it is so far that it needs no escape, infinity and 0.
    std::vector<float> outside = {};
    std::vector<float> surface = {};
    std::vector<int32_t> nearest = {};  // by point, -1: scratch

    static constexpr double kMostTolerance = 0.02;

    // Metres off the bark: still explained by it.
    double tolerance(uint32_t v) const {
        constexpr double kTolerance = 0.12;  // point spacings
        constexpr double kLeastTolerance = 0.005;
        return std::clamp(kTolerance * scale.spacing[v], kLeastTolerance, kMostTolerance);
    }

    // Whether the branches given leave the point free; twigs may still explain it.
    bool may_escape(uint32_t v) const {
        return outside[v] >= required_escape(options.least_escape, surface[v]);
    }
};

// Ascending entries are from the farthest to the nearest: the bits of positive floats are in the order of
// their values, and all bits turned, the largest number becomes the least. length: metres from the wood.
inline uint64_t farthest_first(float length, uint32_t vertex) {
    return ~((static_cast<uint64_t>(std::bit_cast<uint32_t>(length)) << 32) | vertex);
}

struct GrownTwigs {
    std::vector<SkeletonBranch> branches;  // their parents are branches given, or these, numbered on
    std::vector<std::vector<Station>> axes;
    std::vector<uint64_t> tips;  // of each twig, ascending: the entry that it grew from
};

// Grows twigs from free points' entries in the queue, and notes the points on them. No twig reads or writes
// anything of free points but of those that edges between free points link to its own. Throws Cancelled.
GrownTwigs grow_one_by_one(TwigField& field, std::vector<uint64_t> tips, Progress& progress);

// The same on several threads: what such edges do not link grows at once. field: `branch` must not be
// negative at the paths' seeds.
GrownTwigs grow_twigs(TwigField& field, std::vector<uint64_t> tips, Progress& progress);

}  // namespace treerec
