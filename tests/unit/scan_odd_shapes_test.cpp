// What stands in gardens and scans besides single trees of the usual size.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "pipeline/reconstruct.h"
#include "scan_samples.h"
#include "tree/measure.h"

namespace treerec {
namespace {

using namespace scan_test;

// Scans are Z up; the samples are made Y up.
PointCloud standing(const std::vector<Vec3>& points, double turn = 0.0, double scale = 1.0) {
    PointCloud cloud;
    const double c = std::cos(turn), s = std::sin(turn);
    for (const Vec3& p : points)
        cloud.positions.emplace_back(scale * DVec3(c * p.x - s * p.z, -(s * p.x + c * p.z), p.y));
    return cloud;
}

Reconstruction made_of(const PointCloud& cloud, const ReconstructOptions& options = {}) {
    const Folder folder;
    write_cloud(folder.file("scan.ply"), cloud);
    return reconstruct_file(folder.file("scan.ply"), options);
}

bool warned(const Reconstruction& result, const std::string& words) {
    return std::any_of(result.warnings.begin(), result.warnings.end(),
                       [&](const std::string& warning) { return warning.find(words) != std::string::npos; });
}

size_t removed(const Reconstruction& result, const std::string& name) {
    for (const CleanStep& step : result.clean.steps)
        if (step.name == name) return step.removed;
    return 0;
}

// An upright rectangle from a to b, as high as `height`.
void add_wall(std::vector<Vec3>& points, Random& random, const DVec3& a, const DVec3& b, double height,
              double noise, size_t count) {
    const DVec3 normal = glm::normalize(glm::cross(b - a, DVec3(0, 1, 0)));
    for (size_t i = 0; i < count; i++)
        points.emplace_back(a + random.uniform() * (b - a) + DVec3(0, random.uniform(0, height), 0) +
                            noise * random.normal() * normal);
}

void add_ground(std::vector<Vec3>& points, Random& random, double half, double noise, size_t count) {
    for (size_t i = 0; i < count; i++)
        points.emplace_back(random.uniform(-half, half), noise * random.normal(),
                            random.uniform(-half, half));
}

TEST(OddShapes, ASmallTreeIsATreeLikeALargeOne) {
    const std::vector<Vec3> points = tree_points(3);
    ReconstructOptions metres;
    metres.orient.metres_per_unit = 1.0;
    const Measurements large = made_of(standing(points, 0.0, 0.7), metres).measured;
    for (const double height : {0.2, 0.42, 0.8}) {
        SCOPED_TRACE(height);
        const double scale = height / 10.0;
        const Reconstruction result = made_of(standing(points, 0.0, scale), metres);
        ASSERT_EQ(result.tree.check(), std::nullopt);
        const double times = 0.7 / scale;
        EXPECT_NEAR(times * result.measured.total_length, large.total_length, 0.05 * large.total_length);
        EXPECT_NEAR(times * times * times * result.measured.volume, large.volume, 0.05 * large.volume);
        EXPECT_NEAR(result.measured.height, height, 0.02 * height);
        EXPECT_LT(result.spacing, 0.001);
        // It lies on its scan.
        EXPECT_LT(result.fit.median_mm, 2.0 * height);
    }
    ReconstructOptions flood = metres;
    flood.skeleton.method = SkeletonMethod::kFlood;
    const Measurements flooded = made_of(standing(points, 0.0, 0.7), flood).measured;
    const Measurements small = made_of(standing(points, 0.0, 0.042), flood).measured;
    EXPECT_NEAR(0.7 / 0.042 * small.total_length, flooded.total_length, 0.05 * flooded.total_length);
}

TEST(OddShapes, AWallBesideATreeIsLeftOutAndCounted) {
    const std::vector<Vec3> tree = tree_points(4);
    const double length = made_of(standing(tree)).measured.total_length;
    int kind = 0;
    for (const double away : {0.3, 1.5})
        for (const bool with_ground : {false, true})
            for (const double noise : {0.004, 0.02}) {
                SCOPED_TRACE(std::to_string(away) + " " + std::to_string(with_ground) + " " +
                             std::to_string(noise));
                Random random(static_cast<uint64_t>(++kind));
                std::vector<Vec3> points = tree;
                add_wall(points, random, {-5.0, 0.0, -away}, {4.0, 0.0, -away}, 5.0 + kind % 3, noise, 6000);
                if (with_ground) add_ground(points, random, 5.0, 0.01, 5000);
                const Reconstruction result = made_of(standing(points, 0.7 * kind));
                EXPECT_GE(removed(result, "Walls"), 5700U);
                EXPECT_LE(removed(result, "Walls"), 7500U);  // with what it touches of the trunk
                EXPECT_TRUE(warned(result, "on a wall"));
                EXPECT_FALSE(warned(result, "looks more like the way up"));
                EXPECT_EQ(result.orient.up, UpAxis::kZ);
                EXPECT_NEAR(result.measured.total_length, length, 0.25 * length);
                EXPECT_NEAR(result.measured.height, 10.0, 0.3);
            }
}

TEST(OddShapes, WhatHangsOnAWallGoesWithIt) {
    const std::vector<Vec3> tree = tree_points(4);
    const double length = made_of(standing(tree)).measured.total_length;
    for (const bool with_ground : {false, true}) {
        SCOPED_TRACE(with_ground);
        Random random(3);
        std::vector<Vec3> points = tree;
        add_wall(points, random, {-5.0, 0.0, -2.6}, {4.0, 0.0, -2.6}, 5.0, 0.005, 6000);
        // Two sills, and a lamp on an arm.
        size_t hangings = 0;
        for (const double x : {-4.0, 2.5})
            for (int i = 0; i < 250; i++, hangings++)
                points.emplace_back(x + random.uniform(0.0, 1.2), 1.1 + random.uniform(0.0, 0.06),
                                    -2.6 + random.uniform(0.02, 0.3));
        add_cylinder(points, random, {-3.2, 2.6, -2.6}, {-3.2, 2.6, -1.8}, 0.03, 0.03, 200);
        for (int i = 0; i < 200; i++)
            points.emplace_back(DVec3(-3.2, 2.5, -1.7) + 0.15 * random.direction());
        hangings += 400;
        if (with_ground) add_ground(points, random, 5.0, 0.01, 5000);
        const Reconstruction result = made_of(standing(points));
        EXPECT_GE(removed(result, "Walls"), 5700 + hangings * 9 / 10);
        EXPECT_LE(removed(result, "Walls"), 6600 + hangings);
        EXPECT_GE(result.cloud.size() * 100, tree.size() * 97);
        EXPECT_NEAR(result.measured.total_length, length, 0.1 * length);
    }
}

TEST(OddShapes, NeitherATreeNorAHedgeHasAWall) {
    Random random(8);
    std::vector<Vec3> hedge;
    for (int i = 0; i < 14000; i++)
        hedge.emplace_back(random.uniform(0, 4), random.uniform(0, 1.5), random.uniform(0, 0.8));
    EXPECT_EQ(removed(made_of(standing(hedge)), "Walls"), 0U);
    EXPECT_EQ(removed(made_of(standing(tree_points(5))), "Walls"), 0U);
    // Left whole where the user wants the surroundings.
    std::vector<Vec3> points = tree_points(5);
    add_wall(points, random, {-5.0, 0.0, -1.5}, {4.0, 0.0, -1.5}, 5.0, 0.005, 6000);
    ReconstructOptions options;
    options.clean.remove_ground = false;
    EXPECT_EQ(removed(made_of(standing(points), options), "Walls"), 0U);
}

TEST(OddShapes, AStumpIsOnePiece) {
    int kind = 0;
    for (const auto& [radius, height] : {std::pair{0.35, 0.5}, {0.5, 0.7}, {0.2, 0.6}, {0.6, 0.9}})
        for (const bool face : {false, true})
            for (const bool with_ground : {false, true}) {
                SCOPED_TRACE(std::to_string(radius) + " " + std::to_string(face) +
                             std::to_string(with_ground));
                Random random(static_cast<uint64_t>(++kind));
                std::vector<Vec3> points;
                add_cylinder(points, random, {0, 0, 0}, {0, height, 0}, radius, 0.9 * radius, 9000);
                for (int i = 0; face && i < 1500; i++) {
                    const double r = 0.9 * radius * std::sqrt(random.uniform());
                    const double turn = random.uniform(0.0, 2.0 * kPi);
                    points.emplace_back(r * std::cos(turn), height, r * std::sin(turn));
                }
                for (Vec3& p : points)
                    p += Vec3(0.002 * random.normal() * random.direction());
                if (with_ground) add_ground(points, random, 1.8, 0.004, 4000);
                for (const SkeletonMethod method :
                     {SkeletonMethod::kGeodesic, SkeletonMethod::kDelaunay, SkeletonMethod::kFlood}) {
                    ReconstructOptions options;
                    options.skeleton.method = method;
                    const Reconstruction result = made_of(standing(points, kind), options);
                    ASSERT_EQ(result.tree.check(), std::nullopt);
                    EXPECT_EQ(result.tree.nodes_of_kind(NodeKind::kLeaf).size(), 1U);
                    const double volume = kPi * height * radius * radius * (1.0 + 0.9 + 0.81) / 3.0;
                    EXPECT_NEAR(result.measured.volume, volume, 0.1 * volume);
                    EXPECT_FALSE(warned(result, "trees"));
                    EXPECT_FALSE(warned(result, "Is it a tree?"));
                }
            }
}

// Poles from the ground to the middle of branches that a wide trunk bears.
TEST(OddShapes, RootsThatHangFromBranchesAreNoTreesOfTheirOwn) {
    for (const uint64_t seed : {1, 2}) {
        Random random(seed);
        std::vector<Vec3> points;
        add_cylinder(points, random, {0, 0, 0}, {0, 3.4, 0}, 0.55, 0.45, 4000);
        add_cylinder(points, random, {0, 3.4, 0}, {0.3, 6.8, 0}, 0.3, 0.05, 1500);
        for (int branch = 0; branch < 4; branch++) {
            const double turn = 0.5 * kPi * branch + 0.2 * static_cast<double>(seed);
            const DVec3 out(std::cos(turn), 0.0, std::sin(turn));
            add_cylinder(points, random, DVec3(0, 3.3, 0), DVec3(0, 4.5, 0) + 6.0 * out, 0.22, 0.1, 1800);
            for (const double at : {2.4, 4.0, 5.5})
                add_cylinder(points, random, at * out, at * out + DVec3(0, 3.3 + 0.2 * at, 0), 0.07, 0.06,
                             300);
        }
        const Reconstruction result = made_of(standing(points));
        EXPECT_TRUE(result.clean.pick.trees.empty()) << result.clean.pick.trees.size();
        EXPECT_GE(result.cloud.size() * 100, points.size() * 95);
    }
}

TEST(OddShapes, CulmsInAChainAreOneClump) {
    for (const uint64_t seed : {1, 2, 3}) {
        Random random(seed);
        std::vector<Vec3> points;
        const int culms = 16 + 4 * static_cast<int>(seed);
        for (int i = 0; i < culms; i++) {
            const double turn = 2.0 * kPi * (i + 0.3 * random.uniform()) / culms, away = i % 2 ? 0.55 : 0.3;
            const DVec3 foot(away * std::cos(turn), 0.0, away * std::sin(turn));
            add_cylinder(points, random, foot, 2.2 * foot + DVec3(0, 8, 0), 0.04, 0.02, 800);
        }
        const Reconstruction result = made_of(standing(points));
        EXPECT_TRUE(result.clean.pick.trees.empty()) << result.clean.pick.trees.size();
        EXPECT_GE(result.cloud.size() * 100, points.size() * 95);
    }
    // Two trees are two, and the sentence names the way out.
    std::vector<Vec3> two = tree_points(1);
    for (const Vec3& p : tree_points(2))
        two.push_back(p + Vec3(6.0F, 0.0F, 1.0F));
    const Reconstruction result = made_of(standing(two));
    EXPECT_EQ(result.clean.pick.trees.size(), 2U);
    EXPECT_TRUE(warned(result, "--one-tree"));
}

TEST(OddShapes, SlicesAcrossTrunksAreRefused) {
    const auto sentence = [](const std::vector<Vec3>& points) -> std::string {
        try {
            made_of(standing(points));
        } catch (const Error& error) {
            return error.what();
        }
        return {};
    };
    for (const double thick : {0.02, 0.05, 0.1}) {
        SCOPED_TRACE(thick);
        Random random(3);
        std::vector<Vec3> slice;
        add_cylinder(slice, random, {0, 0, 0}, {0, thick, 0}, 0.2, 0.2, 2000);
        EXPECT_NE(sentence(slice).find("slice across a trunk"), std::string::npos) << sentence(slice);
        std::vector<Vec3> plot;
        for (int i = 0; i < 12; i++) {
            const DVec3 foot(random.uniform(-8, 8), 1.3, random.uniform(-8, 8));
            add_cylinder(plot, random, foot, foot + DVec3(0, thick, 0), 0.15, 0.15, 600);
        }
        EXPECT_NE(sentence(plot).find("trunks"), std::string::npos) << sentence(plot);
    }
    EXPECT_EQ(sentence(tree_points(1)), "");
}

}  // namespace
}  // namespace treerec
