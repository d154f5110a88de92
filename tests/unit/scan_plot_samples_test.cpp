#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "geometry/random.h"
#include "scan/cleaning/samples.h"
#include "scan/robust.h"

namespace treerec {
namespace {

std::vector<Vec3> box_of(double width, double height, double depth, int count) {
    Random random(1);
    std::vector<Vec3> points;
    for (int i = 0; i < count; i++)
        points.emplace_back(random.uniform(0.0, width), random.uniform(0.0, height),
                            random.uniform(0.0, depth));
    return points;
}

TEST(SamplesFor, ATreeAndAPlotShowTheSameDetail) {
    EXPECT_EQ(samples_for(box_of(8.0, 20.0, 9.0, 500000)), 400000u);
    const size_t plot = samples_for(box_of(40.0, 20.0, 30.0, 500000));
    EXPECT_NEAR(static_cast<double>(plot), 1.2e6, 3e4);
    EXPECT_EQ(samples_for(box_of(400.0, 20.0, 300.0, 500000)), 3000000u);
}

TEST(SamplesFor, FlatAndSmallCloudsHaveALimitToo) {
    EXPECT_EQ(samples_for({}), 400000u);
    EXPECT_EQ(samples_for(box_of(400.0, 20.0, 300.0, 1000)), 400000u);
    EXPECT_EQ(samples_for(box_of(40.0, 0.0, 30.0, 500000)), 3000000u);
    EXPECT_EQ(samples_for(std::vector<Vec3>(500000, Vec3(1.0f))), 400000u);
}

TEST(AveragePoints, EachIsTheMeanOfItsPoints) {
    const std::vector<Vec3> points = box_of(2.0, 5.0, 1.0, 20000);
    const Samples means = average_points(points, robust_ranges(points), 0.1, nullptr);
    ASSERT_EQ(means.of_point.size(), points.size());
    EXPECT_LE(means.points.size(), 21U * 51U * 11U);
    EXPECT_GE(means.points.size(), 19U * 49U * 9U);
    std::vector<DVec3> sums(means.points.size(), DVec3(0.0));
    std::vector<double> counts(means.points.size(), 0.0);
    for (size_t i = 0; i < points.size(); i++) {
        ASSERT_LT(means.of_point[i], means.points.size());
        sums[means.of_point[i]] += DVec3(points[i]);
        counts[means.of_point[i]]++;
        EXPECT_LT(glm::distance(points[i], means.points[means.of_point[i]]), 0.1F * std::sqrt(3.0F));
    }
    for (size_t m = 0; m < means.points.size(); m++)
        EXPECT_LT(glm::distance(DVec3(means.points[m]), sums[m] / counts[m]), 5e-5);
}

TEST(AveragePoints, TheOrderOfThePointsIsNoMatter) {
    std::vector<Vec3> points = box_of(2.0, 5.0, 1.0, 20000);
    const std::array<Range, 3> ranges = robust_ranges(points);
    const Samples means = average_points(points, ranges, 0.3, nullptr);
    Random random(2);
    std::vector<uint32_t> from(points.size());
    std::iota(from.begin(), from.end(), 0U);
    for (size_t i = points.size(); i > 1; i--)
        std::swap(from[i - 1], from[random.below(static_cast<uint32_t>(i))]);
    std::vector<Vec3> shuffled;
    for (const uint32_t i : from)
        shuffled.push_back(points[i]);
    const Samples again = average_points(shuffled, ranges, 0.3, nullptr);
    EXPECT_EQ(again.points, means.points);
    for (size_t i = 0; i < from.size(); i++)
        EXPECT_EQ(again.of_point[i], means.of_point[from[i]]);
}

}  // namespace
}  // namespace treerec
