// The leaves of a level of detail: single cards, or boughs that stand for many of them.
#pragma once

#include <vector>

#include "foliage/leaf_rules.h"
#include "foliage/leaves.h"
#include "mesh/mesh.h"

namespace treerec {

struct LevelLeaves {
    std::vector<LeafPlacement> leaves;
    Mesh card;  // of the leaves; empty without any

    size_t triangle_count() const { return leaves.size() * card.triangle_count(); }
};

// Down to where thin_leaves() would draw a leaf more than kMostGrowth times as large: those. Beyond, sprays
// are gathered into boughs: cards as large as it takes, whose picture is the spray's, drawn many times over
// (build_bough_card()). Rules whose card is not a spray have no boughs. level: not negative, may lie between
// two; has fewer cards the higher it is. Deterministic.
// limited: to foliage_triangles(), where cards can become fewer or flat.
LevelLeaves leaves_of_level(const std::vector<LeafPlacement>& leaves, const LeafRules& rules, double level,
                            bool limited = true);

inline constexpr double kMostGrowth = 2.0;

// `count` boughs, each in the place of as many leaves that are near each other. It lies and turns as the leaf
// nearest to their middle; its way out, occlusion and hue are their means. None without leaves; `leaves`
// themselves for no fewer than they are.
std::vector<LeafPlacement> gather_boughs(const std::vector<LeafPlacement>& leaves, size_t count);

// Two triangles. sprays: so many of them, and no more than kMostSprays, side by side along each edge. uv are
// (0..sprays, kBoughRows * sprays + 0..sprays): leaf.gdshader tells boughs by v > 1, scatters the sprays and
// leaves some out along the edge; a material without it that repeats its picture shows rows of them.
Mesh build_bough_card(int sprays);

inline constexpr int kBoughRows = 16;  // kBoughRows of leaf_picture.gdshaderinc
inline constexpr int kMostSprays = 12;

}  // namespace treerec
