#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "fidelity/score.h"
#include "geometry/segment.h"
#include "skeleton/flood/flood.h"
#include "skeleton/flood/flood_fit.h"
#include "skeleton/skeleton.h"
#include "skeleton_shapes.h"
#include "tree/branches.h"

namespace treerec {
namespace {

SkeletonOptions flooded(double voxel = 0.0) {
    SkeletonOptions options;
    options.method = SkeletonMethod::kFlood;
    options.voxel = voxel;
    options.keep_steps = true;
    return options;
}

DVec3 any_direction(Random& random) {
    const double up = random.uniform(-1.0, 1.0);
    const double turn = random.uniform(0.0, 2.0 * kPi);
    const double across = std::sqrt(1.0 - up * up);
    return {across * std::cos(turn), up, across * std::sin(turn)};
}

// Node positions in the cloud's own space.
DVec3 place_of(const SkeletonResult& result, const PointCloud& cloud, NodeId id) {
    return cloud.frame.to_tree(result.tree.frame().to_scan(result.tree.node(id).position));
}

size_t tips_of(const Tree& tree) {
    return tree.nodes_of_kind(NodeKind::kLeaf).size();
}

struct Cylinder {
    DVec3 a;
    DVec3 b;
    double radius = 0.0;
    double spacing = 0.0;
    PointCloud cloud;
};

Cylinder random_cylinder(uint64_t seed, bool solid = false) {
    Random random(seed, 77);
    Cylinder cylinder;
    cylinder.a = {random.uniform(-5.0, 5.0), random.uniform(-5.0, 5.0), random.uniform(-5.0, 5.0)};
    cylinder.radius = random.uniform(0.02, 0.2);
    const double length = cylinder.radius * random.uniform(12.0, 30.0);
    const DVec3 along = any_direction(random);
    cylinder.b = cylinder.a + length * along;
    cylinder.spacing = cylinder.radius * (solid ? 0.05 : random.uniform(0.08, 0.2));
    test::add_cone(cylinder.cloud, random, cylinder.a, cylinder.b, cylinder.radius, cylinder.radius,
                   cylinder.spacing, 0.0);
    if (!solid) return cylinder;
    // Every point moves towards the axis, so that the cross-section is filled evenly.
    for (Vec3& p : cylinder.cloud.positions) {
        const DVec3 axis = cylinder.a + glm::dot(DVec3(p) - cylinder.a, along) * along;
        p = Vec3(axis + std::sqrt(random.uniform()) * (DVec3(p) - axis));
    }
    return cylinder;
}

class FloodCylinderTest : public testing::TestWithParam<int> {};

TEST_P(FloodCylinderTest, FindsItsOneBranchWithinHalfAVoxel) {
    const Cylinder cylinder = random_cylinder(static_cast<uint64_t>(GetParam()));
    const double voxel = 3.0 * cylinder.spacing;
    const SkeletonResult result = skeletonize(cylinder.cloud, flooded(voxel));
    ASSERT_EQ(result.tree.check(), std::nullopt);
    EXPECT_EQ(result.voxel, voxel);
    EXPECT_EQ(result.kind, CloudKind::kSurface);
    EXPECT_EQ(tips_of(result.tree), 1u);
    const DVec3 middle = 0.5 * (cylinder.a + cylinder.b);
    const double half = 0.5 * glm::distance(cylinder.a, cylinder.b);
    double first = 1.0;
    double last = 0.0;
    for (const NodeId id : result.tree.depth_first()) {
        const DVec3 p = place_of(result, cylinder.cloud, id);
        double t = 0.0;
        const double off = distance_to_segment(p, cylinder.a, cylinder.b, &t);
        first = std::min(first, t);
        last = std::max(last, t);
        // The ends are cut off somehow; in between half a voxel is the promise.
        if (glm::distance(p, middle) > half - 2.5 * cylinder.radius) continue;
        EXPECT_LT(off, 0.5 * voxel);
        EXPECT_NEAR(result.tree.node(id).radius, cylinder.radius, 0.5 * voxel);
    }
    EXPECT_LT(first, 0.1);
    EXPECT_GT(last, 0.9);
}

INSTANTIATE_TEST_SUITE_P(AnyOrientation, FloodCylinderTest, testing::Range(0, 40));

// A surface's mean distance is the radius, a solid's is two thirds of it.
TEST(FloodTest, TellsASolidFromASurface) {
    for (uint64_t seed = 0; seed < 10; seed++) {
        const Cylinder cylinder = random_cylinder(seed, true);
        const SkeletonResult result = skeletonize(cylinder.cloud, flooded(5.0 * cylinder.spacing));
        EXPECT_EQ(result.kind, CloudKind::kSolid);
        EXPECT_TRUE(result.kind_told);
        std::vector<double> radii;
        for (const NodeId id : result.tree.depth_first())
            radii.push_back(result.tree.node(id).radius);
        std::nth_element(radii.begin(), radii.begin() + static_cast<ptrdiff_t>(radii.size() / 2),
                         radii.end());
        EXPECT_NEAR(radii[radii.size() / 2], cylinder.radius, 0.08 * cylinder.radius) << seed;
    }
}

TEST(FloodTest, FindsEveryArmOfAFork) {
    for (uint64_t seed = 0; seed < 20; seed++) {
        const test::WoodScan scan = test::fork_scan(seed, 2 + static_cast<int>(seed % 3));
        const SkeletonResult result = skeletonize(scan.cloud, flooded(2.0 * scan.spacing));
        ASSERT_EQ(result.tree.check(), std::nullopt);
        EXPECT_GE(tips_of(result.tree), scan.tips) << seed;
        EXPECT_LE(tips_of(result.tree), scan.tips + 2) << seed;
    }
}

TEST(FloodTest, GoesOnBeyondGaps) {
    Random random(5);
    PointCloud cloud;
    test::add_cone(cloud, random, {0, 0, 0}, {0, 1.0, 0}, 0.05, 0.05, 0.008, 0.0);
    test::add_cone(cloud, random, {0, 1.3, 0}, {0, 2.3, 0}, 0.05, 0.04, 0.008, 0.0);
    const SkeletonResult result = skeletonize(cloud, flooded(0.016));
    const Bounds bounds = result.tree.bounds();
    EXPECT_GT(bounds.size().y, 2.1);
    EXPECT_EQ(tips_of(result.tree), 1u);
    size_t guesses = 0;
    for (const NodeId id : result.tree.depth_first())
        guesses += result.tree.node(id).is_guess();
    EXPECT_EQ(guesses, 1u);
}

// Every voxel belongs to one step at most, and the steps make the tree.
TEST(FloodTest, StepsRetireTheirVoxels) {
    const test::WoodScan scan = test::fork_scan(3, 2);
    const SkeletonResult result = skeletonize(scan.cloud, flooded());
    ASSERT_FALSE(result.steps.empty());
    std::vector<std::vector<float>> seen;
    std::vector<int32_t> parent_of(1, -1);
    int32_t generation = 0;
    for (const FloodStep& step : result.steps) {
        EXPECT_FALSE(step.voxels.empty());
        for (const Vec3& v : step.voxels)
            seen.push_back({v.x, v.y, v.z});
        double share = 0.0;
        for (const FloodDirection& direction : step.directions) {
            EXPECT_NEAR(glm::length(direction.direction), 1.0, 1e-9);
            EXPECT_GE(direction.length, 0.0);
            share += direction.share;
            if (direction.child >= static_cast<int32_t>(parent_of.size()))
                parent_of.resize(static_cast<size_t>(direction.child) + 1, -1);
            if (direction.child >= 0) parent_of[static_cast<size_t>(direction.child)] = step.node;
        }
        EXPECT_NEAR(share, 1.0, 1e-9);
        // Where the flood went over a gap, no direction led there.
        const size_t node = static_cast<size_t>(step.node);
        if (node < parent_of.size() && parent_of[node] >= 0) {
            EXPECT_EQ(parent_of[node], step.parent);
        }
        EXPECT_GE(step.generation, 0);
        generation = std::max(generation, step.generation);
    }
    EXPECT_GT(generation, 3);
    std::sort(seen.begin(), seen.end());
    EXPECT_EQ(std::unique(seen.begin(), seen.end()), seen.end());
    EXPECT_TRUE(skeletonize(scan.cloud,
                            [] {
                                SkeletonOptions options = flooded();
                                options.keep_steps = false;
                                return options;
                            }())
                    .steps.empty());
}

TEST(FloodTest, OrderOfThePointsChangesNothing) {
    test::WoodScan scan = test::fork_scan(7, 3);
    const SkeletonResult before = skeletonize(scan.cloud, flooded());
    Random random(9);
    std::vector<Vec3>& points = scan.cloud.positions;
    for (size_t i = points.size(); i > 1; i--)
        std::swap(points[i - 1], points[static_cast<size_t>(random.uniform() * static_cast<double>(i))]);
    const SkeletonResult after = skeletonize(scan.cloud, flooded());
    ASSERT_EQ(before.tree.size(), after.tree.size());
    for (const NodeId id : before.tree.depth_first()) {
        EXPECT_EQ(before.tree.node(id).position, after.tree.node(id).position);
        EXPECT_EQ(before.tree.node(id).radius, after.tree.node(id).radius);
    }
}

std::string sentence_of(const PointCloud& cloud, const SkeletonOptions& options) {
    try {
        skeletonize(cloud, options);
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

TEST(FloodTest, SaysWhatIsWrongWithAVoxelSize) {
    const test::WoodScan scan = test::plain_fork_scan(1);
    EXPECT_NE(sentence_of(scan.cloud, flooded(20.0)).find("too large for a tree of"), std::string::npos);
    EXPECT_NE(sentence_of(scan.cloud, flooded(1e-7)).find("too small for a tree of"), std::string::npos);
    EXPECT_THROW(parse_skeleton_method("voxels"), Error);
    EXPECT_EQ(parse_skeleton_method("flood"), SkeletonMethod::kFlood);
    EXPECT_EQ(std::string(skeleton_method_name(parse_skeleton_method("geodesic"))), "geodesic");
}

TEST(FloodTest, StopsWhenCancelled) {
    class Impatient : public Progress {
      public:
        explicit Impatient(int patience) : patience_(patience) {}
        bool cancelled() const override { return --patience_ < 0; }

      private:
        mutable int patience_;
    };
    const test::WoodScan scan = test::fork_scan(2, 3);
    for (const int patience : {0, 10, 40}) {
        Impatient progress(patience);
        EXPECT_THROW(skeletonize(scan.cloud, flooded(), &progress), Cancelled) << patience;
    }
}

// A line through the node: exact where the points lie on one.
TEST(FloodTest, FitsLinesThroughTheNode) {
    Random random(4);
    for (int round = 0; round < 50; round++) {
        const DVec3 node = {random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0)};
        const DVec3 along = any_direction(random);
        std::vector<Vec3> points;
        for (int i = 0; i <= 200; i++)
            points.emplace_back(node + 0.005 * i * along);
        SubProgress silent(nullptr, 0.0, 1.0);
        const FloodGrid grid(points, 0.05, silent);
        std::vector<uint32_t> all(grid.size());
        for (uint32_t v = 0; v < grid.size(); v++)
            all[v] = v;
        const LineFit fit = fit_line(grid, points, node, all);
        EXPECT_GT(glm::dot(fit.direction, along), 1.0 - 1e-8);
        EXPECT_NEAR(fit.length, 1.0, 0.06);
        EXPECT_LT(fit.radius, 1e-4);
    }
}

// Twigs that run side by side within a voxel are one neighbourhood to the flood, and its line runs between
// them.
TEST(FloodTest, ExplainsTwigsThatRunSideBySideWithinAVoxel) {
    for (uint64_t seed = 0; seed < 12; seed++) {
        Random random(seed, 31);
        PointCloud cloud;
        PointCloud twigs;
        test::add_cone(cloud, random, {0, 0, 0}, {0, 2.0, 0}, 0.05, 0.04, 0.035, 0.0);
        for (int bundle = 0; bundle < 8; bundle++) {
            const DVec3 base(0.0, random.uniform(0.8, 1.9), 0.0);
            DVec3 along = any_direction(random);
            along = glm::normalize(DVec3(along.x, 0.5 * along.y, along.z) + DVec3(0.05, 0.0, 0.0));
            const DVec3 side = any_perpendicular(along);
            const DVec3 other = glm::cross(along, side);
            for (int twig = 0; twig < 6; twig++) {
                const DVec3 offset = 0.06 * ((twig % 3 - 1.0) * side + (twig / 3 - 0.5) * other);
                for (double t = 0.05; t < 0.9; t += 0.04)
                    twigs.positions.emplace_back(base + t * along + std::min(1.0, t / 0.4) * offset +
                                                 0.002 * any_direction(random));
            }
        }
        cloud.positions.insert(cloud.positions.end(), twigs.positions.begin(), twigs.positions.end());
        const SkeletonResult result = skeletonize(cloud, flooded(0.04));
        ASSERT_EQ(result.tree.check(), std::nullopt);
        EXPECT_GT(score_scan(result.tree, twigs).explained_2cm, 0.7) << seed;
    }
}

}  // namespace
}  // namespace treerec
