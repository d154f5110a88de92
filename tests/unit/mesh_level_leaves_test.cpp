// Boughs: from afar a card stands for many sprays, and shows as many.
#include "mesh/level_leaves.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "mesh/leaf_cards.h"
#include "mesh/levels.h"
#include "random_tree.h"

namespace treerec {
namespace {

Vec3 middle(const LeafPlacement& leaf) {
    return leaf.position + leaf.y * (0.5f * leaf.size);
}

double area(const std::vector<LeafPlacement>& leaves) {
    double sum = 0.0;
    for (const LeafPlacement& leaf : leaves)
        sum += static_cast<double>(leaf.size) * leaf.size;
    return sum;
}

// Times its own size: as large as a level draws a spray.
double growth(const LevelLeaves& made, const std::vector<LeafPlacement>& all) {
    const auto mean = [](const std::vector<LeafPlacement>& leaves) {
        return std::sqrt(area(leaves) / static_cast<double>(leaves.size()));
    };
    float sprays = 0.0f;
    for (const Vec2& uv : made.card.uvs)
        sprays = std::max(sprays, uv.x);
    return mean(made.leaves) / mean(all) / sprays;
}

// At level 3 a birch was a heap of leaves of nearly four times their size.
TEST(LevelLeaves, NoneIsDrawnMoreThanTwiceAsLarge) {
    for (const char* look : {"birch", "maple", "oak", "spruce"})
        for (uint64_t seed = 1; seed < 4; seed++) {
            const LeafRules rules = leaf_preset(look);
            const std::vector<LeafPlacement> all = place_leaves(test::random_tree(seed, 3000), rules, seed);
            size_t before = all.size() + 1;
            for (double level = 0.0; level < kMostLevels; level += 0.25) {
                SCOPED_TRACE(std::string(look) + " " + std::to_string(level));
                const LevelLeaves made = leaves_of_level(all, rules, level);
                ASSERT_FALSE(made.leaves.empty());
                EXPECT_LT(growth(made, all), 2.05);
                EXPECT_LE(made.leaves.size(), before);
                before = made.leaves.size();
            }
            EXPECT_LT(before, all.size() / 40);
        }
}

TEST(LevelLeaves, BoughsAreWhereTheirLeavesAre) {
    const std::vector<LeafPlacement> all = place_leaves(test::random_tree(5, 3000), leaf_preset("birch"), 1);
    for (const size_t count : {size_t{1}, size_t{7}, size_t{100}, all.size() / 10}) {
        const std::vector<LeafPlacement> boughs = gather_boughs(all, count);
        ASSERT_EQ(boughs.size(), count);
        Vec3 sum(0.0f), of_boughs(0.0f);
        for (const LeafPlacement& leaf : all)
            sum += middle(leaf) / static_cast<float>(all.size());
        for (const LeafPlacement& bough : boughs) {
            of_boughs += middle(bough) / static_cast<float>(count);
            ASSERT_NEAR(glm::length(bough.outward), 1.0f, 1e-3f);
            ASSERT_NEAR(glm::dot(glm::cross(bough.x, bough.y), bough.z), 1.0f, 1e-3f);
            ASSERT_TRUE(bough.size > 0.0f && std::isfinite(bough.size));
            EXPECT_TRUE(std::any_of(all.begin(), all.end(), [&](const LeafPlacement& leaf) {
                return leaf.phase == bough.phase && leaf.wind == bough.wind;
            })) << "It moves as none of its leaves does.";
        }
        EXPECT_LT(glm::distance(sum, of_boughs), 0.05f);
        EXPECT_LT(area(boughs), 1.6 * area(all));
    }
}

TEST(LevelLeaves, FewLeavesStayAndNoneIsNone) {
    const std::vector<LeafPlacement> all = place_leaves(test::random_tree(5, 300), leaf_preset("birch"), 1);
    const std::vector<LeafPlacement> few(all.begin(), all.begin() + 20);
    for (int level = 0; level < kMostLevels; level++)
        EXPECT_EQ(leaves_of_level(few, leaf_preset("birch"), level).leaves.size(), few.size()) << level;
    EXPECT_EQ(gather_boughs(few, 20).size(), 20u);
    EXPECT_EQ(gather_boughs(few, 0).size(), 1u);
    const LevelLeaves none = leaves_of_level({}, leaf_preset("birch"), 3);
    EXPECT_TRUE(none.leaves.empty() && none.card.positions.empty());
}

// Their picture is that of one blade, which its own strips show in parts.
TEST(LevelLeaves, OnlySpraysAreGathered) {
    LeafRules rules = leaf_preset("birch");
    rules.form = LeafForm::kPinnate;
    const std::vector<LeafPlacement> all = place_leaves(test::random_tree(5, 3000), rules, 1);
    for (const double level : {2.0, 3.0}) {
        const LevelLeaves made = leaves_of_level(all, rules, level);
        EXPECT_EQ(made.leaves.size(), thin_leaves(all, level).size());
        for (const Vec2& uv : made.card.uvs)
            EXPECT_LE(std::max(uv.x, uv.y), 1.0f);
    }
}

TEST(LevelLeaves, ABoughsCardIsAsTheShaderTakesIt) {
    for (int sprays = -1; sprays < 20; sprays++) {
        const Mesh card = build_bough_card(sprays);
        ASSERT_EQ(card.triangle_count(), 2u);
        const int across = std::clamp(sprays, 1, kMostSprays);
        float widest = 0.0f;
        for (size_t i = 0; i < card.uvs.size(); i++) {
            // leaf_picture.gdshaderinc: sprays = floor(v / kBoughRows).
            EXPECT_EQ(static_cast<int>(card.uvs[i].y / kBoughRows), across);
            EXPECT_LE(card.uvs[i].y - static_cast<float>(kBoughRows * across), static_cast<float>(across));
            widest = std::max(widest, card.uvs[i].x);
        }
        EXPECT_EQ(widest, static_cast<float>(across));
    }
}

}  // namespace
}  // namespace treerec
