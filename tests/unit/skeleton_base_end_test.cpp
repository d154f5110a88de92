#include "skeleton/cylinders/base_end.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "cases.h"
#include "geometry/bounds.h"
#include "scan_samples.h"
#include "skeleton/skeleton.h"
#include "skeleton_test_clouds.h"
#include "synth/grow.h"
#include "synth/scan.h"

namespace treerec {
namespace {

using test::add_bend;
using test::add_cone;

// Whole turns about two axes: of a tree that lies or hangs any way.
DVec3 turned(const DVec3& p, double around, double over) {
    const DVec3 a(std::cos(around) * p.x - std::sin(around) * p.z, p.y,
                  std::sin(around) * p.x + std::cos(around) * p.z);
    return {a.x, std::cos(over) * a.y - std::sin(over) * a.z, std::sin(over) * a.y + std::cos(over) * a.z};
}

TEST(BaseEnd, IsFoundHoweverTheTreeLies) {
    Progress progress;
    Random random(5);
    int found = 0, all = 0;
    for (const Habit habit :
         {Habit::kBroadleaf, Habit::kConifer, Habit::kBirch, Habit::kForked, Habit::kLeaning})
        for (int k = 1; k <= test::repeats(3); k++) {
            const auto seed = static_cast<uint64_t>(k);
            const Tree tree = grow_tree({habit, 0.0, seed});
            VirtualScanOptions options;
            options.points = 15000;
            options.stray = 0.0;
            options.seed = seed;
            const VirtualScan scan = scan_tree(tree, options);
            for (int turn = 0; turn < 2; turn++) {
                const double around = random.uniform(0.0, 2.0 * kPi), over = random.uniform(0.0, 2.0 * kPi);
                std::vector<Vec3> points;
                Bounds bounds;
                for (size_t i = 0; i < scan.cloud.size(); i++) {
                    points.emplace_back(turned(DVec3(scan.cloud.positions[i]), around, over));
                    bounds.add(DVec3(points.back()));
                }
                const DVec3 base = turned(tree.node(tree.root()).position, around, over);
                const double off = glm::distance(find_base_end(points, progress).position, base);
                all++;
                found += off < 0.06 * bounds.diagonal();
            }
        }
    EXPECT_GE(found, all * 9 / 10) << "of " << all;
}

// Far wider than high, but no branch that lies.
TEST(BaseEnd, OfASpreadingTreeIsItsBase) {
    for (const uint64_t seed : {1, 2, 3}) {
        Random random(seed);
        PointCloud cloud;
        add_cone(cloud, random, {0, 0, 0}, {0, 1.6, 0}, 0.3, 0.25, 0.03, 0.002);
        for (int branch = 0; branch < 7; branch++) {
            const double angle = 2.0 * kPi * (branch + random.uniform(-0.2, 0.2)) / 7.0;
            const DVec3 out(std::cos(angle), 0.0, std::sin(angle)), up(0.0, 1.0, 0.0);
            const double length = random.uniform(4.0, 5.0);
            const DVec3 tip = length * out + random.uniform(2.5, 3.5) * up;
            add_bend(cloud, random, {1.6 * up, 0.5 * length * out + 2.4 * up, tip}, 0.12, 0.03, 0.03, 0.002);
            for (int side = 0; side < 4; side++) {
                const double at = random.uniform(0.5, 0.95);
                const DVec3 from = at * length * out + 2.4 * up;
                add_cone(cloud, random, from,
                         from + 0.8 * out + random.uniform(-0.8, 0.8) * glm::cross(out, up) + 0.3 * up, 0.02,
                         0.01, 0.02, 0.002);
            }
        }
        const SkeletonResult result = skeletonize(cloud, {});
        const DVec3 root = result.tree.frame().to_scan(result.tree.node(result.tree.root()).position);
        EXPECT_LT(glm::length(cloud.frame.to_tree(root)), 0.15) << "seed " << seed;
    }
}

// A cut branch that was scanned lying: tufts of twigs at its tips are wider than its cut face.
TEST(BaseEnd, OfALyingScanIsItsCutFace) {
    if (scan_test::scans_folder().empty())
        GTEST_SKIP() << "TREEREC_SCANS does not name the folder of the real scans.";
    const PointCloud cloud = scan_test::upright_scan("vezy_A5B8.asc");
    double east = -1e9;
    for (const Vec3& p : cloud.positions)
        east = std::max(east, cloud.frame.to_scan(DVec3(p)).x);
    const SkeletonResult result = skeletonize(cloud, {});
    const DVec3 root = result.tree.frame().to_scan(result.tree.node(result.tree.root()).position);
    EXPECT_NEAR(root.x, east, 0.1);
}

}  // namespace
}  // namespace treerec
