// Whether a tree is in leaf must not hang on how densely, from where or at which angle it was scanned.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "error.h"
#include "geometry/quantile.h"
#include "geometry/random.h"
#include "scan/formats/read_cloud.h"
#include "scan/leaves/wood_leaf.h"
#include "scan_samples.h"

namespace treerec {
namespace {

using scan_test::upright_scan;

// share: of the points; fading: at the top there are so many times fewer than at the foot.
PointCloud thinned(const PointCloud& cloud, double share, double fading = 1.0) {
    std::vector<float> heights;
    for (const Vec3& p : cloud.positions)
        heights.push_back(p.y);
    const double low = quantile(heights, 0.0), high = quantile(heights, 1.0);
    Random random(4);
    std::vector<uint8_t> keep;
    for (const Vec3& p : cloud.positions) {
        const double h = (p.y - low) / (high - low);
        keep.push_back(random.uniform() < share / (1.0 + (fading - 1.0) * h));
    }
    PointCloud few = cloud;
    few.keep_only(keep);
    return few;
}

PointCloud turned(const PointCloud& cloud, double degrees) {
    const double angle = glm::radians(degrees);
    PointCloud other = cloud;
    for (Vec3& p : other.positions)
        p = Vec3(std::cos(angle) * p.x - std::sin(angle) * p.z, p.y,
                 std::sin(angle) * p.x + std::cos(angle) * p.z);
    return other;
}

PointCloud wood_and_leaves() {
    PointCloud both = upright_scan("gbsep_rc151_wood.txt");
    const PointCloud leaves = upright_scan("gbsep_rc151_leaf.txt");
    for (size_t i = 0; i < leaves.size(); i++)
        both.positions.emplace_back(both.frame.to_tree(scan_test::scan_point(leaves, i)));
    return both;
}

TEST(LeafPresence, ALeafyTreeIsInLeafHoweverFewItsPoints) {
    if (scan_test::scans_folder().empty())
        GTEST_SKIP() << "TREEREC_SCANS does not name the folder of the real scans.";
    struct Case {
        PointCloud cloud;
        double share, fading;
    };
    const PointCloud urban = upright_scan("rtls_leafy_urban.txt");
    const PointCloud sapling = upright_scan("populus_sapling_normals.txt");
    const PointCloud palm = upright_scan("pytlidar_palm_1.las");
    const PointCloud split = wood_and_leaves();
    for (const Case& c :
         {Case{urban, 0.3, 1.0}, Case{urban, 0.12, 1.0}, Case{urban, 1.0, 7.0}, Case{sapling, 0.5, 1.0},
          Case{sapling, 0.2, 1.0}, Case{sapling, 1.0, 7.0}, Case{palm, 0.25, 1.0}, Case{palm, 0.18, 1.0},
          Case{palm, 1.0, 7.0}, Case{split, 0.12, 1.0}, Case{split, 0.06, 1.0}, Case{split, 0.3, 7.0}}) {
        const WoodLeaf told = tell_wood_from_leaves(thinned(c.cloud, c.share, c.fading));
        EXPECT_TRUE(told.foliage) << c.cloud.size() << " points, " << c.share << ", " << c.fading;
        EXPECT_GT(told.leaf_share, 0.4) << c.cloud.size() << " points, " << c.share << ", " << c.fading;
    }
}

TEST(LeafPresence, ABareTreeIsBareHoweverFewItsPoints) {
    if (scan_test::scans_folder().empty())
        GTEST_SKIP() << "TREEREC_SCANS does not name the folder of the real scans.";
    for (const char* file :
         {"wytham_Tf15_sycamore.txt", "wytham_Tf18_birch.txt", "voxr_tree_t1.asc", "archi_tree2_leafoff.las",
          "adtree_Lille_11_leafoff_tall.xyz", "adtree_Lille_2_multistem.xyz", "adtree_tree13_trunk_gap.xyz",
          "rtwig_coffeetree.txt", "gbsep_rc151_wood.txt"}) {
        const PointCloud whole = upright_scan(file);
        for (const double share : {0.5, 0.25, 0.12, 0.06})
            EXPECT_FALSE(tell_wood_from_leaves(thinned(whole, share)).foliage) << file << ", " << share;
        EXPECT_FALSE(tell_wood_from_leaves(thinned(whole, 1.0, 7.0)).foliage) << file << ", fading";
    }
}

TEST(LeafPresence, LeavesAroundTheFootAreNoBlur) {
    if (scan_test::scans_folder().empty())
        GTEST_SKIP() << "TREEREC_SCANS does not name the folder of the real scans.";
    PointCloud whole = upright_scan("sfm_orchard_fused_canopy.ply");
    whole.colors.clear();
    clean_cloud(whole, {});
    for (const double degrees : {0.0, 40.0, 90.0, 130.0}) {
        const WoodLeaf told = tell_wood_from_leaves(turned(whole, degrees));
        EXPECT_GT(told.leaf_share, 0.3) << degrees << " degrees";
        EXPECT_EQ(told.noise, 0.0) << degrees << " degrees";
    }
}

TEST(LeafPresence, TheBarkThatAMobileScannerSeesIsNoBlur) {
    const std::string folder = scan_test::scans_folder();
    if (folder.empty()) GTEST_SKIP() << "TREEREC_SCANS does not name the folder of the real scans.";
    PointCloud plot;
    try {
        plot = upright_scan("spanner_MLS_plot.laz");
    } catch (const Error& error) {
        GTEST_SKIP() << error.what();  // LAZ needs a library that is not everywhere
    }
    for (const size_t number : {1, 2, 6, 13}) {
        PointCloud tree = plot;
        CleanOptions options;
        options.pick.number = number;
        clean_cloud(tree, options);
        const WoodLeaf told = tell_wood_from_leaves(tree);
        EXPECT_GT(told.leaf_share, 0.7) << number;
        EXPECT_EQ(told.noise, 0.0) << number;
    }
}

TEST(LeafPresence, BlurredBareTreesStayBare) {
    if (scan_test::scans_folder().empty())
        GTEST_SKIP() << "TREEREC_SCANS does not name the folder of the real scans.";
    Random random(2);
    for (const char* file : {"wytham_Tf8_ash.txt", "wytham_Tf15_sycamore.txt", "wytham_Tf18_birch.txt",
                             "voxr_tree_t0.asc", "vezy_A3B4.asc", "archi_tree2_leafoff.las"}) {
        const PointCloud sharp = upright_scan(file);
        std::vector<float> heights;
        for (const Vec3& p : sharp.positions)
            heights.push_back(p.y);
        const double height = quantile(heights, 1.0) - quantile(heights, 0.0);
        for (const double noise : {0.0012, 0.0025, 0.005}) {
            PointCloud cloud = sharp;
            cloud.colors.clear();
            for (Vec3& p : cloud.positions)
                p += Vec3(noise * height * DVec3(random.normal(), random.normal(), random.normal()));
            EXPECT_FALSE(tell_wood_from_leaves(cloud).foliage) << file << ", " << noise << " of its height";
        }
    }
}

}  // namespace
}  // namespace treerec
