#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "geometry/circle_fit.h"

namespace treerec {
namespace {

TEST(FitCircle, FindsACircleAmongOutliers) {
    for (uint64_t seed = 1; seed <= 50; seed++) {
        Random random(seed);
        const DVec2 centre = {random.uniform(-1, 1), random.uniform(-1, 1)};
        const double radius = random.uniform(0.02, 0.5);
        const double from = random.uniform(0.0, 6.0);
        std::vector<DVec2> points;
        for (int i = 0; i < 60; i++) {
            const double angle = from + random.uniform(0.0, 4.0);  // 230 degrees are seen
            const double r = radius * (1.0 + 0.02 * random.normal());
            points.push_back(centre + r * DVec2(std::cos(angle), std::sin(angle)));
        }
        for (int i = 0; i < 12; i++)
            points.push_back(centre + radius * DVec2(random.uniform(-2, 2), random.uniform(-2, 2)));
        const std::optional<CircleFit> fit = fit_circle(points, 10.0 * radius, Random(seed));
        ASSERT_TRUE(fit.has_value());
        EXPECT_NEAR(fit->radius, radius, 0.04 * radius) << seed;
        EXPECT_LT(glm::distance(fit->centre, centre), 0.05 * radius) << seed;
        EXPECT_GE(fit->coverage, 0.5);
        EXPECT_LT(fit->spread, 0.1 * radius);
    }
}

// Arcs of half a circle: what the fit says of its error is what it errs by.
TEST(FitCircle, KnowsItsError) {
    std::vector<double> wrong;
    std::vector<double> said;
    for (uint64_t seed = 1; seed <= 201; seed++) {
        Random random(seed);
        std::vector<DVec2> points;
        for (int i = 0; i < 80; i++) {
            const double angle = random.uniform(0.0, 3.0);
            points.push_back((1.0 + 0.05 * random.normal()) * DVec2(std::cos(angle), std::sin(angle)));
        }
        const std::optional<CircleFit> fit = fit_circle(points, 10.0, Random(seed));
        ASSERT_TRUE(fit.has_value());
        wrong.push_back(std::abs(fit->radius - 1.0));
        said.push_back(fit->error);
    }
    std::sort(wrong.begin(), wrong.end());
    std::sort(said.begin(), said.end());
    // Half of all normal errors are below 0.67 standard errors.
    EXPECT_GT(0.67 * said[100], 0.7 * wrong[100]);
    EXPECT_LT(0.67 * said[100], 1.4 * wrong[100]);
}

TEST(FitCircle, RefusesLinesAndFewPoints) {
    std::vector<DVec2> points;
    for (int i = 0; i < 4; i++)
        points.emplace_back(std::cos(i), std::sin(i));
    EXPECT_FALSE(fit_circle(points, 10.0, Random(1)).has_value());
    points.clear();
    for (int i = 0; i < 50; i++)
        points.emplace_back(0.01 * i, 0.02 * i);
    EXPECT_FALSE(fit_circle(points, 10.0, Random(1)).has_value());
    points.assign(20, DVec2(0.5, 0.5));
    EXPECT_FALSE(fit_circle(points, 10.0, Random(1)).has_value());
}

TEST(FitCircle, SaysThatADiscIsNoRing) {
    Random random(4);
    std::vector<DVec2> points;
    while (points.size() < 200) {
        const DVec2 p = {random.uniform(-1, 1), random.uniform(-1, 1)};
        if (glm::length(p) < 1.0) points.push_back(p);
    }
    const std::optional<CircleFit> fit = fit_circle(points, 5.0, Random(2));
    if (fit) {
        EXPECT_GT(fit->inside + fit->spread / fit->radius, 0.25);
    }
}

TEST(FitRing, CentresASquare) {
    Random random(9);
    std::vector<DVec2> points;
    for (int i = 0; i < 400; i++) {
        const double along = random.uniform(-0.1, 0.1);
        // One side is sampled three times as densely as the others.
        const uint32_t side = random.below(6);
        if (side == 0) points.emplace_back(0.1, along);
        if (side == 1) points.emplace_back(-0.1, along);
        if (side == 2) points.emplace_back(along, 0.1);
        if (side >= 3) points.emplace_back(along, -0.1);
    }
    const std::optional<CircleFit> fit = fit_ring(points);
    ASSERT_TRUE(fit.has_value());
    EXPECT_LT(glm::length(fit->centre), 0.015);
    EXPECT_NEAR(fit->radius, 0.11, 0.015);
    EXPECT_EQ(fit->coverage, 1.0);
    EXPECT_EQ(fit->inside, 0.0);
}

}  // namespace
}  // namespace treerec
