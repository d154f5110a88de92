// Where branches end.
#include "skeleton/cylinders/tips.h"

#include <gtest/gtest.h>

#include "skeleton/skeleton.h"
#include "skeleton_test_clouds.h"

namespace treerec::test {
namespace {

constexpr double kShortest = 0.05;

std::vector<Station> line_of(std::initializer_list<double> heights, double radius) {
    std::vector<Station> line;
    for (const double y : heights) {
        line.emplace_back();
        line.back().position = DVec3(0.0, y, 0.0);
        line.back().radius = radius;
    }
    return line;
}

TEST(Tips, EndBeforeTheirFarthestPoint) {
    std::vector<std::vector<Station>> axes{line_of({0.0, 0.1, 0.2, 0.3}, 0.004)};
    const std::vector<SkeletonBranch> branches(1);
    draw_back_tips(axes, branches, kShortest);
    ASSERT_EQ(axes[0].size(), 4u);
    EXPECT_NEAR(axes[0].back().position.y, 0.292, 1e-9);
    EXPECT_DOUBLE_EQ(axes[0].back().radius, 0.004);
}

TEST(Tips, StationsNearerThanThatGo) {
    std::vector<std::vector<Station>> axes{line_of({0.0, 0.1, 0.294, 0.297, 0.3}, 0.004)};
    draw_back_tips(axes, std::vector<SkeletonBranch>(1), kShortest);
    ASSERT_EQ(axes[0].size(), 3u);
    EXPECT_NEAR(axes[0].back().position.y, 0.292, 1e-9);
}

TEST(Tips, OfCutWoodStay) {
    std::vector<std::vector<Station>> axes{line_of({0.0, 0.5, 1.0}, 0.05), line_of({0.0, 0.5, 1.0}, 0.005)};
    axes[1].back().measured = true;
    draw_back_tips(axes, std::vector<SkeletonBranch>(2), kShortest);
    EXPECT_EQ(axes[0].back().position.y, 1.0);
    EXPECT_EQ(axes[1].back().position.y, 1.0);
}

TEST(Tips, AForkAndAShortTwigStay) {
    // A side branch of 8 cm on the first one's last station but one, 2 mm before the tip.
    std::vector<std::vector<Station>> axes{line_of({0.0, 0.1, 0.298, 0.3}, 0.004),
                                           line_of({0.3, 0.34}, 0.01)};
    for (Station& station : axes[1])
        station.position.x += 0.01;
    std::vector<SkeletonBranch> branches(2);
    branches[1].parent = 0;
    branches[1].attach = 2;
    const std::vector<std::vector<Station>> before = axes;
    draw_back_tips(axes, branches, kShortest);
    for (size_t l = 0; l < axes.size(); l++) {
        ASSERT_EQ(axes[l].size(), before[l].size());
        for (size_t i = 0; i < axes[l].size(); i++)
            EXPECT_EQ(axes[l][i].position, before[l][i].position) << l << " " << i;
    }
}

// Shoots of 5 mm with round ends, scanned with 2 mm of noise.
TEST(Tips, OfScannedShootsAreWhereTheyAre) {
    Random random(31);
    PointCloud cloud;
    add_cone(cloud, random, {0, 0, 0}, {0, 3, 0}, 0.1, 0.09, 0.012, 0.002);
    std::vector<DVec3> ends;
    std::vector<DVec3> ways;
    for (int i = 0; i < 12; i++) {
        const double angle = 2.4 * i;
        const DVec3 out = glm::normalize(DVec3(std::cos(angle), 0.5, std::sin(angle)));
        const DVec3 from(0.09 * std::cos(angle), 0.5 + 0.2 * i, 0.09 * std::sin(angle));
        const DVec3 to = from + 0.25 * out;
        add_cone(cloud, random, from, to, 0.005, 0.005, 0.004, 0.002);
        for (int k = 0; k < 20; k++) {
            const DVec3 ball(random.normal(), random.normal(), random.normal());
            const DVec3 n = glm::normalize(ball);
            cloud.positions.emplace_back(to + (0.005 + 0.002 * random.normal()) *
                                                  (glm::dot(n, out) > 0.0 ? n : -n));
        }
        ends.push_back(to);
        ways.push_back(out);
    }
    const SkeletonResult result = skeletonize(cloud, {});
    const auto& frame = result.tree.frame();
    double beyond = 0.0;
    for (size_t i = 0; i < ends.size(); i++) {
        double nearest = 0.03;
        double along = 0.03;
        for (const NodeId tip : result.tree.nodes_of_kind(NodeKind::kLeaf)) {
            const DVec3 at = cloud.frame.to_tree(frame.to_scan(result.tree.node(tip).position));
            if (glm::distance(at, ends[i]) >= nearest) continue;
            nearest = glm::distance(at, ends[i]);
            along = glm::dot(at - ends[i], ways[i]);
        }
        beyond += along / static_cast<double>(ends.size());
    }
    EXPECT_LT(std::abs(beyond), 0.003);
}

}  // namespace
}  // namespace treerec::test
