#include "mesh/level_leaves.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include "geometry/bounds.h"
#include "mesh/leaf_cards.h"
#include "mesh/levels.h"

namespace treerec {

namespace {

constexpr double kStep = 1.0 / 16.0;  // of levels
constexpr double kBoughs = 0.45;      // of the single cards that a level would have
constexpr double kSpray = 1.5;        // times its own size: as large as a bough's card draws a spray, about
constexpr float kSpread = 1.05f;  // of a bough's edge over the root of its leaves' area: gaps between them
constexpr float kFacing = 1.0f;   // the way out of the crown over a leaf's own: how a bough faces
constexpr float kReach = 2.4f;    // deviations of its leaves from its middle: a bough is no larger
constexpr size_t kFewestBoughs = 24;  // as kFewest of leaf_cards.cpp is of single cards

Vec3 middle_of(const LeafPlacement& leaf) {
    return leaf.position + leaf.y * (0.5f * leaf.size);
}

// Parts `order` into `count` runs of leaves that are near each other, about as many in each.
void part(std::span<uint32_t> order, size_t count, const std::vector<Vec3>& middles,
          std::vector<std::span<uint32_t>>& runs) {
    if (count <= 1) {
        runs.push_back(order);
        return;
    }
    Bounds box;
    for (const uint32_t i : order)
        box.add(DVec3(middles[i]));
    const DVec3 size = box.size();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const size_t below = count / 2, at = order.size() * below / count;
    std::nth_element(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(at), order.end(),
                     [&](uint32_t a, uint32_t b) {
                         const float of_a = middles[a][axis], of_b = middles[b][axis];
                         return of_a != of_b ? of_a < of_b : a < b;
                     });
    part(order.first(at), below, middles, runs);
    part(order.subspan(at), count - below, middles, runs);
}

// Leaves that lie flat are seen from the side all the same: a bough of them is as deep as it is wide, and a
// card that lay as each of them does would show none. So it is turned half way to where it faces out of the
// crown.
void face_outwards(LeafPlacement& bough) {
    const float side = glm::dot(bough.z, bough.outward) < 0.0f ? -1.0f : 1.0f;
    const Vec3 face = bough.z + bough.outward * (kFacing * side);
    const Vec3 along = bough.y - face * (glm::dot(bough.y, face) / glm::dot(face, face));
    if (glm::length(along) < 1e-3f) return;
    bough.z = glm::normalize(face);
    bough.y = glm::normalize(along);
    bough.x = glm::cross(bough.y, bough.z);
}

LeafPlacement bough_of(std::span<const uint32_t> run, const std::vector<LeafPlacement>& leaves,
                       const std::vector<Vec3>& middles) {
    const auto count = static_cast<float>(run.size());
    Vec3 middle(0.0f), outward(0.0f);
    float area = 0.0f, occlusion = 0.0f, hue = 0.0f, largest = 0.0f;
    for (const uint32_t i : run) {
        middle += middles[i] / count;
        outward += leaves[i].outward / count;
        area += leaves[i].size * leaves[i].size;
        occlusion += leaves[i].occlusion / count;
        hue += leaves[i].hue / count;
        largest = std::max(largest, leaves[i].size);
    }
    uint32_t nearest = run[0];
    float deviation = 0.0f;
    for (const uint32_t i : run) {
        const float away = glm::distance(middles[i], middle);
        deviation += away * away / count;
        const float nearer = glm::distance(middles[nearest], middle);
        if (away < nearer || (away == nearer && i < nearest)) nearest = i;
    }
    LeafPlacement bough = leaves[nearest];
    if (glm::length(outward) > 1e-3f) bough.outward = glm::normalize(outward);
    face_outwards(bough);
    bough.size = std::min(kSpread * std::sqrt(area), largest + kReach * std::sqrt(deviation));
    bough.position = middle - bough.y * (0.5f * bough.size);
    bough.occlusion = occlusion;
    bough.hue = hue;
    return bough;
}

// Whether leaves of which such a share is kept are no larger than they may be.
bool grows_little(double share) {
    return share * kMostGrowth * kMostGrowth >= 1.0;
}

// The level by which so many leaves are thinned, from level 1 on: there, cards can't become simpler.
double affordable(size_t count, const LeafRules& rules, double level) {
    if (level < 0.5) return level;
    const auto triangles =
        static_cast<double>(build_leaf_card(rules, kMostLevels - 1).triangle_count() * count);
    double coarser = level;
    while (kept_share(coarser, count) * triangles > static_cast<double>(foliage_triangles(level)) &&
           grows_little(kept_share(coarser + kStep, count)))
        coarser += kStep;
    return coarser;
}

// Of so many leaves: as fine as a level is, or as they can afford.
Mesh card_of(const LeafRules& rules, double level, size_t count) {
    Mesh card;
    for (int form = std::min(static_cast<int>(level + 0.5), kMostLevels - 1); form < kMostLevels; form++) {
        card = build_leaf_card(rules, form);
        if (card.triangle_count() * count <= foliage_triangles(level)) break;
    }
    return card;
}

}  // namespace

std::vector<LeafPlacement> gather_boughs(const std::vector<LeafPlacement>& leaves, size_t count) {
    if (leaves.size() <= count) return leaves;
    std::vector<Vec3> middles;
    middles.reserve(leaves.size());
    for (const LeafPlacement& leaf : leaves)
        middles.push_back(middle_of(leaf));
    std::vector<uint32_t> order(leaves.size());
    std::iota(order.begin(), order.end(), 0u);
    std::vector<std::span<uint32_t>> runs;
    part(order, count, middles, runs);
    std::vector<LeafPlacement> boughs;
    boughs.reserve(runs.size());
    for (const std::span<uint32_t> run : runs)
        boughs.push_back(bough_of(run, leaves, middles));
    return boughs;
}

Mesh build_bough_card(int sprays) {
    const int across = std::clamp(sprays, 1, kMostSprays);
    const auto edge = static_cast<float>(across), row = static_cast<float>(kBoughRows * across);
    Mesh card;
    for (const Vec2 corner : {Vec2(-0.5f, 0.0f), Vec2(0.5f, 0.0f), Vec2(0.5f, 1.0f), Vec2(-0.5f, 1.0f)}) {
        card.positions.emplace_back(corner.x, corner.y, 0.0f);
        card.normals.emplace_back(0.0f, 0.0f, 1.0f);
        card.tangents.emplace_back(1.0f, 0.0f, 0.0f, 1.0f);
        card.uvs.emplace_back(edge * (corner.x + 0.5f), row + edge * (1.0f - corner.y));
        card.colors.emplace_back(0.0f, corner.y, 0.0f, 1.0f);
    }
    card.indices = {0, 1, 2, 0, 2, 3};
    return card;
}

LevelLeaves leaves_of_level(const std::vector<LeafPlacement>& leaves, const LeafRules& rules, double level,
                            bool limited) {
    LevelLeaves made;
    const double share = kept_share(level, leaves.size());
    const auto fewest = static_cast<double>(std::min(kFewestBoughs, leaves.size()));
    if (grows_little(share) || uses_blade_picture(rules)) {
        made.leaves = thin_leaves(leaves, limited ? affordable(leaves.size(), rules, level) : level);
        if (!made.leaves.empty()) made.card = card_of(rules, level, limited ? made.leaves.size() : 0);
        return made;
    }
    const auto all = static_cast<double>(leaves.size());
    const double most = limited ? 0.5 * static_cast<double>(foliage_triangles(level)) : all;
    const double boughs =
        std::max(std::min(kBoughs * leaf_share(level) * all, most), std::min(fewest, share * all));
    made.leaves = gather_boughs(leaves, static_cast<size_t>(boughs));
    const double growth = kSpread * std::sqrt(all / std::max(boughs, 1.0));
    if (!made.leaves.empty()) made.card = build_bough_card(static_cast<int>(growth / kSpray + 0.5));
    return made;
}

}  // namespace treerec
