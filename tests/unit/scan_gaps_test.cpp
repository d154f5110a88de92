// What stands behind a gap is part of the tree, and nothing of weight goes without a word.
#include <gtest/gtest.h>

#include <cmath>

#include "scan/cleaning/clean_cloud.h"
#include "scan_samples.h"

namespace treerec {
namespace {

using namespace scan_test;

constexpr double kGap = 1.0;  // metres

size_t fragments_of(const CleanReport& report) {
    for (const CleanStep& step : report.steps)
        if (step.name == "Fragments") return step.removed;
    ADD_FAILURE() << "no step Fragments";
    return 0;
}

bool says(const std::vector<std::string>& warnings, const std::string& words) {
    return std::ranges::any_of(warnings, [&](const std::string& w) { return w.find(words) != w.npos; });
}

// A young tree of 3.6 m, less than four gaps high: stem, and from 1.2 m upwards ten branches.
std::vector<Vec3> young_tree(uint64_t seed) {
    Random random(seed);
    std::vector<Vec3> points;
    add_cylinder(points, random, {0, 0, 0}, {0.1, 3.6, -0.1}, 0.035, 0.008, 6000);
    for (int i = 0; i < 10; i++) {
        const double h = 1.2 + 0.2 * i;
        const double angle = 2.4 * i;
        const DVec3 foot = DVec3(0.1, 3.6, -0.1) * (h / 3.6);
        add_cylinder(points, random, foot,
                     foot + (1.1 - 0.07 * i) * glm::normalize(DVec3(std::cos(angle), 0.8, std::sin(angle))),
                     0.012, 0.004, 500);
    }
    return points;
}

TEST(ScanGaps, AStemWithAGapStaysWholeWhereverTheGapIs) {
    for (uint64_t seed = 1; seed <= 3; seed++) {
        for (double from = 0.15; from < 2.5; from += 0.15) {
            SCOPED_TRACE(from);
            PointCloud cloud;
            cloud.positions = young_tree(seed);
            std::erase_if(cloud.positions, [&](const Vec3& p) { return p.y > from && p.y < from + kGap; });
            const size_t all = cloud.size();
            const CleanReport report = clean_cloud(cloud, {});
            // A branch's tip cut off by the gap is no piece of the stem.
            EXPECT_LE(fragments_of(report), all / 100);
            size_t foot = 0;
            for (const Vec3& p : cloud.positions)
                foot += p.y < from;
            EXPECT_GT(foot, 200U);
            EXPECT_TRUE(report.warnings.empty());
        }
    }
}

TEST(ScanGaps, AStemOfAnySlantStandsBelowItsGap) {
    for (const double lean : {0.0, 0.15, 0.3}) {
        for (const double stump : {0.15, 0.3, 0.5}) {
            SCOPED_TRACE(std::to_string(lean) + " " + std::to_string(stump));
            PointCloud cloud;
            for (const Vec3& p : young_tree(7))
                if (p.y < stump || p.y > stump + kGap)
                    cloud.positions.emplace_back(p.x + lean * p.y, p.y, p.z);
            clean_cloud(cloud, {});
            size_t foot = 0;
            for (const Vec3& p : cloud.positions)
                foot += p.y < stump;
            EXPECT_GT(foot, 200U);
        }
    }
}

TEST(ScanGaps, ABranchBehindAGapStays) {
    for (int turn = 0; turn < 8; turn++) {
        SCOPED_TRACE(turn);
        Random random(static_cast<uint64_t>(turn));
        PointCloud cloud;
        cloud.positions = young_tree(4);
        const DVec3 along(0.94 * std::cos(turn), 0.3, 0.94 * std::sin(turn));
        const DVec3 foot = DVec3(0.1, 3.6, -0.1) * (2.1 / 3.6);
        std::vector<Vec3> branch;
        add_cylinder(branch, random, foot + 1.5 * along, foot + 2.6 * along, 0.012, 0.006, 600);
        add_cylinder(cloud.positions, random, foot, foot + 0.4 * along, 0.018, 0.016, 400);
        // Nothing else near the line.
        std::erase_if(cloud.positions, [&](const Vec3& p) {
            const DVec3 d = DVec3(p) - foot;
            return glm::length(d) > 0.45 && glm::dot(glm::normalize(d), along) > 0.75 && p.y < 3.0F;
        });
        cloud.positions.insert(cloud.positions.end(), branch.begin(), branch.end());
        const CleanReport report = clean_cloud(cloud, {});
        EXPECT_LE(fragments_of(report), branch.size() / 20);
    }
}

// Near the stem on the ground, but neither stem nor in its line.
TEST(ScanGaps, WhatLiesBesideTheTreeGoesWithAWord) {
    Random random(3);
    PointCloud cloud;
    cloud.positions = young_tree(5);
    const size_t tree = cloud.size();
    for (int i = 0; i < 500; i++)
        cloud.positions.emplace_back(1.9 + random.uniform(-0.2, 0.2), random.uniform(0, 0.3),
                                     1.9 + random.uniform(-0.2, 0.2));
    CleanOptions options;
    options.pick.enabled = false;
    options.remove_ground = false;
    const CleanReport report = clean_cloud(cloud, options);
    EXPECT_GE(fragments_of(report), 490U);
    EXPECT_LE(cloud.size(), tree);
    ASSERT_EQ(report.warnings.size(), 1U);
    EXPECT_TRUE(says(report.warnings, "4 % of the points stand well apart")) << report.warnings[0];
}

// Bark that is white or black by nature, or in the sun, is part of the tree.
TEST(ScanColors, PaleAndDarkBarkStays) {
    for (const Color8& extreme : {Color8{255, 255, 253}, Color8{2, 1, 0}}) {
        for (int kind = 0; kind < 4; kind++) {
            SCOPED_TRACE(std::to_string(extreme[0]) + " " + std::to_string(kind));
            PointCloud cloud;
            cloud.positions = tree_points(6);
            for (const Vec3& p : cloud.positions) {
                const bool is = kind == 0   ? p.y < 3.0F                          // the foot of the stem
                                : kind == 1 ? glm::length(Vec2(p.x, p.z)) > 1.0F  // all twigs
                                : kind == 2 ? std::sin(12.0F * p.y) > 0.5F        // a birch's bands
                                            : p.x > 0.02F * p.y + 0.02F;          // one side
                cloud.colors.push_back(is ? extreme : Color8{90, static_cast<uint8_t>(60.0F + p.y), 50});
            }
            const size_t all = cloud.size();
            const CleanReport report = clean_cloud(cloud, {});
            EXPECT_EQ(report.steps[0].removed, 0U);
            EXPECT_GT(cloud.size(), all - all / 200);
            ASSERT_EQ(report.warnings.size(), 1U);
            EXPECT_TRUE(says(report.warnings, "they were kept")) << report.warnings[0];
        }
    }
}

// Sky that photos gave the rim of the wood.
TEST(ScanColors, AHaloGoesWithAWord) {
    Random random(2);
    PointCloud cloud;
    cloud.positions = tree_points(6);
    cloud.colors.assign(cloud.size(), Color8{90, 70, 50});
    const size_t wood = cloud.size();
    cloud.colors[0] = {91, 70, 50};
    for (size_t i = 0; i < wood; i += 2) {
        cloud.positions.push_back(cloud.positions[i] + Vec3(random.uniform(0.08, 0.15) * random.direction()));
        cloud.colors.push_back({255, 254, 253});
    }
    // What fell into the wood is not at its rim, but there is more outside.
    const size_t halo = cloud.size() - wood;
    const CleanReport report = clean_cloud(cloud, {});
    EXPECT_EQ(report.steps[0].removed, halo);
    ASSERT_EQ(report.warnings.size(), 1U);
    EXPECT_TRUE(says(report.warnings, "33 % of the points are near white")) << report.warnings[0];
}

TEST(ScanGaps, TheFootOfARealTreeBelowAGap) {
    const std::string folder = scans_folder();
    if (folder.empty()) GTEST_SKIP() << "TREEREC_SCANS does not name the folder of the real scans.";
    PointCloud cloud = read_cloud(folder + "rtwig_coffeetree.txt");
    OrientOptions up;
    up.up = UpAxis::kZ;
    up.metres_per_unit = 1.0;
    orient_cloud(cloud, up);
    float low = cloud.positions.front().y;
    for (const Vec3& p : cloud.positions)
        low = std::min(low, p.y);
    std::erase_if(cloud.positions, [&](const Vec3& p) { return p.y > low + 0.5F && p.y < low + 1.5F; });
    EXPECT_EQ(fragments_of(clean_cloud(cloud, {})), 0U);
}

}  // namespace
}  // namespace treerec
