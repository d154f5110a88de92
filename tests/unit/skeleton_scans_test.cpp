#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <string>

#include "scan/cleaning/clean_cloud.h"
#include "scan/formats/read_cloud.h"
#include "skeleton/skeleton.h"
#include "tree/measure.h"

namespace treerec {
namespace {

struct TapedTree {
    const char* file;
    double dbh;  // metres, by tape
};

class TapedTreeTest : public testing::TestWithParam<TapedTree> {};

TEST_P(TapedTreeTest, HasTheTapesDiameterAndTheCloudsHeight) {
    const char* folder = std::getenv("TREEREC_SCANS");
    if (!folder) GTEST_SKIP() << "TREEREC_SCANS does not name the folder of the real scans.";
    PointCloud cloud = read_cloud(std::string(folder) + "/clouds/" + GetParam().file);
    OrientOptions upright;
    upright.up = UpAxis::kZ;
    upright.metres_per_unit = 1.0;
    orient_cloud(cloud, upright);
    float low = cloud.positions.front().y;
    float high = low;
    for (const Vec3& p : cloud.positions) {
        low = std::min(low, p.y);
        high = std::max(high, p.y);
    }
    const SkeletonResult result = skeletonize(cloud, {});
    EXPECT_EQ(result.tree.check(), std::nullopt);
    const Measurements measures = measure(result.tree);
    EXPECT_NEAR(measures.dbh, GetParam().dbh, 0.05 * GetParam().dbh);
    EXPECT_NEAR(measures.height, high - low, 0.02 * (high - low));
    EXPECT_GT(result.tree.size(), 1000u);
    // Every twig, but no more nodes than its shape needs.
    EXPECT_LT(result.tree.size(), 5 * result.tree.nodes_of_kind(NodeKind::kLeaf).size());
}

INSTANTIATE_TEST_SUITE_P(Wytham, TapedTreeTest,
                         testing::Values(TapedTree{"wytham_Tf8_ash.txt", 0.242},
                                         TapedTree{"wytham_Tf15_sycamore.txt", 0.215},
                                         TapedTree{"wytham_Tf18_birch.txt", 0.1592}));

}  // namespace
}  // namespace treerec
