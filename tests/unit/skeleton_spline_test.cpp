// Axes as smooth as wood grows.
#include "skeleton/cylinders/spline.h"

#include <gtest/gtest.h>

#include "geometry/random.h"

namespace treerec::test {
namespace {

constexpr double kStep = 0.02;

// A twig on an arc of half a metre, whose stations noise has moved.
std::vector<Station> noisy_twig(double noise, uint64_t seed) {
    Random random(seed);
    std::vector<Station> line;
    for (int i = 1; i <= 30; i++) {
        const double turn = kStep * i / 0.5;
        Station station;
        station.position = DVec3(0.5 * std::sin(turn), 0.5 * (1.0 - std::cos(turn)), 0.0) +
                           noise * DVec3(random.normal(), random.normal(), random.normal());
        station.radius = 0.003;
        station.scatter = noise;
        line.push_back(station);
    }
    return line;
}

double off_arc(const std::vector<Station>& line) {
    double sum = 0.0;
    for (const Station& station : line) {
        const DVec3 p = station.position - DVec3(0.0, 0.5, 0.0);
        const double out = std::hypot(p.x, p.y) - 0.5;
        sum += out * out + p.z * p.z;
    }
    return std::sqrt(sum / static_cast<double>(line.size()));
}

double sharpest(const std::vector<Station>& line) {
    double most = 0.0;
    for (size_t i = 1; i + 1 < line.size(); i++) {
        const DVec3 in = glm::normalize(line[i].position - line[i - 1].position);
        const DVec3 out = glm::normalize(line[i + 1].position - line[i].position);
        most = std::max(most, glm::degrees(std::acos(std::clamp(glm::dot(in, out), -1.0, 1.0))));
    }
    return most;
}

TEST(SmoothAxes, NoiseGoesAndTheArcStays) {
    for (uint64_t seed = 1; seed <= 5; seed++) {
        std::vector<std::vector<Station>> axes{noisy_twig(0.006, seed)};
        const double before = off_arc(axes[0]);
        ASSERT_GT(sharpest(axes[0]), 40.0);
        smooth_axes(std::vector<SkeletonBranch>(1), axes);
        EXPECT_LT(off_arc(axes[0]), 0.7 * before) << seed;
        EXPECT_LT(sharpest(axes[0]), 25.0) << seed;
    }
}

TEST(SmoothAxes, WhatIsMeasuredOrStoutAndEndsOfGapsStay) {
    std::vector<std::vector<Station>> axes{noisy_twig(0.006, 7)};
    axes[0][5].measured = true;
    axes[0][9].radius = 0.02;
    axes[0][20].bridged = true;
    const std::vector<Station> before = axes[0];
    smooth_axes(std::vector<SkeletonBranch>(1), axes);
    for (const size_t i : {5, 9, 19, 20})
        EXPECT_EQ(axes[0][i].position, before[i].position) << i;
    EXPECT_GT(glm::distance(axes[0][14].position, before[14].position), 1e-4);
}

TEST(SmoothAxes, BeginWhereTheirParentHasCome) {
    std::vector<std::vector<Station>> axes{noisy_twig(0.006, 8), noisy_twig(0.0, 1)};
    for (Station& station : axes[1])
        station.position += axes[0][10].position + DVec3(0.0, 0.0, 0.01);
    std::vector<SkeletonBranch> branches(2);
    branches[1].parent = 0;
    branches[1].attach = 10;
    smooth_axes(branches, axes);
    // No kink between the fork and the first two stations.
    const DVec3 in = glm::normalize(axes[1][0].position - axes[0][10].position);
    const DVec3 out = glm::normalize(axes[1][1].position - axes[1][0].position);
    EXPECT_GT(glm::dot(in, out), std::cos(glm::radians(30.0)));
}

}  // namespace
}  // namespace treerec::test
