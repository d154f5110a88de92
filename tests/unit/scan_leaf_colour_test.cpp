// Leaves that are told by their green, however much the light has bleached it.
#include "scan/leaves/leaf_colour.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

#include "geometry/quantile.h"
#include "geometry/random.h"
#include "scan/leaves/wood_leaf.h"
#include "scan_samples.h"
#include "synth/grow.h"
#include "synth/scan.h"

namespace treerec {
namespace {

// A stem of 3 m and so many metres' radius, under a ball of leaves; cells of a point each.
struct Painted {
    std::vector<Vec3> points;
    std::vector<Color8> colours;

    explicit Painted(double stem = 0.1) {
        Random random(9);
        scan_test::add_cylinder(points, random, {0, 0, 0}, {0, 3, 0}, stem, stem, 1500);
        for (int i = 0; i < 2000; i++)
            points.emplace_back(DVec3(0, 4.5, 0) + 1.5 * std::cbrt(random.uniform()) * random.direction());
    }

    // share: of the stem's points, and of the crown's, that are painted as leaves.
    GreenGroups part(const Color8& wood, const Color8& leaf, double on_stem = 0.0, double in_crown = 1.0) {
        Random random(4);
        colours.clear();
        for (const Vec3& p : points) {
            Color8 colour = random.uniform() < (p.y <= 3.0F ? on_stem : in_crown) ? leaf : wood;
            for (uint8_t& value : colour)
                value = static_cast<uint8_t>(value + random.below(9) - 4);
            colours.push_back(colour);
        }
        std::vector<uint32_t> cells(points.size());
        std::iota(cells.begin(), cells.end(), 0U);
        const std::vector<float> green = excess_green(colours, cells, points.size());
        return part_greens(green, std::vector<uint32_t>(points.size(), 1), points, cells);
    }
};

constexpr Color8 kBrown{60, 45, 40}, kGreen{70, 140, 60}, kDim{58, 63, 57}, kGrey{90, 90, 90};

TEST(LeafColour, ExcessGreenIsThatOfTheMeanColour) {
    const std::vector<float> green =
        excess_green({{0, 255, 0}, {255, 0, 255}, {10, 20, 30}, {0, 0, 0}}, {0, 0, 1, 2}, 3);
    ASSERT_EQ(green.size(), 3U);
    EXPECT_FLOAT_EQ(green[0], 0.0F);
    EXPECT_FLOAT_EQ(green[1], 0.0F);
    EXPECT_FLOAT_EQ(green[2], 0.0F);
    EXPECT_FLOAT_EQ(excess_green({{10, 40, 10}}, {0}, 1)[0], 1.0F);
}

TEST(LeafColour, GreenLeavesAreApartWhereverTheyAre) {
    Painted tree;
    for (const double on_stem : {0.0, 0.5}) {
        const GreenGroups groups = tree.part(kBrown, kGreen, on_stem, 0.9);
        EXPECT_TRUE(groups.apart);
        EXPECT_FALSE(groups.tinted);
        EXPECT_GT(greenness(0.55, groups), 0.4F);
        EXPECT_LT(greenness(-0.1, groups), -0.4F);
    }
}

TEST(LeafColour, ATintIsEnoughWhereTheFootHasNoneAndTheTopHas) {
    Painted tree;
    const GreenGroups groups = tree.part(kBrown, kDim);
    EXPECT_TRUE(groups.apart);
    EXPECT_TRUE(groups.tinted);
    EXPECT_NEAR(groups.share, 2000.0 / 3500.0, 0.05);
    EXPECT_TRUE(tree.part(kBrown, kDim, 0.05, 0.8).tinted);
}

TEST(LeafColour, ATintAloneTellsNothing) {
    Painted tree;
    EXPECT_FALSE(tree.part(kBrown, kDim, 0.5, 1.0).apart) << "moss";
    EXPECT_FALSE(tree.part(kBrown, kDim, 0.0, 0.4).apart) << "half of the crown is bare";
    EXPECT_FALSE(tree.part(kDim, kBrown).apart) << "upside down";
    EXPECT_FALSE(tree.part(kBrown, kGrey).apart) << "twigs against the sky";
    EXPECT_FALSE(tree.part(kGrey, kDim).apart) << "hardly another colour";
    EXPECT_FALSE(Painted(0.8).part(kBrown, kDim).apart) << "boughs to the ground";
}

// What the scan's colours become when the light is dim: so much of their difference from grey is left.
void bleach(PointCloud& cloud, double left) {
    Random random(6);
    for (Color8& colour : cloud.colors) {
        const double grey = (colour[0] + colour[1] + colour[2]) / 3.0;
        for (uint8_t& value : colour)
            value = static_cast<uint8_t>(
                std::clamp(grey + left * (value - grey) + 8.0 * random.normal(), 0.0, 255.0));
    }
}

VirtualScan dim_scan(Habit habit, double leaves) {
    GrowOptions grow;
    grow.habit = habit;
    grow.seed = 3;
    VirtualScanOptions options = scan_options_for(habit);
    options.points = 60000;
    options.leaves = leaves;
    options.seed = 3;
    VirtualScan made = scan_tree(grow_tree(grow), options);
    bleach(made.cloud, 0.4);
    return made;
}

TEST(LeafColour, WhereShapeAgreesBranchesAreToldFromLeavesAsEver) {
    const VirtualScan made = dim_scan(Habit::kBirch, 0.3);
    const WoodLeaf told = tell_wood_from_leaves(made.cloud);
    ASSERT_TRUE(told.foliage);
    size_t right = 0, known = 0, followed = 0;
    for (size_t i = 0; i < told.leaf.size(); i++) {
        followed += told.wood_path[i];
        if (made.origin[i] != kFromLeaf && made.origin[i] != kFromWood) continue;
        known++;
        right += (told.leaf[i] != 0) == (made.origin[i] == kFromLeaf);
    }
    EXPECT_GT(right, 0.75 * known);
    EXPECT_LT(followed, 0.7 * told.leaf.size());
}

TEST(LeafColour, APalmIsOneInAnyLight) {
    EXPECT_TRUE(tell_wood_from_leaves(dim_scan(Habit::kPalm, 0.5).cloud).fronds);
}

// Its stems were taken for leaves and half of its crown for wood: their bark is wavy. Against the sky, leaves
// are no more than tinted.
TEST(LeafColour, PhotosOfATreeInLeafShowItsStemsBare) {
    if (scan_test::scans_folder().empty())
        GTEST_SKIP() << "TREEREC_SCANS does not name the folder of the real scans.";
    PointCloud whole = scan_test::upright_scan("sfm_orchard_fused_canopy.ply");
    clean_cloud(whole, {});
    Random random(2);
    for (const double degrees : {0.0, 23.0, 63.0, 115.0, 240.0})
        for (const double kept : {1.0, 0.7, 0.4}) {
            const double angle = glm::radians(degrees);
            PointCloud cloud = whole;
            std::vector<uint8_t> keep;
            for (Vec3& p : cloud.positions) {
                p = Vec3(std::cos(angle) * p.x - std::sin(angle) * p.z, p.y,
                         std::sin(angle) * p.x + std::cos(angle) * p.z);
                keep.push_back(random.uniform() < kept);
            }
            cloud.keep_only(keep);
            const WoodLeaf told = tell_wood_from_leaves(cloud);
            ASSERT_TRUE(told.foliage) << degrees << " degrees, " << kept;
            EXPECT_FALSE(told.fronds);
            EXPECT_NEAR(told.leaf_share, 0.45, 0.05) << degrees << " degrees, " << kept;
            std::vector<float> heights;
            for (const Vec3& p : cloud.positions)
                heights.push_back(p.y);
            const double low = quantile(heights, 0.0), high = quantile(heights, 1.0);
            size_t foot = 0, leafy_foot = 0, top = 0, leafy_top = 0;
            for (size_t i = 0; i < cloud.size(); i++) {
                const double h = (cloud.positions[i].y - low) / (high - low);
                foot += h < 0.15;
                leafy_foot += h < 0.15 && told.leaf[i];
                top += h > 0.5;
                leafy_top += h > 0.5 && told.leaf[i];
                EXPECT_TRUE(told.wood_path[i]);
            }
            EXPECT_LT(leafy_foot, 0.01 * foot) << degrees << " degrees, " << kept;
            EXPECT_GT(leafy_top, 0.95 * top) << degrees << " degrees, " << kept;
        }
}

}  // namespace
}  // namespace treerec
