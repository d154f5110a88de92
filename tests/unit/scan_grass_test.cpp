// Trees in grass, which is thicker than the ground that is found at its lowest points.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fidelity/score.h"
#include "pipeline/reconstruct.h"
#include "scan_samples.h"
#include "synth/grow.h"
#include "synth/scan.h"

namespace treerec {
namespace {

// Points of blades on a rolling slope around the foot of a tree that high, to half its height. mean: how high
// they are, of the tree's height. Z up.
std::vector<Vec3> grass(uint64_t seed, size_t count, double height, double mean) {
    Random random(seed);
    std::vector<Vec3> points;
    for (size_t i = 0; i < count; i++) {
        const double off = 0.5 * height * std::sqrt(random.uniform()), turn = 2.0 * kPi * random.uniform();
        const double x = off * std::cos(turn), y = off * std::sin(turn);
        const double ground = 0.08 * x + 0.02 * height * std::sin(9.0 * x / height);
        points.emplace_back(x, y, ground - mean * height * std::log(1.0 - random.uniform()));
    }
    return points;
}

class InGrass : public ::testing::TestWithParam<Habit> {};

TEST_P(InGrass, TheTreeIsAsItIsWithout) {
    constexpr size_t kPoints = 12000;
    constexpr double kHeight = 10.0;
    const scan_test::Folder folder;
    const Tree truth = grow_tree({GetParam(), kHeight, 1});
    VirtualScanOptions scanner;
    scanner.points = kPoints;
    scanner.noise = 0.005;
    const PointCloud scan = scan_tree(truth, scanner).cloud;
    ReconstructOptions options;
    options.orient.up = UpAxis::kZ;
    options.orient.metres_per_unit = 1.0;
    const auto reconstruct = [&](const std::vector<Vec3>& more) {
        PointCloud cloud;
        cloud.frame.origin = DVec3(0.0);
        for (const Vec3& p : scan.positions)
            cloud.positions.emplace_back(scan.frame.to_scan(DVec3(p)));
        cloud.positions.insert(cloud.positions.end(), more.begin(), more.end());
        write_cloud(folder.file("tree.ply"), cloud);
        return reconstruct_file(folder.file("tree.ply"), options);
    };
    const Reconstruction without = reconstruct({});
    for (const double mean : {0.004, 0.007}) {
        SCOPED_TRACE(mean);
        const Reconstruction within = reconstruct(grass(7, 3 * kPoints, kHeight, mean));
        EXPECT_NEAR(static_cast<double>(within.cloud.size()), static_cast<double>(without.cloud.size()),
                    0.03 * static_cast<double>(without.cloud.size()));
        EXPECT_NEAR(within.measured.total_length, without.measured.total_length,
                    0.1 * without.measured.total_length);
        EXPECT_NEAR(within.measured.height, without.measured.height, 0.02 * kHeight);
        EXPECT_NEAR(within.measured.dbh, without.measured.dbh, 0.1 * without.measured.dbh);
    }
}

// The ground of photos scatters to both sides of its surface, on which the tree stands.
TEST(ScatteredGround, TheTreeStandsOnItsMiddle) {
    constexpr double kHeight = 10.0, kScatter = 0.03;
    const scan_test::Folder folder;
    VirtualScanOptions scanner;
    scanner.points = 12000;
    const PointCloud scan = scan_tree(grow_tree({Habit::kBroadleaf, kHeight, 1}), scanner).cloud;
    PointCloud cloud;
    for (const Vec3& p : scan.positions)
        cloud.positions.emplace_back(scan.frame.to_scan(DVec3(p)));
    Random random(3);
    for (int i = 0; i < 36000; i++) {
        const double off = 5.0 * std::sqrt(random.uniform()), turn = 2.0 * kPi * random.uniform();
        cloud.positions.emplace_back(off * std::cos(turn), off * std::sin(turn), kScatter * random.normal());
    }
    write_cloud(folder.file("tree.ply"), cloud);
    ReconstructOptions options;
    options.orient.up = UpAxis::kZ;
    options.orient.metres_per_unit = 1.0;
    const Tree tree = reconstruct_file(folder.file("tree.ply"), options).tree;
    double lowest = kHeight;
    for (const NodeId id : tree.depth_first())
        lowest = std::min(lowest, tree.frame().to_scan(tree.node(id).position).z);
    EXPECT_NEAR(lowest, 0.0, kScatter);
}

INSTANTIATE_TEST_SUITE_P(Habits, InGrass,
                         ::testing::Values(Habit::kBroadleaf, Habit::kConifer, Habit::kBirch, Habit::kForked,
                                           Habit::kLeaning));

}  // namespace
}  // namespace treerec
