#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "geometry/random.h"
#include "skeleton/cylinders/one_sided.h"

namespace treerec {
namespace {

constexpr double kPi = 3.14159265358979323846;

// What a scanner sees of a stem from one side, evenly across its beams, about the middle of what is seen.
std::vector<Vec2> half_circle(Random& random, double radius, double noise, int count) {
    const double turn = random.uniform(0.0, 2.0 * kPi);
    std::vector<DVec2> points;
    DVec2 middle(0.0);
    for (int i = 0; i < count; i++) {
        const double across = random.uniform(-radius, radius);
        const double depth = std::sqrt(radius * radius - across * across) + noise * random.normal();
        points.emplace_back(std::cos(turn) * across - std::sin(turn) * depth,
                            std::sin(turn) * across + std::cos(turn) * depth);
        middle += points.back() / static_cast<double>(count);
    }
    std::vector<Vec2> offsets;
    for (const DVec2& p : points)
        offsets.emplace_back(p - middle);
    return offsets;
}

std::vector<Vec2> whole_circle(Random& random, double radius, double noise, int count) {
    std::vector<Vec2> offsets;
    for (int i = 0; i < count; i++) {
        const double angle = random.uniform(0.0, 2.0 * kPi);
        const double at = radius + noise * random.normal();
        offsets.emplace_back(at * std::cos(angle), at * std::sin(angle));
    }
    return offsets;
}

double median_of(const std::vector<Vec2>& offsets) {
    std::vector<double> lengths;
    for (const Vec2& offset : offsets)
        lengths.push_back(glm::length(offset));
    std::sort(lengths.begin(), lengths.end());
    return lengths[lengths.size() / 2];
}

TEST(RadiusAcross, OneSideTellsTheWholeWidth) {
    std::vector<float> scratch;
    std::vector<double> told, before;
    for (uint64_t seed = 1; seed <= 200; seed++) {
        Random random(seed);
        const double radius = random.uniform(0.01, 0.3);
        const std::vector<Vec2> offsets = half_circle(random, radius, 0.1 * radius, 40);
        const double median = median_of(offsets);
        told.push_back(radius_across(offsets, median, 0.1 * radius, scratch) / radius);
        before.push_back(median / radius);
    }
    std::sort(told.begin(), told.end());
    std::sort(before.begin(), before.end());
    EXPECT_LT(before[100], 0.6);
    EXPECT_NEAR(told[100], 0.92, 0.06);
    EXPECT_GT(told[10], 0.7);
    EXPECT_LT(told[190], 1.1);
}

TEST(RadiusAcross, PointsAllAroundKeepTheMedian) {
    std::vector<float> scratch;
    int kept = 0;
    for (uint64_t seed = 1; seed <= 200; seed++) {
        Random random(seed);
        const std::vector<Vec2> offsets = whole_circle(random, 0.05, 0.005, 40);
        const double median = median_of(offsets);
        const double told = radius_across(offsets, median, 0.005, scratch);
        EXPECT_GE(told, median);
        kept += told == median ? 1 : 0;
    }
    EXPECT_GE(kept, 195);
}

TEST(RadiusAcross, FewPointsMuchNoiseAndUnknownNoiseKeepTheMedian) {
    std::vector<float> scratch;
    Random random(3);
    const std::vector<Vec2> offsets = half_circle(random, 0.05, 0.005, 40);
    const double median = median_of(offsets);
    EXPECT_GT(radius_across(offsets, median, 0.005, scratch), 1.3 * median);
    EXPECT_EQ(radius_across(std::span(offsets).first(7), median, 0.005, scratch), median);
    EXPECT_EQ(radius_across(offsets, median, 0.02, scratch), median);
    EXPECT_EQ(radius_across(offsets, median, 0.0, scratch), median);
    EXPECT_EQ(radius_across({}, 0.0, 0.005, scratch), 0.0);
    const std::vector<Vec2> heap(20, Vec2(0.01f, 0.02f));
    EXPECT_EQ(radius_across(heap, 0.022, 0.001, scratch), 0.022);
}

}  // namespace
}  // namespace treerec
