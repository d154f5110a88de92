// Where the tree comes out of the ground - or, for a cut branch, its thick end.
#pragma once

#include <vector>

#include "skeleton/paths.h"
#include "skeleton/point_graph.h"

namespace treerec {

struct RootGuess {
    DVec3 position{0.0};          // centre of the base
    std::vector<PathSeed> seeds;  // the points of the base, with their distance above it
    bool lying = false;           // no trunk from below: a horizontal branch, rooted at its thick end
};

// The base is not the lowest point, which may be a stray one: it is the lowest part of the lowest group of
// linked points that is large enough to be wood. Where the cloud is much wider than high (a scanned branch),
// the far end with the widest cross-section is taken. points: tree space, metres.
RootGuess find_root(const std::vector<Vec3>& points, const PointGraph& graph, const LocalScale& scale);

}  // namespace treerec
