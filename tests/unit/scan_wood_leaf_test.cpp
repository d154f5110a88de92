#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <span>
#include <string>

#include "cases.h"
#include "geometry/parallel.h"
#include "geometry/random.h"
#include "scan/cleaning/clean_cloud.h"
#include "scan/formats/read_cloud.h"
#include "scan/leaves/wood_leaf.h"
#include "scan_samples.h"
#include "synth/grow.h"
#include "synth/scan.h"

namespace treerec {
namespace {

VirtualScan scan(Habit habit, double leaves, uint64_t seed, size_t points = 60000) {
    GrowOptions grow;
    grow.habit = habit;
    grow.seed = seed;
    VirtualScanOptions options = scan_options_for(habit);
    options.points = points;
    options.leaves = leaves;
    options.seed = seed;
    return scan_tree(grow_tree(grow), options);
}

struct Tally {
    double leaf_precision, leaf_recall, wood_precision, wood_recall, right;
};

// truth: 1 leaf, 0 wood, anything else does not count.
Tally tally(const std::vector<uint8_t>& leaf, const std::vector<uint8_t>& truth) {
    double hit[2][2] = {{0, 0}, {0, 0}};
    for (size_t i = 0; i < truth.size(); i++)
        if (truth[i] < 2) hit[truth[i]][leaf[i]]++;
    return {hit[1][1] / (hit[1][1] + hit[0][1]), hit[1][1] / (hit[1][1] + hit[1][0]),
            hit[0][0] / (hit[0][0] + hit[1][0]), hit[0][0] / (hit[0][0] + hit[0][1]),
            (hit[0][0] + hit[1][1]) / (hit[0][0] + hit[0][1] + hit[1][0] + hit[1][1])};
}

std::vector<uint8_t> truth_of(const VirtualScan& made) {
    std::vector<uint8_t> truth(made.origin.size());
    for (size_t i = 0; i < truth.size(); i++)
        truth[i] = made.origin[i] == kFromLeaf ? 1 : made.origin[i] == kFromWood ? 0 : 2;
    return truth;
}

TEST(WoodLeaf, ABareTreeIsLeftWhole) {
    for (const Habit habit : {Habit::kBroadleaf, Habit::kConifer, Habit::kBirch})
        for (const uint64_t seed : {5, 6}) {
            VirtualScan made = scan(habit, 0.0, seed, 30000);
            EXPECT_FALSE(tell_wood_from_leaves(made.cloud).foliage);
            made.cloud.colors.clear();
            EXPECT_FALSE(tell_wood_from_leaves(made.cloud).foliage);
        }
}

// Several passes, none in its place: what noise makes of twigs are no leaves.
TEST(WoodLeaf, NoiseIsNoLeaves) {
    for (const double noise : {0.02, 0.03, 0.05}) {
        for (int k = 1; k <= test::repeats(2); k++) {
            SCOPED_TRACE(noise);
            const auto seed = static_cast<uint64_t>(k);
            Random random(seed);
            PointCloud cloud;
            const VirtualScan made = scan(Habit::kBroadleaf, 0.0, seed, 40000);
            for (int copy = 0; copy < 6; copy++)
                for (const Vec3& p : made.cloud.positions)
                    cloud.positions.push_back(
                        p + Vec3(noise * DVec3(random.normal(), random.normal(), random.normal())));
            const WoodLeaf told = tell_wood_from_leaves(cloud);
            EXPECT_FALSE(told.foliage);
            EXPECT_LT(told.noise, 1.5 * noise);
            if (noise > 0.04) {
                EXPECT_GT(told.noise, 0.2 * noise);
            }
        }
    }
}

TEST(WoodLeaf, ShapeAloneTellsThemApart) {
    VirtualScan made = scan(Habit::kBirch, 0.8, 7, 90000);
    made.cloud.colors.clear();
    const WoodLeaf told = tell_wood_from_leaves(made.cloud);
    ASSERT_TRUE(told.foliage);
    EXPECT_FALSE(told.by_colour);
    const Tally t = tally(told.leaf, truth_of(made));
    EXPECT_GT(t.right, 0.85);
    EXPECT_GT(t.leaf_recall, 0.93);
    EXPECT_GT(t.leaf_precision, 0.85);
    EXPECT_GT(t.wood_precision, 0.7);
    EXPECT_GT(t.wood_recall, 0.35);  // leaves hang around every twig
}

TEST(WoodLeaf, FlatStripsOfLeafletsAreFrondsByShapeAlone) {
    for (const uint64_t seed : {1, 2, 11}) {
        SCOPED_TRACE(seed);
        VirtualScan made = scan(Habit::kPalm, 0.0, seed, 60000);
        made.cloud.colors.clear();
        const WoodLeaf told = tell_wood_from_leaves(made.cloud);
        ASSERT_TRUE(told.foliage);
        EXPECT_TRUE(told.fronds);
        EXPECT_GT(tally(told.leaf, truth_of(made)).leaf_recall, 0.97);
        // The skeleton follows hardly anything but the stem.
        double followed[2] = {0.0, 0.0};
        for (size_t i = 0; i < told.leaf.size(); i++)
            if (told.wood_path[i] && made.origin[i] < 2) followed[made.origin[i]]++;
        EXPECT_LT(followed[kFromLeaf], 0.05 * followed[kFromWood]);
    }
}

TEST(WoodLeaf, APalmIsAPalmHoweverBlurred) {
    const uint64_t seeds[] = {1, 2, 11};
    for (const double noise : {0.01, 0.02, 0.03}) {
        for (const uint64_t seed : std::span(seeds).first(static_cast<size_t>(test::repeats(3)))) {
            SCOPED_TRACE(noise);
            VirtualScanOptions options = scan_options_for(Habit::kPalm);
            options.points = 40000;
            options.noise = noise;
            options.seed = seed;
            VirtualScan made = scan_tree(grow_tree({Habit::kPalm, 0.0, seed}), options);
            made.cloud.colors.clear();
            const WoodLeaf told = tell_wood_from_leaves(made.cloud);
            ASSERT_TRUE(told.foliage);
            EXPECT_TRUE(told.fronds);
            EXPECT_GT(tally(told.leaf, truth_of(made)).leaf_recall, 0.9);
        }
    }
}

// A tall stem and, from its end, `count` branches that rise `rise` metres and hang down from there, with
// leaves around them: neither flat nor green. The branches join the stem over `along` metres of it.
PointCloud tuft(int count, double rise, double along, uint64_t seed) {
    Random random(seed);
    PointCloud cloud;
    const double height = 18.0;
    const auto put = [&](const DVec3& p) { cloud.positions.emplace_back(p); };
    for (int i = 0; i < 24000; i++) {
        const double turn = random.uniform(0.0, 6.2832);
        put({0.09 * std::cos(turn), random.uniform(0.0, height), 0.09 * std::sin(turn)});
    }
    for (int branch = 0; branch < count; branch++) {
        const double turn = 6.2832 * (branch + random.uniform(0.0, 0.3)) / count;
        const double base = height - along * random.uniform(0.0, 1.0);
        for (int i = 0; i < 3000; i++) {
            const double t = random.uniform(0.0, 1.0);
            const DVec3 at(1.6 * t * std::cos(turn), base + rise * t - 1.9 * t * t * t,
                           1.6 * t * std::sin(turn));
            const double thick = 0.05 + 0.1 * std::min(1.0, 4.0 * t);
            put(at + thick * DVec3(random.normal(), random.normal(), random.normal()));
        }
    }
    return cloud;
}

TEST(WoodLeaf, ATuftAroundTheEndOfATallStemIsAPalm) {
    for (int k = 1; k <= test::repeats(3); k++) {
        SCOPED_TRACE(k);
        const auto seed = static_cast<uint64_t>(k);
        const WoodLeaf palm = tell_wood_from_leaves(tuft(9, 0.8, 0.2, seed));
        ASSERT_TRUE(palm.foliage);
        EXPECT_TRUE(palm.fronds);
        EXPECT_GT(palm.reach, 1.5);
        EXPECT_LT(palm.reach, 3.0);
        // Branches that leave the stem one after another, or all rise, are a tree's.
        for (const PointCloud& tree : {tuft(9, 0.8, 4.0, seed), tuft(9, 3.5, 0.2, seed)}) {
            const WoodLeaf told = tell_wood_from_leaves(tree);
            EXPECT_TRUE(told.foliage);
            EXPECT_FALSE(told.fronds);
        }
    }
}

TEST(WoodLeaf, ColourTellsThemApartBetterEvenWhereLeavesAreFew) {
    for (const double leaves : {0.15, 0.8}) {
        const VirtualScan made = scan(Habit::kBroadleaf, leaves, 8, 40000);
        const WoodLeaf told = tell_wood_from_leaves(made.cloud);
        ASSERT_TRUE(told.foliage);
        EXPECT_TRUE(told.by_colour);
        const Tally t = tally(told.leaf, truth_of(made));
        EXPECT_GT(t.right, 0.85);
        EXPECT_GT(t.wood_recall, 0.6);
    }
}

TEST(WoodLeaf, EveryPointOfWoodIsFollowed) {
    const VirtualScan made = scan(Habit::kBirch, 0.8, 9);
    const WoodLeaf told = tell_wood_from_leaves(made.cloud);
    ASSERT_TRUE(told.foliage);
    size_t through_leaves = 0;
    for (size_t i = 0; i < told.leaf.size(); i++) {
        through_leaves += told.leaf[i] && told.wood_path[i];
        if (told.leaf[i] || told.wood_path[i]) continue;
        EXPECT_NE(made.origin[i], kFromWood);  // it could be grass
    }
    EXPECT_LT(through_leaves, told.leaf.size() / 3);
}

TEST(WoodLeaf, NeitherOrderNorThreadsMatter) {
    const VirtualScan made = scan(Habit::kConifer, 0.8, 10, 90000);
    std::vector<uint32_t> order(made.cloud.size());
    std::iota(order.begin(), order.end(), 0);
    Random random(3, 1);
    for (size_t i = order.size(); i > 1; i--)
        std::swap(order[i - 1], order[random.below(static_cast<uint32_t>(i))]);
    PointCloud shuffled;
    shuffled.frame = made.cloud.frame;
    for (const uint32_t i : order) {
        shuffled.positions.push_back(made.cloud.positions[i]);
        shuffled.colors.push_back(made.cloud.colors[i]);
    }
    const WoodLeaf first = tell_wood_from_leaves(made.cloud);
    ASSERT_TRUE(first.foliage);
    set_thread_count(3);
    const WoodLeaf second = tell_wood_from_leaves(shuffled);
    set_thread_count(0);
    for (size_t i = 0; i < order.size(); i++) {
        ASSERT_EQ(second.leaf[i], first.leaf[order[i]]);
        ASSERT_EQ(second.wood_path[i], first.wood_path[order[i]]);
    }
}

TEST(WoodLeaf, TinyAndFlatCloudsHaveNoLeaves) {
    PointCloud cloud;
    EXPECT_FALSE(tell_wood_from_leaves(cloud).foliage);
    for (int i = 0; i < 5000; i++)
        cloud.positions.emplace_back(0.0F, 0.001F * static_cast<float>(i), 0.0F);
    EXPECT_FALSE(tell_wood_from_leaves(cloud).foliage);
    cloud.positions.assign(5000, Vec3(1.0F));
    EXPECT_FALSE(tell_wood_from_leaves(cloud).foliage);
}

TEST(WoodLeaf, CanBeCancelled) {
    struct Stop final : Progress {
        bool cancelled() const override { return true; }
    } stop;
    const VirtualScan made = scan(Habit::kBirch, 0.5, 1, 5000);
    EXPECT_THROW(tell_wood_from_leaves(made.cloud, &stop), Cancelled);
}

TEST(WoodLeafScans, LeaflessTreesAreLeftWhole) {
    const char* folder = std::getenv("TREEREC_SCANS");
    if (!folder) GTEST_SKIP() << "TREEREC_SCANS does not name the folder of the real scans.";
    for (const char* file :
         {"wytham_Tf8_ash.txt", "wytham_Tf15_sycamore.txt", "wytham_Tf18_birch.txt", "vezy_A1B2.asc",
          "vezy_A3B4.asc", "vezy_A5B7.asc", "vezy_A5B8.asc", "vezy_A6B9.asc", "vezy_A6B10.asc",
          "adtree_Lille_11_leafoff_tall.xyz", "adtree_Lille_2_multistem.xyz", "adtree_tree7.xyz",
          "adtree_tree13_trunk_gap.xyz", "adtree_ahn3_delft_airborne_sparse.xyz", "rtwig_coffeetree.txt",
          "archi_tree2_leafoff.las", "voxr_tree_t0.asc", "voxr_tree_t1.asc"})
        EXPECT_FALSE(tell_wood_from_leaves(scan_test::upright_scan(file)).foliage) << file;
}

TEST(WoodLeafScans, NoisyLeaflessTreesAreLeftWhole) {
    const char* folder = std::getenv("TREEREC_SCANS");
    if (!folder) GTEST_SKIP() << "TREEREC_SCANS does not name the folder of the real scans.";
    Random random(1);
    for (const char* file : {"adtree_Lille_11_leafoff_tall.xyz", "adtree_Lille_2_multistem.xyz",
                             "adtree_tree7.xyz", "adtree_tree13_trunk_gap.xyz"}) {
        const PointCloud sharp = scan_test::upright_scan(file);
        for (const double noise : {0.02, 0.05}) {
            for (const int copies : {1, 10}) {
                PointCloud cloud;
                for (int copy = 0; copy < copies; copy++)
                    for (const Vec3& p : sharp.positions)
                        cloud.positions.push_back(
                            p + Vec3(noise * DVec3(random.normal(), random.normal(), random.normal())));
                EXPECT_FALSE(tell_wood_from_leaves(cloud).foliage)
                    << file << " " << noise << " m, " << copies;
            }
        }
    }
}

TEST(WoodLeafScans, LeafyTreesKeepAWayToTheirTopAndAPalmHasOneStem) {
    const char* folder = std::getenv("TREEREC_SCANS");
    if (!folder) GTEST_SKIP() << "TREEREC_SCANS does not name the folder of the real scans.";
    for (const char* file : {"rtls_leafy_urban.txt", "itsme_tropical_tree_1.txt",
                             "itsme_buttressed_tree_1.txt", "pytlidar_palm_1.las"}) {
        PointCloud cloud = scan_test::upright_scan(file);
        clean_cloud(cloud, {});
        const WoodLeaf told = tell_wood_from_leaves(cloud);
        ASSERT_TRUE(told.foliage) << file;
        // The tall tree is a palm, too, whose fronds the scan has blurred.
        const bool blurred = std::string(file).starts_with("itsme_tropical");
        const bool palm = blurred || std::string(file).starts_with("pytlidar_palm");
        EXPECT_EQ(told.fronds, palm) << file;
        EXPECT_FALSE(told.warnings.empty()) << file;
        float top = -1e30F, followed = -1e30F;
        size_t leaves_followed = 0;
        for (size_t i = 0; i < cloud.size(); i++) {
            top = std::max(top, cloud.positions[i].y);
            if (told.wood_path[i]) followed = std::max(followed, cloud.positions[i].y);
            leaves_followed += told.leaf[i] && told.wood_path[i];
        }
        EXPECT_LT(leaves_followed, cloud.size() / (palm ? 50 : 5)) << file;
        // A palm's fronds stand above their stem.
        if (!palm) {
            EXPECT_GT(followed, top - 0.1F) << file;
        } else {
            EXPECT_GT(followed, top - (blurred ? 2.0F : 4.0F));
            EXPECT_LT(followed, top - (blurred ? 0.5F : 3.0F));
            EXPECT_GT(told.reach, blurred ? 1.2 : 2.0);
            EXPECT_LT(told.reach, blurred ? 3.0 : 5.0);
        }
    }
}

TEST(WoodLeafScans, ABareTreeOfFewPointsIsBare) {
    const char* folder = std::getenv("TREEREC_SCANS");
    if (!folder) GTEST_SKIP() << "TREEREC_SCANS does not name the folder of the real scans.";
    for (const char* file : {"wytham_Tf8_ash.txt", "wytham_Tf15_sycamore.txt"}) {
        const PointCloud whole = scan_test::upright_scan(file);
        for (const double share : {0.15, 0.1, 0.07}) {
            Random random(4);
            PointCloud cloud;
            cloud.frame = whole.frame;
            for (const Vec3& p : whole.positions)
                if (random.uniform() < share) cloud.positions.push_back(p);
            EXPECT_FALSE(tell_wood_from_leaves(cloud).foliage) << file << ", " << cloud.size() << " points";
        }
    }
}

// Which points share a cell is chance; what kind of tree it is must not be.
TEST(WoodLeafScans, TurnedOrThinnedAPalmStaysOneAndNoOtherBecomesOne) {
    const char* folder = std::getenv("TREEREC_SCANS");
    if (!folder) GTEST_SKIP() << "TREEREC_SCANS does not name the folder of the real scans.";
    for (const char* file : {"itsme_tropical_tree_1.las", "pytlidar_palm_1.las",
                             "populus_sapling_normals.txt", "itsme_buttressed_tree_1.txt"}) {
        PointCloud cloud = scan_test::upright_scan(file);
        clean_cloud(cloud, {});
        const bool palm =
            std::string(file).starts_with("itsme_tropical") || std::string(file).starts_with("pytlidar_palm");
        Random random(3);
        const double angles[] = {0.0, 40.0, 130.0, 215.0};
        for (const double degrees : std::span(angles).first(static_cast<size_t>(test::repeats(4)))) {
            const double angle = glm::radians(degrees);
            const auto turn = [&](const Vec3& p) {
                return Vec3(std::cos(angle) * p.x - std::sin(angle) * p.z, p.y,
                            std::sin(angle) * p.x + std::cos(angle) * p.z);
            };
            PointCloud turned, thinned;
            for (const Vec3& p : cloud.positions) {
                turned.positions.push_back(turn(p));
                if (random.uniform() < 0.8) thinned.positions.push_back(turn(p));
            }
            EXPECT_EQ(tell_wood_from_leaves(turned).fronds, palm) << file << " turned by " << degrees;
            EXPECT_EQ(tell_wood_from_leaves(thinned).fronds, palm) << file << " thinned, by " << degrees;
        }
    }
}

TEST(WoodLeafScans, TheSplitTreeIsSplitAlike) {
    const char* folder = std::getenv("TREEREC_SCANS");
    if (!folder) GTEST_SKIP() << "TREEREC_SCANS does not name the folder of the real scans.";
    PointCloud both = read_cloud(std::string(folder) + "/clouds/gbsep_rc151_wood.txt");
    const size_t wood = both.size();
    const PointCloud leaves = read_cloud(std::string(folder) + "/clouds/gbsep_rc151_leaf.txt");
    for (const Vec3& p : leaves.positions)
        both.positions.emplace_back(DVec3(p) + leaves.frame.origin - both.frame.origin);
    OrientOptions upright;
    upright.up = UpAxis::kZ;
    upright.metres_per_unit = 1.0;
    orient_cloud(both, upright);
    std::vector<uint8_t> truth(both.size(), 1);
    std::fill_n(truth.begin(), wood, uint8_t{0});
    const WoodLeaf told = tell_wood_from_leaves(both);
    ASSERT_TRUE(told.foliage);
    const Tally t = tally(told.leaf, truth);
    EXPECT_GT(t.right, 0.92);
    EXPECT_GT(t.leaf_precision, 0.93);
    EXPECT_GT(t.leaf_recall, 0.95);
    EXPECT_GT(t.wood_precision, 0.85);
    EXPECT_GT(t.wood_recall, 0.78);
}

}  // namespace
}  // namespace treerec
