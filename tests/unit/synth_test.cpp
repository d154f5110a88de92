#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "error.h"
#include "fidelity/score.h"
#include "geometry/parallel.h"
#include "synth/grow.h"
#include "synth/scan.h"
#include "tree/measure.h"

namespace treerec {
namespace {

class Grown : public ::testing::TestWithParam<Habit> {};
INSTANTIATE_TEST_SUITE_P(Habits, Grown, ::testing::Values(Habit::kBroadleaf, Habit::kConifer, Habit::kBirch));

TEST_P(Grown, IsASoundPlausibleTree) {
    for (uint64_t seed = 0; seed < 12; seed++) {
        const Tree tree = grow_tree({GetParam(), 0.0, seed});
        EXPECT_EQ(tree.check().value_or("sound"), "sound");
        const Measurements m = measure(tree);
        EXPECT_GT(m.height, 7.0) << seed;
        EXPECT_LT(m.height, 20.0) << seed;
        EXPECT_GT(m.dbh, 0.1) << seed;
        EXPECT_LT(m.dbh, 0.6) << seed;
        EXPECT_GE(m.by_order.size(), 3u) << seed;
        EXPECT_GT(m.crown_radius, 1.0) << seed;
        EXPECT_EQ(tree.node(tree.root()).position, DVec3(0.0));
        for (NodeId id : tree.depth_first()) {
            const Node& node = tree.node(id);
            EXPECT_GE(node.position.y, 0.0);
            if (node.parent == kNoNode) continue;
            EXPECT_LE(node.radius, 1.0001 * tree.node(node.parent).radius)
                << "seed " << seed << " node " << id;
        }
    }
}

TEST_P(Grown, KeepsItsBranchesApart) {
    const Tree tree = grow_tree({GetParam(), 0.0, 5});
    const std::vector<NodeId> ids = tree.depth_first();
    // Nodes inside foreign wood, not near a common fork.
    size_t inside = 0;
    for (NodeId a : ids) {
        if (tree.node(a).radius < 0.01) continue;
        for (NodeId b : ids) {
            const double d = glm::distance(tree.node(a).position, tree.node(b).position);
            if (b == a || d > tree.node(a).radius) continue;
            NodeId at = b;
            int steps = 0;
            while (at != kNoNode && at != a && steps++ < 12)
                at = tree.node(at).parent;
            NodeId back = a;
            for (steps = 0; back != kNoNode && back != b && steps < 12; steps++)
                back = tree.node(back).parent;
            inside += at != a && back != b;
        }
    }
    EXPECT_LT(static_cast<double>(inside), 0.01 * static_cast<double>(ids.size()));
}

TEST_P(Grown, IsTheSameForTheSameSeedAndAnotherForAnother) {
    const Tree a = grow_tree({GetParam(), 10.0, 3}), b = grow_tree({GetParam(), 10.0, 3}),
               c = grow_tree({GetParam(), 10.0, 4});
    ASSERT_EQ(a.size(), b.size());
    for (NodeId id : a.depth_first()) {
        EXPECT_EQ(a.node(id).position, b.node(id).position);
        EXPECT_EQ(a.node(id).radius, b.node(id).radius);
    }
    EXPECT_TRUE(a.size() != c.size() || a.node(5).position != c.node(5).position);
}

TEST(Grow, RefusesNonsense) {
    EXPECT_THROW(grow_tree({Habit::kBirch, 0.2, 1}), Error);
    EXPECT_THROW(grow_tree({Habit::kBirch, std::nan(""), 1}), Error);
    EXPECT_THROW(parse_habit("cactus"), Error);
    for (const std::string& name : habit_names())
        EXPECT_NO_THROW(parse_habit(name));
}

TEST(Grow, HeightsFromASaplingToAGiant) {
    for (Habit habit : {Habit::kBroadleaf, Habit::kConifer, Habit::kBirch})
        for (double height : {1.0, 2.0, 25.0}) {
            const Tree tree = grow_tree({habit, height, 9});
            EXPECT_EQ(tree.check().value_or("sound"), "sound");
            EXPECT_GT(tree.size(), 5u);
            EXPECT_NEAR(measure(tree).height, height, 0.35 * height);
        }
}

TEST(VirtualScanner, PointsLieOnTheWoodWithinTheNoise) {
    const Tree tree = grow_tree({Habit::kBirch, 0.0, 1});
    VirtualScanOptions options;
    options.points = 20000;
    options.mixed = 0.0;
    options.stray = 0.0;
    options.noise = 0.0;
    // What is left is the difference between the tapered wood that is scanned and the cylinders that count.
    const ScanScore exact = score_scan(tree, scan_tree(tree, options).cloud);
    EXPECT_LT(exact.median_mm, 0.3);
    EXPECT_GT(exact.explained_2cm, 0.999);
    options.noise = 0.004;
    const ScanScore noisy = score_scan(tree, scan_tree(tree, options).cloud);
    EXPECT_GT(noisy.median_mm, exact.median_mm);
    EXPECT_LT(noisy.median_mm, 4.0);
    EXPECT_GT(noisy.explained_2cm, 0.99);
}

TEST(VirtualScanner, GivesAsManyPointsAsAskedFor) {
    const Tree tree = grow_tree({Habit::kBroadleaf, 0.0, 1});
    for (size_t points : {1, 100, 5000, 60000}) {
        VirtualScanOptions options;
        options.points = points;
        const VirtualScan scan = scan_tree(tree, options);
        EXPECT_EQ(scan.cloud.size(), points);
        EXPECT_EQ(scan.cloud.colors.size(), points);
        EXPECT_EQ(scan.origin.size(), points);
    }
}

TEST(VirtualScanner, IsTheSameOnAnyNumberOfThreads) {
    const Tree tree = grow_tree({Habit::kConifer, 0.0, 1});
    VirtualScanOptions options;
    options.points = 5000;
    options.leaves = 0.5;
    options.occlusion = 0.3;
    set_thread_count(1);
    const VirtualScan one = scan_tree(tree, options);
    set_thread_count(3);
    const VirtualScan three = scan_tree(tree, options);
    set_thread_count(0);
    EXPECT_EQ(one.cloud.positions, three.cloud.positions);
    EXPECT_EQ(one.cloud.colors, three.cloud.colors);
    options.seed = 2;
    EXPECT_NE(scan_tree(tree, options).cloud.positions, one.cloud.positions);
}

TEST(VirtualScanner, NearWoodIsDenserThanFarWood) {
    // A stem as thick at the top as at the base: the top is farther away and seen at a slant.
    Tree tree;
    const NodeId root = tree.add_root(DVec3(0.0), 0.2);
    tree.add_child(root, DVec3(0, 20, 0), 0.2);
    VirtualScanOptions options;
    options.points = 10000;
    const VirtualScan scan = scan_tree(tree, options);
    size_t low = 0, high = 0;
    for (const Vec3& p : scan.cloud.positions) {
        low += p.y < 5.0F;
        high += p.y > 15.0F;
    }
    EXPECT_GT(low, 2 * high);
}

TEST(VirtualScanner, LeavesHideWoodAndReturnPoints) {
    const Tree tree = grow_tree({Habit::kBroadleaf, 0.0, 1});
    const auto share = [&](double leaves, ScanOrigin what) {
        VirtualScanOptions options;
        options.points = 10000;
        options.leaves = leaves;
        const VirtualScan scan = scan_tree(tree, options);
        return static_cast<double>(std::count(scan.origin.begin(), scan.origin.end(), what)) / 10000.0;
    };
    EXPECT_EQ(share(0.0, kFromLeaf), 0.0);
    EXPECT_GT(share(0.0, kFromWood), 0.95);
    EXPECT_GT(share(0.3, kFromLeaf), 0.1);
    EXPECT_GT(share(1.0, kFromLeaf), share(0.3, kFromLeaf));
}

TEST(VirtualScanner, StrayAndMixedPointsComeInTheirShare) {
    const Tree tree = grow_tree({Habit::kBirch, 0.0, 1});
    VirtualScanOptions options;
    options.points = 10000;
    options.stray = 0.02;
    options.mixed = 0.2;
    const VirtualScan scan = scan_tree(tree, options);
    EXPECT_EQ(std::count(scan.origin.begin(), scan.origin.end(), kStray), 200);
    EXPECT_GT(std::count(scan.origin.begin(), scan.origin.end(), kMixedBeam), 100);
}

TEST(VirtualScanner, RefusesNonsense) {
    const Tree tree = grow_tree({Habit::kBirch, 5.0, 1});
    VirtualScanOptions options;
    options.points = 0;
    EXPECT_THROW(scan_tree(tree, options), Error);
    options = {};
    options.leaves = 2.0;
    EXPECT_THROW(scan_tree(tree, options), Error);
    options = {};
    options.noise = std::nan("");
    EXPECT_THROW(scan_tree(tree, options), Error);
    Tree lone;
    lone.add_root(DVec3(0.0), 0.1);
    EXPECT_THROW(scan_tree(lone, {}), Error);
}

}  // namespace
}  // namespace treerec
