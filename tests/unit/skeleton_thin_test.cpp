#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include "geometry/random.h"
#include "skeleton/sampling/thin.h"

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

// How far points lie from the y axis, as a root of the mean square.
double spread_of(const std::vector<Vec3>& points) {
    double sum = 0.0;
    for (const Vec3& p : points)
        sum += static_cast<double>(p.x) * p.x + static_cast<double>(p.z) * p.z;
    return std::sqrt(sum / static_cast<double>(points.size()));
}

std::vector<Vec3> noisy_twig(uint64_t seed, int count, double noise) {
    Random random(seed);
    std::vector<Vec3> points;
    for (int i = 0; i < count; i++)
        points.emplace_back(random.normal() * noise, random.uniform(0.0, 1.0), random.normal() * noise);
    return points;
}

TEST(ThinPoints, TheSampleIsAsDenseAsTheCloud) {
    SubProgress progress(nullptr, 0, 1);
    const std::vector<Vec3> points = noisy_twig(4, 40000, 0.01);
    const ThinnedCloud thinned = thin_with_sample(points, 0.012, progress);
    ASSERT_EQ(thinned.sample.size(), thinned.cube.size());
    EXPECT_LE(thinned.sample.size(), 2 * thinned.points.size());
    EXPECT_NEAR(spread_of(thinned.sample), spread_of(points), 0.07 * spread_of(points));
    EXPECT_GT(spread_of(thinned.points), 1.3 * spread_of(points));
    for (size_t i = 0; i < thinned.sample.size(); i++) {
        ASSERT_LT(thinned.cube[i], thinned.points.size());
        EXPECT_LT(glm::distance(thinned.sample[i], thinned.points[thinned.cube[i]]), 0.012 * std::sqrt(3.0));
    }
}

TEST(ThinPoints, TheSampleDoesNotMindOrderRepetitionOrNaN) {
    SubProgress progress(nullptr, 0, 1);
    std::vector<Vec3> points = noisy_twig(5, 8000, 0.01);
    const ThinnedCloud first = thin_with_sample(points, 0.015, progress);
    ASSERT_FALSE(first.sample.empty());
    std::reverse(points.begin(), points.end());
    points.insert(points.end(), points.begin(), points.begin() + 5000);
    points.emplace_back(0.0f, std::nanf(""), 0.0f);
    const ThinnedCloud second = thin_with_sample(points, 0.015, progress);
    EXPECT_EQ(second.points, first.points);
    EXPECT_EQ(second.sample, first.sample);
    EXPECT_EQ(second.cube, first.cube);
}

// Beams that an edge splits between a stem and what is behind it: sparse, but not alone.
TEST(ThinPoints, StraysBesideDenseWoodGoAndSparseTwigsStay) {
    SubProgress progress(nullptr, 0, 1);
    Random random(8);
    std::vector<Vec3> points;
    const auto add_ring = [&](float x, float radius, int count) {
        for (int i = 0; i < count; i++) {
            const double turn = random.uniform(0.0, 6.2831853);
            points.emplace_back(x + radius * std::cos(turn), random.uniform(0.0, 1.0),
                                radius * std::sin(turn));
        }
    };
    add_ring(0.0f, 0.1f, 120000);
    const size_t stem = points.size();
    add_ring(0.3f, 0.004f, 1500);  // a third as dense
    const size_t wood = points.size();
    for (int i = 0; i < 300; i++)
        points.emplace_back(0.1, random.uniform(0.0, 1.0), random.uniform(0.15, 0.45));
    const ThinnedCloud thinned = thin_with_sample(points, 0.01, progress);
    std::set<std::tuple<float, float, float>> kept;
    for (const Vec3& p : thinned.points)
        kept.insert({p.x, p.y, p.z});
    const auto count = [&](size_t from, size_t to) {
        return std::count_if(points.begin() + static_cast<ptrdiff_t>(from),
                             points.begin() + static_cast<ptrdiff_t>(to), [&](const Vec3& p) {
                                 return kept.count({p.x, p.y, p.z}) > 0;
                             });
    };
    EXPECT_GT(count(0, stem), 6000);
    EXPECT_GT(count(stem, wood), 100);
    EXPECT_LT(count(wood, points.size()), 30);
    for (const uint32_t cube : thinned.cube)
        ASSERT_LT(cube, thinned.points.size());
}

TEST(ThinPoints, TheSideOfAStemThatOneFarStationSawStays) {
    SubProgress progress(nullptr, 0, 1);
    Random random(9);
    std::vector<Vec3> points;
    const auto add_half = [&](double turn, int count) {
        for (int i = 0; i < count; i++) {
            const double angle = turn + random.uniform(0.0, 3.14159);
            points.emplace_back(0.1 * std::cos(angle), random.uniform(0.0, 1.0), 0.1 * std::sin(angle));
        }
    };
    add_half(0.0, 400000);
    add_half(3.14159, 16000);
    const ThinnedCloud thinned = thin_with_sample(points, 0.01, progress);
    const auto far =
        std::count_if(thinned.points.begin(), thinned.points.end(), [](const Vec3& p) { return p.z < 0.0f; });
    EXPECT_GT(far, 3000);
}

TEST(ThinPoints, ASparseCloudNeedsNoSample) {
    SubProgress progress(nullptr, 0, 1);
    const ThinnedCloud thinned = thin_with_sample(random_points(6, 2000), 0.01, progress);
    EXPECT_TRUE(thinned.sample.empty());
    EXPECT_EQ(&thinned.measured(), &thinned.points);
}

TEST(AutomaticSpacing, BoundsThePointsKept) {
    SubProgress progress(nullptr, 0, 1);
    const std::vector<Vec3> points = random_points(3, 3 * static_cast<int>(kMostPoints));
    const size_t kept = thin_points(points, automatic_spacing(points), progress).size();
    EXPECT_LE(kept, kMostPoints);
    EXPECT_GT(kept, kMostPoints / 4);
}

TEST(AutomaticSpacing, KeepsAShareOfAVeryLargeCloud) {
    SubProgress progress(nullptr, 0, 1);
    std::vector<Vec3> points = random_points(4, 8 * static_cast<int>(kMostPoints));
    const double spacing = automatic_spacing(points);
    const size_t kept = thin_points(points, spacing, progress).size();
    EXPECT_LE(kept, points.size() / 5);
    EXPECT_GT(kept, kMostPoints);
    points.insert(points.end(), points.begin(), points.begin() + static_cast<ptrdiff_t>(kMostPoints));
    EXPECT_EQ(automatic_spacing(points), spacing);
}

}  // namespace
}  // namespace treerec
