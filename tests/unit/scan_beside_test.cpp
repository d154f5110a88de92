// What stands beside a tree of which it is known where it stands: scan/cleaning/clean_beside.cpp.
#include <gtest/gtest.h>

#include <cmath>

#include "scan_samples.h"
#include "synth/grow.h"
#include "synth/scan.h"

namespace treerec {
namespace {

constexpr double kHeight = 5.0;
const DVec2 kBench(1.4, -1.2);  // metres from the stem

bool is_bench(const DVec3& p) {
    return std::abs(p.x - kBench.x) <= 0.8 && std::abs(p.y - kBench.y) <= 0.25 && p.z < 0.75;
}

// A tree on a lawn with a bench: a seat on two legs, and a back. Z up.
std::vector<DVec3> garden(Habit habit) {
    VirtualScanOptions scanner;
    scanner.points = 20000;
    const PointCloud scan = scan_tree(grow_tree({habit, kHeight, 3}), scanner).cloud;
    std::vector<DVec3> points;
    for (const Vec3& p : scan.positions)
        points.push_back(scan.frame.to_scan(DVec3(p)));
    Random random(5);
    const auto between = [&](double low, double high) { return low + (high - low) * random.uniform(); };
    for (int i = 0; i < 20000; i++) {
        const double off = 3.0 * std::sqrt(random.uniform()), turn = between(0.0, 2.0 * kPi);
        points.emplace_back(off * std::cos(turn), off * std::sin(turn), 0.004 * random.normal());
    }
    for (int i = 0; i < 3000; i++) {
        const DVec3 middle(kBench, 0.0);
        points.push_back(middle + DVec3(between(-0.75, 0.75), between(-0.2, 0.2), 0.45));
        points.push_back(middle + DVec3(between(-0.75, 0.75), 0.2, between(0.45, 0.72)));
        points.push_back(middle + DVec3(i % 2 ? 0.7 : -0.7, between(-0.2, 0.2), between(0.0, 0.45)));
    }
    return points;
}

PointCloud cleaned(const std::vector<DVec3>& points, bool known) {
    PointCloud cloud;
    for (const DVec3& p : points)
        cloud.positions.emplace_back(p);
    OrientOptions orient;
    orient.up = UpAxis::kZ;
    orient.metres_per_unit = 1.0;
    orient_cloud(cloud, orient);
    CleanOptions options;
    if (known) options.pick.position = DVec3(0.1, -0.1, 1.0);
    clean_cloud(cloud, options);
    return cloud;
}

size_t count(const PointCloud& cloud, bool of_bench) {
    size_t found = 0;
    for (const Vec3& p : cloud.positions)
        found += is_bench(cloud.frame.to_scan(DVec3(p))) == of_bench;
    return found;
}

class Beside : public ::testing::TestWithParam<Habit> {};

TEST_P(Beside, ABenchIsNoneOfTheTree) {
    const std::vector<DVec3> points = garden(GetParam());
    const PointCloud open = cleaned(points, false), known = cleaned(points, true);
    EXPECT_GT(count(open, true), 4000U);
    EXPECT_LT(count(known, true), 200U);
    EXPECT_GT(static_cast<double>(count(known, false)), 0.99 * static_cast<double>(count(open, false)));
}

// As where a hedge hid the stem.
TEST_P(Beside, AFootBelowAGapStays) {
    std::vector<DVec3> points = garden(GetParam());
    std::erase_if(points,
                  [](const DVec3& p) { return p.z > 0.7 && p.z < 1.6 && std::hypot(p.x, p.y) < 3.0; });
    const PointCloud known = cleaned(points, true);
    size_t foot = 0;
    for (const Vec3& p : known.positions) {
        const DVec3 at = known.frame.to_scan(DVec3(p));
        foot += at.z < 0.7 && std::hypot(at.x, at.y) < 0.5;
    }
    EXPECT_GT(foot, 100U);
    EXPECT_LT(count(known, true), 200U);
}

INSTANTIATE_TEST_SUITE_P(Habits, Beside,
                         ::testing::Values(Habit::kBroadleaf, Habit::kConifer, Habit::kForked,
                                           Habit::kBirch));

}  // namespace
}  // namespace treerec
