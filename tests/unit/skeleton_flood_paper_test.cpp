// The flood as Zhang 2013 prints it.
#include "skeleton/flood/flood_paper.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "geometry/segment.h"
#include "skeleton/skeleton.h"
#include "skeleton_test_clouds.h"

namespace treerec {
namespace {

class Silent final : public Progress {};

Tree two_nodes(const DVec3& a, const DVec3& b, double radius) {
    return Tree::from_arrays({-1, 0}, {a, b}, {radius, radius}, {0, 0});
}

// Evenly in a box: nothing of what is asked depends on where.
std::vector<Vec3> box_of_points(Random& random, const DVec3& size, size_t count) {
    std::vector<Vec3> points;
    for (size_t i = 0; i < count; i++)
        points.emplace_back(DVec3(random.uniform(), random.uniform(), random.uniform()) * size);
    return points;
}

// Each axis has voxels of its own length, so that nothing changes where an axis is stretched evenly.
TEST(PaperFlood, VoxelsStretchWithTheCloud) {
    for (uint64_t seed = 0; seed < 20; seed++) {
        Random random(seed, 5);
        // Powers of two, so that no rounding moves a point into another voxel.
        const DVec3 factor(std::exp2(static_cast<int>(random.below(4))),
                           std::exp2(static_cast<int>(random.below(4))),
                           std::exp2(static_cast<int>(random.below(4))));
        const std::vector<Vec3> points = box_of_points(random, DVec3(1.0), 400);
        std::vector<Vec3> wide = points;
        for (Vec3& p : wide)
            p = Vec3(DVec3(p) * factor);
        Silent progress;
        const PaperFloodOptions options{8, 0.3, 0.0, true};
        const DVec3 root(0.5, 0.0, 0.5);
        const PaperFlood one = flood_as_printed(points, root, options, progress);
        const PaperFlood two = flood_as_printed(wide, root * factor, options, progress);
        ASSERT_FALSE(one.flooded.steps.empty());
        // The first neighbourhood, for the lines of the next ones are no longer the same.
        EXPECT_EQ(one.flooded.steps[0].voxels.size(), two.flooded.steps[0].voxels.size());
        ASSERT_EQ(one.flooded.steps[0].directions.size(), two.flooded.steps[0].directions.size());
        for (size_t d = 0; d < one.flooded.steps[0].directions.size(); d++)
            EXPECT_EQ(one.flooded.steps[0].directions[d].share, two.flooded.steps[0].directions[d].share);
    }
}

// Equations 5.1 to 5.3 and algorithms 5 to 7, done again by hand for every child.
TEST(PaperFlood, ChildrenAreWhatTheFormulasSay) {
    for (uint64_t seed = 0; seed < 20; seed++) {
        Random random(seed, 6);
        const std::vector<Vec3> points = box_of_points(random, DVec3(0.4, 2.0, 0.4), 1500);
        Silent progress;
        const double least = random.uniform(0.0, 0.1);
        const PaperFlood found =
            flood_as_printed(points, DVec3(0.2, 0.0, 0.2), {8, 0.3, least, true}, progress);
        ASSERT_GT(found.flooded.nodes.size(), 1u);
        for (const FloodStep& step : found.flooded.steps) {
            EXPECT_LE(step.directions.size(), 26u);
            double shares = 0.0;
            for (const FloodDirection& direction : step.directions) {
                shares += direction.share;
                EXPECT_EQ(direction.child >= 0, direction.share >= least && direction.length > 0.0);
                if (direction.child < 0) continue;
                const FloodNode& child = found.flooded.nodes[direction.child];
                EXPECT_EQ(child.parent, step.node);
                EXPECT_EQ(child.radius, direction.radius);
                EXPECT_NEAR(
                    glm::distance(child.position, step.position + direction.length * direction.direction),
                    0.0, 1e-12);
            }
            EXPECT_NEAR(shares, 1.0, 1e-9);
        }
        EXPECT_GT(found.reached, 0.0);
        EXPECT_LE(found.reached, 1.0);
    }
}

// One straight row of points along an axis: the line, the length and the radius are known.
TEST(PaperFlood, FollowsARowOfPoints) {
    std::vector<Vec3> points;
    for (int i = 0; i <= 1000; i++)
        points.emplace_back(0.01f * static_cast<float>(i % 2), 0.002f * static_cast<float>(i),
                            0.01f * static_cast<float>(i / 2 % 2));
    Silent progress;
    const PaperFlood found =
        flood_as_printed(points, DVec3(0.005, 0.0, 0.005), {2, 0.3, 0.03, false}, progress);
    EXPECT_EQ(found.reached, 1.0);
    double farthest = 0.0;
    for (const FloodNode& node : found.flooded.nodes)
        farthest = std::max(farthest, node.position.y);
    // Both rows of voxels are one neighbourhood. The upper one's points lie from 1 to 2 above the node, and
    // twice their mean is 3: as printed, the flood overshoots where a direction's points do not begin at the
    // node.
    EXPECT_NEAR(farthest, 3.0, 0.01);
}

TEST(PaperFlood, EndsAtAGapAndRefusesDimensionsOutOfRange) {
    Random random(3);
    std::vector<Vec3> points = box_of_points(random, DVec3(0.2, 1.0, 0.2), 2000);
    const std::vector<Vec3> beyond = points;
    for (const Vec3& p : beyond)
        points.push_back(p + Vec3(0.0f, 1.6f, 0.0f));
    Silent progress;
    const PaperFlood found = flood_as_printed(points, DVec3(0.1, 0.0, 0.1), {30, 0.3, 0.0, false}, progress);
    EXPECT_LE(found.reached, 0.5);
    for (const int32_t d : {0, 1, (1 << 20) + 1})
        EXPECT_THROW(flood_as_printed(points, DVec3(0.0), {d, 0.3, 0.0, false}, progress), Error) << d;
}

// Algorithm 6 is for wood that is filled evenly: the mean distance is then two thirds of the radius.
TEST(PaperFlood, FillsTheWoodEvenly) {
    for (uint64_t seed = 0; seed < 20; seed++) {
        Random random(seed, 8);
        const double radius = random.uniform(0.05, 0.3);
        const DVec3 a(random.uniform(), random.uniform(), random.uniform());
        const DVec3 b = a + radius * random.uniform(6.0, 20.0) *
                                glm::normalize(DVec3(random.normal(), random.normal(), random.normal()));
        PointCloud cloud;
        const double spacing = 0.1 * radius;
        test::add_cone(cloud, random, a, b, radius, radius, spacing, 0.0);
        const std::vector<Vec3> filled =
            filled_solid(cloud.positions, two_nodes(a, b, radius), spacing, 2.0 * spacing, seed);
        const size_t own = cloud.positions.size();
        ASSERT_GT(filled.size(), own + 500);
        EXPECT_LE(filled.size(), 5 * own);
        double sum = 0.0;
        double along = 0.0;
        for (size_t i = own; i < filled.size(); i++) {
            double t = 0.0;
            sum += distance_to_segment(DVec3(filled[i]), a, b, &t);
            along += t;
        }
        const double count = static_cast<double>(filled.size() - own);
        EXPECT_NEAR(sum / count, 2.0 / 3.0 * radius, 0.04 * radius);
        EXPECT_NEAR(along / count, 0.5, 0.04);
        EXPECT_TRUE(std::equal(cloud.positions.begin(), cloud.positions.end(), filled.begin()));
        EXPECT_EQ(filled,
                  filled_solid(cloud.positions, two_nodes(a, b, radius), spacing, 2.0 * spacing, seed));
    }
}

TEST(PaperFlood, MakesATreeOfAScan) {
    for (uint64_t seed = 0; seed < 5; seed++) {
        Random random(seed, 9);
        PointCloud cloud;
        test::add_cone(cloud, random, {0, 0, 0}, {0.1, 3.0, 0}, 0.1, 0.05, 0.012, 0.001);
        SkeletonOptions options;
        options.method = SkeletonMethod::kFlood;
        options.flood = FloodKind::kPaper;
        const SkeletonResult result = skeletonize(cloud, options);
        ASSERT_EQ(result.tree.check(), std::nullopt);
        EXPECT_GT(result.tree.size(), 3u);
        options.flood = FloodKind::kOurs;
        const SkeletonResult ours = skeletonize(cloud, options);
        EXPECT_LE(ours.voxel, result.voxel * 1.001);
        EXPECT_NE(ours.tree.size(), result.tree.size());
    }
    EXPECT_EQ(parse_flood_kind("paper"), FloodKind::kPaper);
    EXPECT_THROW(parse_flood_kind("printed"), Error);
}

}  // namespace
}  // namespace treerec
