// Takes back branches that were grown through leaves.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "geometry/vec.h"
#include "progress.h"
#include "tree/tree.h"

namespace treerec {

// How the leaves were told that the skeleton was not grown through.
struct LeavesTold {
    double share = 0.0;  // of all points
    bool by_colour = false;
    bool grown_anew = false;  // without the points of what was dropped before
};

struct DroppedTwigs {
    double length = 0.0;        // metres of wood that went; the rest is empty where none did
    std::vector<uint8_t> leaf;  // by point: 1 for one that lay on it
};

// A stretch between forks is wood by a logistic rule: how leafy the points on its bark look, against all of
// the cloud; how much wood it carries, as the points that many shortest paths pass are wood in LeWoS (Wang,
// Momo Takoudjou and Casella 2020) and TLSeparation (Vicari et al. 2019); how straight and slender it is;
// and, among leaves, how long. Whole subtrees whose length is less likely wood, in sum, than a threshold go;
// of those that stay, nothing else changes. The threshold falls to none where nearly all points were told to
// be leaves; the trunk and the way to the tree's top always stay. points: the scan, in the tree's frame
// (metres). leafiness: by point, the logit of being leaf at even odds, or NaN where it was not looked at.
// Neither the order of the points nor the number of threads changes anything. O(points log nodes). Throws
// Cancelled, before anything is changed.
DroppedTwigs drop_leaf_twigs(Tree& tree, const std::vector<Vec3>& points, const std::vector<float>& leafiness,
                             const LeavesTold& told, const Progress& progress);

// What the rule knows of a stretch, and where it runs: for tests/bench/fit_leaves.py, which fits the weights.
inline constexpr size_t kTwigLooks = 12;
using TwigLooks = std::array<double, kTwigLooks>;
struct TwigSample {
    TwigLooks looks{};
    std::vector<DVec3> line;
};
// As drop_leaf_twigs() would see them, of a tree that is as large as usual (scan/usual_size.h).
std::vector<TwigSample> look_at_twigs(const Tree& tree, const std::vector<Vec3>& points,
                                      const std::vector<float>& leafiness, const Progress& progress);

}  // namespace treerec
