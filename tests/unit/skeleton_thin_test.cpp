#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <tuple>

#include "geometry/random.h"
#include "skeleton/thin.h"

namespace treerec {
namespace {

std::vector<Vec3> random_points(uint64_t seed, int count) {
    Random random(seed);
    std::vector<Vec3> points;
    for (int i = 0; i < count; i++)
        points.emplace_back(random.uniform(-5, 5), random.uniform(0, 10), random.uniform(-5, 5));
    return points;
}

TEST(ThinPoints, KeepsOneScannedPointPerCell) {
    SubProgress progress(nullptr, 0, 1);
    const std::vector<Vec3> points = random_points(1, 20000);
    const std::vector<Vec3> thinned = thin_points(points, 0.5, progress);
    DVec3 low(1e9);
    std::set<std::tuple<float, float, float>> scanned;
    for (const Vec3& p : points) {
        low = glm::min(low, DVec3(p));
        scanned.insert({p.x, p.y, p.z});
    }
    std::set<std::tuple<int, int, int>> cells;
    for (const Vec3& p : points) {
        const DVec3 c = glm::floor((DVec3(p) - low) / 0.5);
        cells.insert({static_cast<int>(c.x), static_cast<int>(c.y), static_cast<int>(c.z)});
    }
    EXPECT_EQ(thinned.size(), cells.size());
    for (const Vec3& p : thinned)
        EXPECT_TRUE(scanned.count({p.x, p.y, p.z}));
}

TEST(ThinPoints, DoesNotMindOrderRepetitionOrNaN) {
    SubProgress progress(nullptr, 0, 1);
    std::vector<Vec3> points = random_points(2, 5000);
    const std::vector<Vec3> first = thin_points(points, 0.7, progress);
    std::reverse(points.begin(), points.end());
    points.insert(points.end(), points.begin(), points.begin() + 3000);
    points.emplace_back(std::nanf(""), 0.0f, 0.0f);
    points.emplace_back(0.0f, INFINITY, 0.0f);
    EXPECT_EQ(thin_points(points, 0.7, progress), first);
}

TEST(AutomaticSpacing, BoundsThePointsKept) {
    SubProgress progress(nullptr, 0, 1);
    const std::vector<Vec3> points = random_points(3, 400000);
    const double spacing = automatic_spacing(points);
    const size_t kept = thin_points(points, spacing, progress).size();
    EXPECT_LE(kept, kMostPoints);
    EXPECT_GT(kept, kMostPoints / 4);
}

}  // namespace
}  // namespace treerec
