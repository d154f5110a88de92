// Trunks without crowns, as photos of a trunk give them.
#include "scan/stems/lone_trunk.h"

#include <gtest/gtest.h>

#include <cmath>

#include "pipeline/reconstruct.h"
#include "scan_samples.h"

namespace treerec {
namespace {

// Bark around the axis, hollow, tapering by a tenth; noise: metres. Y up.
std::vector<Vec3> trunk(uint64_t seed, size_t count, double radius, double height, double noise,
                        double seen = 1.0) {
    Random random(seed);
    std::vector<Vec3> points;
    for (size_t i = 0; i < count; i++) {
        const double y = random.uniform(0.0, height), turn = 2.0 * kPi * seen * random.uniform();
        const double r = radius * (1.0 - 0.1 * y / height) + noise * random.normal();
        points.emplace_back(r * std::cos(turn), y, r * std::sin(turn));
    }
    return points;
}

TEST(LoneTrunk, IsToldFromATree) {
    const SubProgress progress(nullptr, 0.0, 1.0);
    for (const uint64_t seed : {1, 2, 3}) {
        EXPECT_TRUE(is_lone_trunk(trunk(seed, 2000, 0.4, 1.6, 0.01), progress));
        EXPECT_TRUE(is_lone_trunk(trunk(seed, 20000, 0.3, 6.0, 0.02, 0.5), progress));
        EXPECT_FALSE(is_lone_trunk(scan_test::tree_points(seed), progress));
        // A crown above a bare stem.
        std::vector<Vec3> palm = trunk(seed, 3000, 0.2, 5.0, 0.01);
        Random random(seed);
        for (int i = 0; i < 3000; i++)
            palm.emplace_back(DVec3(0.0, 5.5, 0.0) + 1.5 * random.uniform() * random.direction());
        EXPECT_FALSE(is_lone_trunk(palm, progress));
        // Leaves all around, dense within.
        std::vector<Vec3> ball;
        for (int i = 0; i < 5000; i++)
            ball.emplace_back(std::cbrt(random.uniform()) * random.direction());
        EXPECT_FALSE(is_lone_trunk(ball, progress));
    }
    EXPECT_FALSE(is_lone_trunk({}, progress));
    EXPECT_FALSE(is_lone_trunk(std::vector<Vec3>(1000, Vec3(1.0F)), progress));
}

TEST(LoneTrunk, IsOneStemHoweverShort) {
    const scan_test::Folder folder;
    for (const size_t count : {2000, 20000})
        for (const auto& [radius, height] : {std::pair{0.4, 1.6}, {0.3, 2.0}, {0.25, 3.0}, {0.2, 5.0}})
            for (const double noise : {0.003, 0.01}) {
                SCOPED_TRACE(std::to_string(count) + " " + std::to_string(radius) + " " +
                             std::to_string(noise));
                PointCloud cloud;
                cloud.positions = trunk(7, count, radius, height, noise);
                write_cloud(folder.file("trunk.ply"), cloud);
                ReconstructOptions options;
                options.orient.up = UpAxis::kY;
                options.orient.metres_per_unit = 1.0;
                const Reconstruction made = reconstruct_file(folder.file("trunk.ply"), options);
                EXPECT_FALSE(made.palm);
                EXPECT_EQ(made.leaf_points, 0u);
                EXPECT_EQ(made.measured.tips, 1u);
                EXPECT_NEAR(made.measured.height, height, 0.12 * height);
                EXPECT_NEAR(made.tree.node(made.tree.root()).radius, radius, 0.1 * radius);
            }
}

// Grass as photos show it is thicker than the ground: its lower half was left, and grew twigs.
TEST(LoneTrunk, StandsInGrass) {
    const scan_test::Folder folder;
    for (const size_t count : {2000, 20000})
        for (const auto& [radius, height] : {std::pair{0.3, 2.0}, {0.25, 3.0}}) {
            SCOPED_TRACE(std::to_string(count) + " " + std::to_string(radius));
            Random random(2);
            PointCloud cloud;
            cloud.positions = trunk(7, count, radius, height, 0.01);
            for (size_t i = 0; i < 3 * count; i++) {
                const double turn = 2.0 * kPi * random.uniform();
                const double off = std::sqrt(random.uniform(radius * radius, 9.0));
                const double x = off * std::cos(turn), z = off * std::sin(turn);
                cloud.positions.emplace_back(x, 0.05 * x + 0.02 * random.normal(), z);
            }
            write_cloud(folder.file("trunk.ply"), cloud);
            ReconstructOptions options;
            options.orient.up = UpAxis::kY;
            options.orient.metres_per_unit = 1.0;
            const Reconstruction made = reconstruct_file(folder.file("trunk.ply"), options);
            EXPECT_LT(made.cloud.size(), count * 21 / 20);
            EXPECT_LT(made.measured.volume, 1.2 * kPi * radius * radius * height);
            EXPECT_NEAR(made.measured.height, height, 0.1 * height);
            EXPECT_NEAR(made.measured.dbh, 2.0 * radius * (1.0 - 0.13 / height), 0.05);
        }
}

}  // namespace
}  // namespace treerec
