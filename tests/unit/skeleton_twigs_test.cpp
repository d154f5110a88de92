// What counts as a twig, and where a stem stands.
#include <gtest/gtest.h>

#include "skeleton/skeleton.h"
#include "skeleton_test_clouds.h"

namespace treerec::test {
namespace {

size_t tips(const Tree& tree) {
    return tree.nodes_of_kind(NodeKind::kLeaf).size();
}

DVec3 in_cloud(const Tree& tree, const PointCloud& cloud, NodeId id) {
    return cloud.frame.to_tree(tree.frame().to_scan(tree.node(id).position));
}

PointCloud stem(uint64_t seed, double noise) {
    Random random(seed);
    PointCloud cloud;
    add_cone(cloud, random, {0, 0, 0}, {0, 3, 0}, 0.1, 0.09, 0.012, noise);
    return cloud;
}

TEST(Twigs, AShootOnAStemIsFound) {
    PointCloud cloud = stem(1, 0.002);
    Random random(2);
    const DVec3 from(0.095, 1.5, 0.0);
    const DVec3 to(0.35, 1.75, 0.05);
    add_cone(cloud, random, from, to, 0.004, 0.002, 0.006, 0.0005);
    const SkeletonResult result = skeletonize(cloud, {});
    ASSERT_EQ(result.tree.check(), std::nullopt);
    EXPECT_EQ(tips(result.tree), 2u);
    double nearest = 1e9;
    for (NodeId tip : result.tree.nodes_of_kind(NodeKind::kLeaf))
        nearest = std::min(nearest, glm::distance(in_cloud(result.tree, cloud, tip), to));
    EXPECT_LT(nearest, 0.02);
}

TEST(Twigs, ASingleFileOfPointsIsATwig) {
    PointCloud cloud = stem(3, 0.002);
    for (int i = 0; i <= 12; i++)
        cloud.positions.emplace_back(DVec3(0.1, 2.0, 0.0) +
                                     (0.02 * i) * glm::normalize(DVec3(1.0, 0.6, 0.2)));
    const SkeletonResult result = skeletonize(cloud, {});
    EXPECT_EQ(tips(result.tree), 2u);
}

// Shorter than the shortest branch: what many points show is wood, what two points show may be anything.
TEST(Twigs, AShortShootIsATwigIfManyPointsShowIt) {
    for (const int count : {2, 12}) {
        PointCloud cloud;
        Random random(10);
        add_cone(cloud, random, {0, 0, 0}, {0, 1, 0}, 0.006, 0.004, 0.003, 0.0005);
        for (int i = 1; i <= count; i++)
            cloud.positions.emplace_back(0.005 + 0.038 * i / count, 0.5 + 0.01 * i / count, 0.0);
        const SkeletonResult result = skeletonize(cloud, {});
        ASSERT_EQ(result.tree.check(), std::nullopt);
        EXPECT_EQ(tips(result.tree), count > 2 ? 2u : 1u) << count;
        if (count == 2) continue;
        // From the last fork on, it is a branch.
        double shortest = 1e9;
        for (NodeId tip : result.tree.nodes_of_kind(NodeKind::kLeaf)) {
            double length = 0.0;
            for (NodeId id = tip; result.tree.node(id).parent != kNoNode; id = result.tree.node(id).parent) {
                const NodeId parent = result.tree.node(id).parent;
                length += glm::distance(result.tree.node(id).position, result.tree.node(parent).position);
                const NodeId first = result.tree.node(parent).first_child;
                if (result.tree.node(first).next_sibling != kNoNode) break;
            }
            shortest = std::min(shortest, length);
        }
        EXPECT_GE(shortest, 0.05);
    }
}

TEST(Twigs, TwoStrayPointsOnAStemAreNone) {
    PointCloud cloud = stem(9, 0.002);
    cloud.positions.emplace_back(0.135, 1.0, 0.0);
    cloud.positions.emplace_back(0.175, 1.02, 0.0);
    cloud.positions.emplace_back(-0.165, 2.0, 0.01);
    const SkeletonResult result = skeletonize(cloud, {});
    EXPECT_EQ(tips(result.tree), 1u);
}

TEST(Twigs, StubsNoiseAndBarkReliefAreNone) {
    PointCloud cloud = stem(4, 0.006);
    Random random(5);
    // A stub of 3 cm and a ridge along the stem, 2 cm high.
    add_cone(cloud, random, {0.095, 1.2, 0.0}, {0.125, 1.22, 0.0}, 0.006, 0.005, 0.004, 0.001);
    for (int i = 0; i < 400; i++)
        cloud.positions.emplace_back(-0.09 - 0.02 * random.uniform(), 0.8 + 1.5 * random.uniform(),
                                     0.01 * random.normal());
    const SkeletonResult result = skeletonize(cloud, {});
    EXPECT_EQ(tips(result.tree), 1u);
}

// What blur puts beside the bark is part of the wood.
TEST(Twigs, BlurredWoodIsAsThickAsAllItsPointsSay) {
    double thick = 0.0;
    int count = 0;
    constexpr double kRadius = 0.01;
    for (const uint64_t seed : {11, 12, 13, 14, 15, 16}) {
        PointCloud cloud = stem(seed, 0.003);
        Random random(seed + 10);
        add_cone(cloud, random, {0.095, 1.5, 0.0}, {0.8, 2.2, 0.1}, kRadius, kRadius, 0.01, 0.004);
        const SkeletonResult result = skeletonize(cloud, {});
        for (NodeId id = 0; id < result.tree.id_end(); id++) {
            if (!result.tree.contains(id)) continue;
            const DVec3 p = in_cloud(result.tree, cloud, id);
            if (p.x < 0.2 || p.x > 0.7) continue;
            thick += result.tree.node(id).radius;
            count++;
        }
    }
    ASSERT_GT(count, 0);
    EXPECT_NEAR(thick / count, kRadius, 0.07 * kRadius);
}

TEST(Twigs, NoneGrowFromNoise) {
    for (double noise : {0.01, 0.02}) {
        const SkeletonResult result = skeletonize(stem(6, noise), {});
        EXPECT_EQ(tips(result.tree), 1u) << noise;
    }
}

// The lowest points are those of a root spur beside the stem.
TEST(Base, StandsUnderItsStem) {
    PointCloud cloud = stem(7, 0.002);
    Random random(8);
    add_cone(cloud, random, {0.05, 0.12, 0.0}, {0.32, -0.06, 0.0}, 0.05, 0.02, 0.01, 0.002);
    const SkeletonResult result = skeletonize(cloud, {});
    const DVec3 root = in_cloud(result.tree, cloud, result.tree.root());
    EXPECT_LT(std::hypot(root.x, root.z), 0.06);
    EXPECT_LT(root.y, 0.05);
}

// A stem that really bends at its base stays bent.
TEST(Base, ASweptBaseStays) {
    Random random(9);
    PointCloud cloud;
    std::vector<DVec3> line;
    for (int i = 0; i <= 20; i++) {
        const double y = 0.05 * i;
        line.emplace_back(0.4 * (1.0 - y) * (1.0 - y), y, 0.0);
    }
    add_bend(cloud, random, line, 0.1, 0.1, 0.012, 0.002);
    add_cone(cloud, random, {0, 1, 0}, {0, 4, 0}, 0.1, 0.08, 0.012, 0.002);
    const SkeletonResult result = skeletonize(cloud, {});
    const DVec3 root = in_cloud(result.tree, cloud, result.tree.root());
    EXPECT_NEAR(root.x, 0.4, 0.1);
}

}  // namespace
}  // namespace treerec::test
