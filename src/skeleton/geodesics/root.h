// Where the tree comes out of the ground - or where a cut branch came off its tree.
#pragma once

#include <optional>
#include <vector>

#include "skeleton/geodesics/paths.h"
#include "skeleton/sampling/point_graph.h"

namespace treerec {

struct RootGuess {
    DVec3 position{0.0};          // centre of the base
    std::vector<PathSeed> seeds;  // the points of the base, with their distance above it
    bool lying = false;           // no trunk from below: a horizontal branch, rooted at its base
};

// The base is not the lowest point, which may be a stray one: it is the lowest part of the lowest group of
// linked points that is large enough to be wood. Where the cloud is much wider than high (a scanned branch),
// it is where find_base_end() says, unless a trunk stands there. stem_base: where a stem is known to stand;
// then it is the lowest part beside it, if there is any. points: tree space, metres.
RootGuess find_root(const std::vector<Vec3>& points, const PointGraph& graph, const LocalScale& scale,
                    const std::optional<DVec3>& stem_base, Progress& progress, PassSet left_out = {});

// Metres from the root to the farthest of the points.
double extent_from(const std::vector<Vec3>& points, const DVec3& root);

}  // namespace treerec
