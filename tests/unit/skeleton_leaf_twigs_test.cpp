#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "fidelity/score.h"
#include "geometry/parallel.h"
#include "geometry/random.h"
#include "pipeline/reconstruct.h"
#include "scan/formats/read_cloud.h"
#include "skeleton/twigs/leaf_twigs.h"
#include "synth/grow.h"
#include "synth/scan.h"

namespace treerec {
namespace {

struct Found {
    Reconstruction result;
    SkeletonScore score;
};

Found find_again(Habit habit, double leaves, uint64_t seed, size_t points, double noise = 0.003) {
    const Tree truth = grow_tree({habit, 0.0, seed});
    VirtualScanOptions options = scan_options_for(habit);
    options.seed = seed;
    options.noise = noise;
    options.leaves = leaves;
    options.points = points;
    PointCloud cloud = scan_tree(truth, options).cloud;
    cloud.colors.clear();
    const std::string path = (std::filesystem::temp_directory_path() /
                              ("leaf_twigs_" + std::to_string(seed) + habit_name(habit) + ".ply"))
                                 .string();
    write_cloud(path, cloud);
    Found found;
    found.result = reconstruct_file(path, {});
    std::filesystem::remove(path);
    found.score = score_skeleton(found.result.tree, truth, nullptr, 0.004);
    return found;
}

// All of its wood was followed through leaves as well: precision was 0.14, the length five times too much.
TEST(LeafTwigs, ATreeInLeafIsNotGrownThroughItsLeaves) {
    const Found found = find_again(Habit::kLeaning, 0.8, 11, 51000);
    EXPECT_GT(found.score.match.precision, 0.4);
    EXPECT_GT(found.score.match.f, 0.4);
    EXPECT_LT(std::abs(found.score.length_error), 0.3);
    // What lay on the wood that went is foliage.
    EXPECT_GT(found.result.leaf_points, 15000U);
    EXPECT_FALSE(found.result.foliage.empty());
    ASSERT_EQ(found.result.wood.size(), found.result.cloud.size());
    EXPECT_EQ(std::count(found.result.wood.begin(), found.result.wood.end(), uint8_t{0}),
              static_cast<std::ptrdiff_t>(found.result.leaf_points));
    EXPECT_FALSE(found.result.tree.check());
}

TEST(LeafTwigs, HalfOfTheFoliageIsEnough) {
    for (const Habit habit : {Habit::kBroadleaf, Habit::kForked}) {
        const Found found = find_again(habit, 0.4, 12, 33000);
        EXPECT_GT(found.score.match.f, 0.35);
        EXPECT_LT(std::abs(found.score.length_error), 0.4);
    }
}

// Dense scans show leaves as surfaces: their stalks and edges became twigs, and the tree three times as long
// (851 m; precision was 0.31).
TEST(LeafTwigs, ADenseScanIsNotFollowedIntoEachLeaf) {
    const Found found = find_again(Habit::kForked, 0.3, 12, 500000);
    EXPECT_GT(found.score.match.precision, 0.75);
    EXPECT_GT(found.score.match.recall, 0.75);
    EXPECT_LT(std::abs(found.score.length_error), 0.2);
    // Grown anew without the leaves, the rest is no thicker than it was: 0.2 with them.
    EXPECT_LT(std::abs(found.score.radius_error), 0.15);
}

// Noise of 1 cm is wider than the gaps between so many points: all of it was told to be blurred wood, and the
// tree was eight times as long.
TEST(LeafTwigs, ADenseScanInLeafMayBeNoisy) {
    const Found found = find_again(Habit::kForked, 0.5, 22, 500000, 0.01);
    EXPECT_GT(found.result.leaf_points, 250000U);
    EXPECT_GT(found.score.match.precision, 0.5);
    EXPECT_LT(found.score.length_error, 0.3);
    EXPECT_GT(found.score.length_error, -0.7);
}

// Of so many points a sixth was averaged, which left the noise as wide as a birch's twigs are apart: the tree
// had 3,270 m of wood, nine times its own.
TEST(LeafTwigs, AllPointsOfANoisyScanShowItsLeavesTogether) {
    const Found found = find_again(Habit::kBirch, 0.9, 33, 1500000, 0.01);
    EXPECT_GT(found.result.leaf_points, 1200000U);
    EXPECT_LT(found.score.length_error, 0.3);
    EXPECT_GT(found.score.length_error, -0.7);
}

// Even their means lie on no surface where noise is 2 cm; but no bare tree's look so leafy.
TEST(LeafTwigs, NoiseOfTwoCentimetresHidesNoLeaves) {
    const Found found = find_again(Habit::kBirch, 0.9, 51, 500000, 0.02);
    EXPECT_GT(found.result.leaf_points, 400000U);
    EXPECT_GT(found.result.noise, 0.01);
    EXPECT_LT(found.score.length_error, 0.3);
    EXPECT_GT(found.score.length_error, -0.7);
}

TEST(LeafTwigs, ANoisyDenseScanWithoutLeavesIsWood) {
    for (const double noise : {0.01, 0.02}) {
        const Found found = find_again(Habit::kBroadleaf, 0.0, 31, 500000, noise);
        EXPECT_TRUE(found.result.wood.empty());
        EXPECT_GT(found.score.match.recall, noise < 0.02 ? 0.8 : 0.5);
    }
}

TEST(LeafTwigs, ABareTreeKeepsItsTwigs) {
    for (const Habit habit : {Habit::kBroadleaf, Habit::kConifer, Habit::kBirch}) {
        const Found found = find_again(habit, 0.0, 12, 15000);
        EXPECT_TRUE(found.result.wood.empty());
        EXPECT_GT(found.score.match.recall, 0.7);
    }
}

// Logits of what is leaf, and wood, beyond doubt.
constexpr float kLeafy = 8.0F, kWoody = -6.0F;

struct Sample {
    Tree tree;
    std::vector<Vec3> points;
    std::vector<float> leafiness;
};

// A stem with two branches, each with a twig. The one to the left, in leaf, ends at left_top; the other
// at 2.6.
Sample two_branches(double left_top = 2.5, double leafy_radius = 0.02) {
    Sample sample;
    Tree& tree = sample.tree;
    NodeId at = tree.add_root(DVec3(0.0), 0.1, kTrunkFlag);
    Random random(3);
    const auto grow = [&](NodeId from, const DVec3& to, double radius, float leafiness, uint8_t flags) {
        const DVec3 start = tree.node(from).position;
        const NodeId end = tree.add_child(from, to, radius, flags);
        for (int i = 0; i < 200; i++) {
            const DVec3 off(random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5);
            sample.points.emplace_back(start + random.uniform() * (to - start) +
                                       (radius / glm::length(off)) * off);
            sample.leafiness.push_back(leafiness + static_cast<float>(random.uniform()));
        }
        return end;
    };
    at = grow(at, {0.0, 2.0, 0.0}, 0.1, 2.0F, kTrunkFlag);
    for (const double side : {-1.0, 1.0}) {
        const float leafiness = side < 0.0 ? kLeafy : kWoody;
        const NodeId middle =
            grow(at, {side, 2.5, 0.0}, side < 0.0 ? 1.5 * leafy_radius : 0.01, leafiness, 0);
        grow(middle, {2.0 * side, side < 0.0 ? left_top : 2.6, 0.0}, side < 0.0 ? leafy_radius : 0.005,
             leafiness, 0);
        grow(middle, {side, 2.5, 0.3}, leafy_radius, kLeafy, 0);
    }
    // Leaves all around, so that little of the skeleton looks like wood.
    grow(at, {0.0, 2.0, 2.2}, 1.5 * leafy_radius, kLeafy, 0);
    grow(at, {0.0, 2.0, -2.2}, 1.5 * leafy_radius, kLeafy, 0);
    return sample;
}

TEST(LeafTwigs, BranchesWhosePointsLookLikeLeavesGoAndTheTrunkStays) {
    Sample sample = two_branches();
    const double kept = 2.0 + std::sqrt(1.25) + std::sqrt(1.01), gone = 1.6 + std::sqrt(1.25) + 4.4;
    const DroppedTwigs dropped =
        drop_leaf_twigs(sample.tree, sample.points, sample.leafiness, {}, SubProgress(nullptr, 0.0, 1.0));
    ASSERT_FALSE(sample.tree.check());
    ASSERT_EQ(sample.tree.size(), 4U);
    for (const NodeId id : sample.tree.depth_first())
        EXPECT_GE(sample.tree.node(id).position.x, 0.0);
    EXPECT_NEAR(dropped.length, gone, 1e-9);
    EXPECT_NEAR(measure(sample.tree).total_length, kept, 1e-9);
    ASSERT_EQ(dropped.leaf.size(), sample.points.size());
    size_t leaves = 0;
    for (size_t i = 0; i < sample.points.size(); i++) {
        leaves += dropped.leaf[i];
        if (sample.points[i].x < -0.2F) {
            EXPECT_EQ(dropped.leaf[i], 1) << i;
        }
        if (sample.points[i].y < 1.8F) {
            EXPECT_EQ(dropped.leaf[i], 0) << i;
        }
    }
    EXPECT_GT(leaves, 1000U);
}

// A tall conifer's leader was dropped with the needles around it, and the tree was five metres too low.
TEST(LeafTwigs, TheWayToTheTopStays) {
    Sample sample = two_branches(4.0);
    drop_leaf_twigs(sample.tree, sample.points, sample.leafiness, {}, SubProgress(nullptr, 0.0, 1.0));
    ASSERT_FALSE(sample.tree.check());
    EXPECT_EQ(sample.tree.size(), 6U);
    double top = 0.0;
    for (const NodeId id : sample.tree.depth_first())
        top = std::max(top, sample.tree.node(id).position.y);
    EXPECT_EQ(top, 4.0);
}

TEST(LeafTwigs, TheOrderOfThePointsAndTheThreadsChangeNothing) {
    Sample one = two_branches(), other = two_branches();
    std::reverse(other.points.begin(), other.points.end());
    std::reverse(other.leafiness.begin(), other.leafiness.end());
    const SubProgress progress(nullptr, 0.0, 1.0);
    const DroppedTwigs a = drop_leaf_twigs(one.tree, one.points, one.leafiness, {}, progress);
    DroppedTwigs b = drop_leaf_twigs(other.tree, other.points, other.leafiness, {}, progress);
    std::reverse(b.leaf.begin(), b.leaf.end());
    EXPECT_EQ(a.leaf, b.leaf);
    EXPECT_EQ(a.length, b.length);
    for (const int threads : {1, 2, 5}) {
        set_thread_count(threads);
        Sample again = two_branches();
        const DroppedTwigs c = drop_leaf_twigs(again.tree, again.points, again.leafiness, {}, progress);
        EXPECT_EQ(a.leaf, c.leaf);
        EXPECT_EQ(a.length, c.length);
    }
    set_thread_count(0);
}

// Where many points lie, only some of them have a voice; all that lie on what goes are leaves.
TEST(LeafTwigs, PointsWithoutAVoiceGoWithTheirBranch) {
    Sample all = two_branches(), some = two_branches();
    for (size_t i = 0; i < some.leafiness.size(); i++)
        if (i % 3 != 0) some.leafiness[i] = std::numeric_limits<float>::quiet_NaN();
    const SubProgress progress(nullptr, 0.0, 1.0);
    const DroppedTwigs a = drop_leaf_twigs(all.tree, all.points, all.leafiness, {}, progress);
    const DroppedTwigs b = drop_leaf_twigs(some.tree, some.points, some.leafiness, {}, progress);
    EXPECT_EQ(a.leaf, b.leaf);
    EXPECT_EQ(a.length, b.length);
}

TEST(LeafTwigs, WoodStaysWhereTheSkeletonLooksLikeWood) {
    Sample sample = two_branches(2.5, 0.005);
    const size_t nodes = sample.tree.size();
    for (float& logit : sample.leafiness)
        logit = -3.0F;
    const DroppedTwigs dropped =
        drop_leaf_twigs(sample.tree, sample.points, sample.leafiness, {}, SubProgress(nullptr, 0.0, 1.0));
    EXPECT_EQ(dropped.length, 0.0);
    EXPECT_TRUE(dropped.leaf.empty());
    EXPECT_EQ(sample.tree.size(), nodes);
}

}  // namespace
}  // namespace treerec
