#include "tree/measure.h"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/random.h"
#include "synth/grow.h"

namespace treerec {
namespace {

// A straight stem of height h, radius from r0 at the base to r1 at the top, in n pieces.
Tree stem(double height, double r0, double r1, int pieces) {
    Tree tree;
    NodeId at = tree.add_root(DVec3(0.0), r0);
    for (int i = 1; i <= pieces; i++) {
        const double t = static_cast<double>(i) / pieces;
        at = tree.add_child(at, DVec3(0.0, t * height, 0.0), r0 + (r1 - r0) * t, kMeasuredRadiusFlag);
    }
    return tree;
}

TEST(Measure, EmptyTreeAndLoneRootMeasureZero) {
    Tree tree;
    EXPECT_EQ(measure(tree).nodes, 0u);
    tree.add_root(DVec3(1.0), 0.1);
    const Measurements m = measure(tree);
    EXPECT_EQ(m.nodes, 1u);
    EXPECT_EQ(m.tips, 1u);
    EXPECT_EQ(m.dbh, 0.0);
    EXPECT_EQ(m.volume, 0.0);
    EXPECT_EQ(m.height, 0.0);
}

TEST(Measure, StemHasTheVolumeOfACone) {
    Random random(3);
    for (int i = 0; i < 50; i++) {
        const double h = random.uniform(2.0, 30.0), r0 = random.uniform(0.05, 0.5),
                     r1 = random.uniform(0.001, r0);
        const Measurements m = measure(stem(h, r0, r1, 1 + static_cast<int>(random.below(40))));
        EXPECT_NEAR(m.volume, kPi / 3.0 * h * (r0 * r0 + r0 * r1 + r1 * r1), 1e-9 * m.volume);
        EXPECT_NEAR(m.height, h, 1e-9);
        EXPECT_NEAR(m.dbh, 2.0 * (r0 + (r1 - r0) * kBreastHeight / h), 1e-9);
        EXPECT_NEAR(m.total_length, h, 1e-9);
        EXPECT_EQ(m.stems, 1);
        EXPECT_NEAR(m.measured_share, 1.0, 1e-12);
    }
}

TEST(Measure, BreastHeightRunsAlongALeaningTrunk) {
    Tree tree;
    const NodeId root = tree.add_root(DVec3(0.0), 0.20);
    tree.add_child(root, DVec3(3.0, 4.0, 0.0), 0.10);  // 5 m of wood, 4 m high
    const Measurements m = measure(tree);
    EXPECT_NEAR(m.dbh, 2.0 * (0.20 - 0.10 * 1.3 / 5.0), 1e-12);
    EXPECT_NEAR(m.height, 4.0, 1e-12);
}

// What is asked before a cloud is doubted to be a tree: twigs grown by the hundred must not drown the stem.
TEST(Measure, ManyInferredTwigsDoNotHideAMeasuredStem) {
    Tree tree = stem(2.0, 0.2, 0.15, 4);
    const NodeId top = tree.depth_first().back();
    for (int i = 0; i < 3000; i++)
        tree.add_child(top, DVec3(std::cos(i), 3.0, std::sin(i)), 0.002);
    const Measurements m = measure(tree);
    EXPECT_LT(m.measured_share, 0.001);
    EXPECT_GT(m.measured_volume_share, 0.5);
    EXPECT_LT(m.measured_volume_share, 1.0);
}

TEST(Measure, ABranchThatLiesBelowBreastHeightHasNoDbh) {
    Tree tree;
    const NodeId root = tree.add_root(DVec3(0.0), 0.03);
    tree.add_child(root, DVec3(2.0, 1.2, 0.0), 0.01);
    EXPECT_EQ(measure(tree).dbh, 0.0);
    EXPECT_EQ(measure(tree).stems, 0);
}

TEST(Measure, AStumpBelowBreastHeightHasNoDbh) {
    const Measurements m = measure(stem(1.0, 0.2, 0.2, 3));
    EXPECT_EQ(m.dbh, 0.0);
    EXPECT_EQ(m.stems, 0);
}

TEST(Measure, TwoStemsAndALowTwig) {
    Tree tree = stem(0.4, 0.2, 0.2, 2);
    const NodeId fork = tree.nodes_of_kind(NodeKind::kLeaf).front();
    tree.add_child(fork, DVec3(0.5, 8.0, 0.0), 0.15);
    tree.add_child(fork, DVec3(-0.5, 8.0, 0.0), 0.12);
    tree.add_child(fork, DVec3(0.0, 2.0, 2.0), 0.01);
    const Measurements m = measure(tree);
    EXPECT_EQ(m.stems, 2);
    EXPECT_NEAR(m.crown_base, 0.4, 1e-12);
    EXPECT_EQ(m.tips, 3u);
    ASSERT_EQ(m.by_order.size(), 2u);
    EXPECT_EQ(m.by_order[0].branches, 1u);
    EXPECT_EQ(m.by_order[1].branches, 2u);
}

TEST(Measure, ASideBranchStartsWithItsOwnThickness) {
    Tree tree = stem(10.0, 0.3, 0.3, 1);
    tree.add_child(tree.root(), DVec3(2.0, 0.0, 0.0), 0.01);
    const double trunk = kPi * 0.09 * 10.0, twig = kPi * 0.0001 * 2.0;
    EXPECT_NEAR(measure(tree).volume, trunk + twig, 1e-12);
}

TEST(Measure, CrownRadiusOfAWheelIsItsRadius) {
    Tree tree = stem(5.0, 0.1, 0.1, 2);
    const NodeId hub = tree.nodes_of_kind(NodeKind::kLeaf).front();
    for (int i = 0; i < 720; i++)
        tree.add_child(hub, DVec3(3.0 * std::cos(i * kPi / 360.0), 5.0, 3.0 * std::sin(i * kPi / 360.0)),
                       0.01);
    EXPECT_NEAR(measure(tree).crown_radius, 3.0, 1e-6);
}

TEST(Measure, OrdersAddUpToTheWholeTree) {
    for (uint64_t seed = 1; seed < 4; seed++) {
        const Tree tree = grow_tree({Habit::kBirch, 0.0, seed});
        const Measurements m = measure(tree);
        double length = 0.0;
        size_t branches = 0;
        for (const OrderMeasure& order : m.by_order) {
            length += order.length;
            branches += order.branches;
        }
        EXPECT_NEAR(length, m.total_length, 1e-6);
        EXPECT_EQ(branches, m.tips);  // every branch ends in one tip
    }
}

}  // namespace
}  // namespace treerec
