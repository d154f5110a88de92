// Where a stem stands.
#include "skeleton/cylinders/stem_base.h"

#include <gtest/gtest.h>

#include "geometry/random.h"

namespace treerec {
namespace {

constexpr double kRadius = 0.15;

// A straight stem of stations 10 cm apart; the first ones are those of a spur, up to a radius aside.
std::vector<Station> stem_on_spur(Random& random, const DVec3& base, const DVec3& along, size_t spur) {
    std::vector<Station> stem(20);
    for (size_t i = 0; i < stem.size(); i++) {
        stem[i].position = base + 0.1 * static_cast<double>(i) * along;
        stem[i].radius = kRadius;
        stem[i].measured = true;
        if (i < spur) {
            stem[i].position.x += random.uniform(-1.0, 1.0) * kRadius;
            stem[i].position.z += random.uniform(-1.0, 1.0) * kRadius;
        }
    }
    return stem;
}

TEST(StemBase, TheRootLiesWhereTheStemComesFrom) {
    Random random(3);
    for (int i = 0; i < 500; i++) {
        const DVec3 base(random.uniform(-9, 9), random.uniform(-1, 1), random.uniform(-9, 9));
        const DVec3 along = glm::normalize(DVec3(random.uniform(-0.7, 0.7), 1.0, random.uniform(-0.7, 0.7)));
        std::vector<std::vector<Station>> axes{stem_on_spur(random, base, along, 1)};
        const std::vector<Station> before = axes[0];
        seat_root(std::vector<SkeletonBranch>(1), axes);
        EXPECT_LT(glm::distance(axes[0][0].position, base), 1e-9);
        for (size_t k = 1; k < before.size(); k++)
            EXPECT_EQ(axes[0][k].position, before[k].position);
    }
}

// The axis must not go down before it goes up.
TEST(StemBase, StationsBelowTheRootGoWithIt) {
    Random random(4);
    std::vector<std::vector<Station>> axes{stem_on_spur(random, DVec3(0.0), DVec3(0, 1, 0), 2)};
    axes[0][1].position.y = -0.04;
    seat_root(std::vector<SkeletonBranch>(1), axes);
    for (size_t i = 0; i < 2; i++)
        EXPECT_LT(glm::distance(axes[0][i].position, DVec3(0.0, 0.1 * static_cast<double>(i), 0.0)), 1e-9);
}

// A palm of 6 m, whose base is twice as thick as its stem up to a height of 0.7 m.
TEST(StemBase, AFlareDoesNotUnmakeWhatIsMeasuredAboveIt) {
    std::vector<Station> stem(60);
    for (size_t i = 0; i < stem.size(); i++) {
        const double height = 0.1 * static_cast<double>(i);
        stem[i].position = {0.0, height, 0.0};
        stem[i].radius = height < 0.5 ? 0.34 : height < 0.8 ? 0.27 : 0.18 - 0.01 * height;
        stem[i].measured = true;
    }
    const std::vector<Station> before = stem;
    limit_stem_base(stem);
    for (size_t i = 0; i < stem.size(); i++) {
        EXPECT_TRUE(stem[i].measured) << "at " << stem[i].position.y;
        EXPECT_EQ(stem[i].radius, before[i].radius) << "at " << stem[i].position.y;
    }
}

TEST(StemBase, ASpurBelowTheStemTellsNothingOfIt) {
    std::vector<Station> stem(60);
    for (size_t i = 0; i < stem.size(); i++) {
        stem[i].position = {0.0, 0.1 * static_cast<double>(i), 0.0};
        stem[i].radius = i < 3 ? 0.05 : 0.15;
        stem[i].measured = true;
    }
    limit_stem_base(stem);
    for (size_t i = 0; i < stem.size(); i++)
        EXPECT_EQ(stem[i].measured, i >= 3) << "at " << stem[i].position.y;
}

TEST(StemBase, OfALyingBranchKeepsItsLength) {
    Random random(5);
    std::vector<std::vector<Station>> axes{stem_on_spur(random, DVec3(0.0), DVec3(1, 0, 0), 1)};
    axes[0][0].position = {0.02, -0.1, 0.05};
    seat_root(std::vector<SkeletonBranch>(1), axes);
    EXPECT_LT(glm::distance(axes[0][0].position, DVec3(0.02, 0.0, 0.0)), 1e-9);
}

TEST(StemBase, ATwigAtTheRootIsNoStemButASecondStemIs) {
    for (const double share : {0.1, 0.6}) {
        Random random(6);
        std::vector<std::vector<Station>> axes{stem_on_spur(random, DVec3(0.0), DVec3(0, 1, 0), 1)};
        axes[0][0].position = {0.1, 0.0, 0.0};
        axes.push_back(stem_on_spur(random, DVec3(0.1, 0.0, 0.0), DVec3(1, 0, 0), 0));
        for (Station& station : axes[1])
            station.radius = share * kRadius;
        std::vector<SkeletonBranch> branches(2);
        branches[1].parent = 0;
        seat_root(branches, axes);
        EXPECT_NEAR(axes[0][0].position.x, share < 0.33 ? 0.0 : 0.1, 1e-9);
    }
}

TEST(StemBase, WhatIsTooFarOrTooShortToTellStays) {
    Random random(7);
    std::vector<std::vector<Station>> axes{stem_on_spur(random, DVec3(0.0), DVec3(0, 1, 0), 1)};
    axes[0][0].position = {3.0 * kRadius, 0.0, 0.0};
    seat_root(std::vector<SkeletonBranch>(1), axes);
    EXPECT_EQ(axes[0][0].position.x, 3.0 * kRadius);
    for (size_t count = 0; count < 3; count++) {
        axes[0].resize(count);
        seat_root(std::vector<SkeletonBranch>(1), axes);
        EXPECT_EQ(axes[0].size(), count);
    }
}

}  // namespace
}  // namespace treerec
