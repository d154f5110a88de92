#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "cases.h"
#include "error.h"
#include "fidelity/score.h"
#include "geometry/parallel.h"
#include "synth/grow.h"
#include "synth/habits.h"
#include "synth/scan.h"
#include "tree/measure.h"

namespace treerec {
namespace {

class Grown : public ::testing::TestWithParam<Habit> {};
INSTANTIATE_TEST_SUITE_P(Habits, Grown, ::testing::ValuesIn(all_habits()),
                         [](const auto& habit) { return habit_name(habit.param); });

TEST_P(Grown, IsASoundPlausibleTree) {
    for (uint64_t seed = 0; seed < 12; seed++) {
        const Tree tree = grow_tree({GetParam(), 0.0, seed});
        EXPECT_EQ(tree.check().value_or("sound"), "sound");
        const Measurements m = measure(tree);
        const HabitRules& rules = habit_rules(GetParam());
        EXPECT_GT(m.height, 0.8 * rules.least_height) << seed;
        EXPECT_LT(m.height, 1.3 * rules.most_height) << seed;
        if (GetParam() != Habit::kShrub) {
            EXPECT_NEAR(m.dbh, m.height / rules.slenderness, 0.35 * m.height / rules.slenderness) << seed;
            EXPECT_LE(m.stems, rules.leaders) << seed;
        }
        if (GetParam() != Habit::kPalm) {
            EXPECT_GE(m.by_order.size(), 3u) << seed;
            EXPECT_GT(m.crown_radius, 0.08 * m.height) << seed;
        }
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

TEST_P(Grown, HasTheStemsOfItsHabit) {
    for (uint64_t seed = 0; seed < 6; seed++) {
        const Tree tree = grow_tree({GetParam(), 0.0, seed});
        const int stems = habit_rules(GetParam()).stems;
        EXPECT_EQ(tree.node(tree.root()).child_count, stems) << seed;
        const DVec3 low = tree.node(tree.root()).position;
        NodeId at = tree.root();
        for (int i = 0; i < 8; i++)
            at = tree.node(at).first_child;
        const DVec3 up = glm::normalize(tree.node(at).position - low);
        const double lean = glm::degrees(std::acos(up.y));
        if (GetParam() == Habit::kLeaning) {
            EXPECT_GT(lean, 12.0) << seed;
        } else if (stems == 1) {
            EXPECT_LT(lean, 12.0) << seed;
        }
        if (GetParam() == Habit::kPalm) {
            EXPECT_EQ(measure(tree).tips, 1u) << seed;
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
    for (Habit habit : all_habits())
        for (double height : {1.0, 2.0, 25.0}) {
            // Giants take long.
            const bool all = test::is_long_run() && !test::kSanitized;
            if (height > 2.0 && !all && habit != Habit::kBroadleaf) continue;
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
    options.beam_exit = options.beam_divergence = 0.0;
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
    options.mixed = 0.8;
    const VirtualScan scan = scan_tree(tree, options);
    EXPECT_EQ(std::count(scan.origin.begin(), scan.origin.end(), kStray), 200);
    const auto mixed = std::count(scan.origin.begin(), scan.origin.end(), kMixedBeam);
    EXPECT_GT(mixed, 50);
    EXPECT_LT(mixed, 1500);
    options.mixed = 0.0;
    const VirtualScan pure = scan_tree(tree, options);
    EXPECT_EQ(std::count(pure.origin.begin(), pure.origin.end(), kMixedBeam), 0);
}

TEST(VirtualScanner, NamesTheWoodOfEveryPoint) {
    for (Habit habit : {Habit::kBroadleaf, Habit::kShrub, Habit::kPalm}) {
        const Tree tree = grow_tree({habit, 0.0, 4});
        VirtualScanOptions options = scan_options_for(habit);
        options.points = 15000;
        options.noise = 0.0;
        options.leaves = 0.4;
        const VirtualScan scan = scan_tree(tree, options);
        ASSERT_EQ(scan.node.size(), scan.cloud.size());
        size_t wood = 0;
        for (size_t i = 0; i < scan.cloud.size(); i++) {
            if (scan.origin[i] == kStray) {
                EXPECT_EQ(scan.node[i], kNoNode);
                continue;
            }
            ASSERT_TRUE(tree.contains(scan.node[i]));
            if (scan.origin[i] != kFromWood) continue;
            wood++;
            const Node& node = tree.node(scan.node[i]);
            const DVec3 from = tree.node(node.parent).position, p(scan.cloud.positions[i]);
            const DVec3 along = node.position - from;
            const double share = std::clamp(glm::dot(p - from, along) / glm::dot(along, along), 0.0, 1.0);
            const double distance = glm::distance(p, from + share * along);
            // A cone between its two radii; the beam's rim and its grazing noise on top.
            EXPECT_LT(distance, 1.15 * node.radius + 0.02) << habit_name(habit);
            EXPECT_GT(distance, 0.9 * node.radius - 0.02) << habit_name(habit);
        }
        EXPECT_GT(wood, 1000u) << habit_name(habit);
    }
}

TEST(VirtualScanner, AWideBeamThickensTwigs) {
    // A pole 6 mm thick and 10 m away on average: a beam of 7 mm finds them where its middle passes by.
    Tree tree;
    const NodeId root = tree.add_root(DVec3(0.0), 0.003);
    tree.add_child(root, DVec3(0, 3, 0), 0.003);
    const auto mean_distance = [&](double exit) {
        VirtualScanOptions options;
        options.points = 4000;
        options.noise = options.stray = options.mixed = options.beam_divergence = 0.0;
        options.beam_exit = exit;
        const VirtualScan scan = scan_tree(tree, options);
        double sum = 0.0;
        for (const Vec3& p : scan.cloud.positions)
            sum += glm::length(DVec2(p.x, p.z));
        return sum / static_cast<double>(scan.cloud.size());
    };
    EXPECT_NEAR(mean_distance(0.0), 0.003, 1e-4);
    EXPECT_GT(mean_distance(0.007), 0.0033);
    EXPECT_LT(mean_distance(0.007), 0.006);
}

TEST(VirtualScanner, FrondsAreLeavesAndButtressesAreWood) {
    const Tree palm = grow_tree({Habit::kPalm, 0.0, 1});
    VirtualScanOptions options = scan_options_for(Habit::kPalm);
    options.points = 10000;
    const VirtualScan fronds = scan_tree(palm, options);
    EXPECT_GT(std::count(fronds.origin.begin(), fronds.origin.end(), kFromLeaf), 2000);
    const Tree giant = grow_tree({Habit::kButtressed, 0.0, 1});
    const auto low_points = [&](int buttresses) {
        VirtualScanOptions scanning;
        scanning.points = 10000;
        scanning.buttresses = buttresses;
        scanning.stray = 0.0;
        const VirtualScan scan = scan_tree(giant, scanning);
        EXPECT_EQ(std::count(scan.origin.begin(), scan.origin.end(), kFromLeaf), 0);
        const double reach = 1.35 * giant.node(giant.root()).radius;
        return std::count_if(scan.cloud.positions.begin(), scan.cloud.positions.end(), [&](const Vec3& p) {
            return p.y < 1.0F && glm::length(DVec2(p.x, p.z)) > reach;
        });
    };
    EXPECT_LT(low_points(0), 20);
    EXPECT_GT(low_points(5), 100);
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
    options = {};
    options.beam_exit = -1.0;
    EXPECT_THROW(scan_tree(tree, options), Error);
    options = {};
    options.fronds = 1000;
    EXPECT_THROW(scan_tree(tree, options), Error);
    Tree lone;
    lone.add_root(DVec3(0.0), 0.1);
    EXPECT_THROW(scan_tree(lone, {}), Error);
}

}  // namespace
}  // namespace treerec
