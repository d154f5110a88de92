#include "mesh/twig_shares.h"

#include <algorithm>
#include <cmath>

#include "geometry/portable_math.h"
#include "geometry/random.h"
#include "mesh/levels.h"

namespace treerec {

namespace {

constexpr double kGolden = 0.61803398874989485;
constexpr double kLeastShare = 1e-4;
constexpr double kMeanRadius = 0.6;  // of a twig, over that of its foot
constexpr double kLeastLength =
    0.005;  // over the tree's height, doubled per level: shorter ones are no silhouette
constexpr uint64_t kSeed = 0x7e1f;

}  // namespace

std::vector<float> share_twigs(const Tree& tree, const BranchList& list, const Crown& crown,
                               double coarseness) {
    const size_t count = list.branches.size();
    std::vector<float> standing(count, 1.0f);
    if (coarseness <= 0.0) return standing;
    const double width = level_width(crown.height, coarseness);
    const double length = kLeastLength * crown.height * portable::pow(2.0, coarseness);
    std::vector<double> share(count, 1.0);  // of twigs of such a width that stay
    std::vector<uint32_t> borne(count, 0);  // branches on it that were met so far
    for (size_t i = 0; i < count; i++) {
        const Branch& branch = list.branches[i];
        if (branch.attach == kNoNode) continue;
        const size_t host = static_cast<size_t>(branch.parent);
        if (standing[host] == 0.0f) {
            standing[i] = 0.0f;
            continue;
        }
        const double radius = kMeanRadius * tree.node(list.nodes[branch.begin]).radius;
        share[i] = std::clamp(2.0 * radius / width, kLeastShare, share[host]);
        // Multiples of the golden ratio spread evenly, so that every stretch of a branch keeps its share.
        const NodeId tip = list.nodes[list.branches[host].end - 1];
        const double start =
            static_cast<double>(hash_seed(kSeed, static_cast<uint64_t>(tip)) >> 11) * 0x1p-53;
        const double turn = start + kGolden * borne[host]++;
        if (turn - std::floor(turn) >= share[i] / share[host] || branch.length < length)
            standing[i] = 0.0f;
        else
            standing[i] = static_cast<float>(1.0 / share[i]);
    }
    return standing;
}

}  // namespace treerec
