// The unit of a scan: guessed, given, or set by one known length.
#include <gtest/gtest.h>

#include "scan/cleaning/clean_cloud.h"
#include "scan_samples.h"

namespace treerec {
namespace {

using namespace scan_test;

// The test tree, 10 m high and Y up, as a file in Z up and the unit would give it.
PointCloud tree_in(double metres_per_unit, const DVec3& origin = DVec3(0.0)) {
    ScanFrame frame;
    frame.up = UpAxis::kZ;
    frame.metres_per_unit = metres_per_unit;
    PointCloud cloud;
    cloud.frame.origin = origin;
    for (const Vec3& p : tree_points(1))
        cloud.positions.emplace_back(frame.to_scan(DVec3(p)));
    return cloud;
}

double height_of(const PointCloud& cloud) {
    float low = cloud.positions.front().y;
    float high = low;
    for (const Vec3& p : cloud.positions) {
        low = std::min(low, p.y);
        high = std::max(high, p.y);
    }
    return high - low;
}

TEST(ScanScale, NamesTheUnitThatItGuesses) {
    struct Case {
        double unit;
        const char* name;
        DVec3 origin;
    };
    const Case cases[] = {{1.0, "", {0, 0, 0}},
                          {1.0, "", {455000, 5812000, 300}},
                          {0.01, "centimetres", {0, 0, 0}},
                          {0.001, "millimetres", {0, 0, 0}},
                          {1000.0, "kilometres", {0, 0, 0}}};
    for (const Case& c : cases) {
        SCOPED_TRACE(c.name);
        PointCloud cloud = tree_in(c.unit, c.origin);
        const OrientReport report = orient_cloud(cloud, {});
        EXPECT_DOUBLE_EQ(report.metres_per_unit, c.unit);
        EXPECT_TRUE(report.scale_guessed);
        EXPECT_FALSE(report.scale_unknown);
        EXPECT_NEAR(height_of(cloud), 10.0, 0.1);
        ASSERT_EQ(report.warnings.size(), *c.name ? 1U : 0U);
        if (!report.warnings.empty()) {
            EXPECT_NE(report.warnings[0].find(c.name), std::string::npos) << report.warnings[0];
        }
    }
}

// 160 units on a map: 49 m in feet, and nobody maps in centimetres.
TEST(ScanScale, ATallTreeOnAMapIsInFeet) {
    for (const double height : {40.0, 50.0, 100.0}) {
        PointCloud cloud = tree_in(0.3048, {1250000, 640000, 300});
        for (Vec3& p : cloud.positions)
            p *= static_cast<float>(height / 10.0);
        const OrientReport report = orient_cloud(cloud, {});
        EXPECT_DOUBLE_EQ(report.metres_per_unit, 0.3048) << height;
        ASSERT_EQ(report.warnings.size(), 1U);
        EXPECT_NE(report.warnings[0].find("feet"), std::string::npos) << report.warnings[0];
    }
}

TEST(ScanScale, OneKnownLengthSetsIt) {
    OrientOptions options;
    options.up = UpAxis::kZ;
    const DVec3 origin(100.0, 200.0, 300.0);
    // 2 m in the tree.
    options.known_length = KnownLength{origin, origin + DVec3(0.0, 3.0, 4.0), 2.0};
    PointCloud cloud = tree_in(0.4, origin);
    const OrientReport report = orient_cloud(cloud, options);
    EXPECT_DOUBLE_EQ(report.metres_per_unit, 0.4);
    EXPECT_FALSE(report.scale_guessed);
    EXPECT_TRUE(report.warnings.empty());
    EXPECT_NEAR(height_of(cloud), 10.0, 0.1);
}

TEST(ScanScale, TheKnownHeightIsThatOfTheCleanedTree) {
    OrientOptions options;
    options.up = UpAxis::kZ;
    options.known_height = 23.5;
    PointCloud cloud = tree_in(0.123);
    // A bird above it and a hole below are no part of the tree.
    cloud.positions.emplace_back(0.0F, 0.0F, 110.0F);
    cloud.positions.emplace_back(1.0F, 0.0F, -12.0F);
    const PointCloud before = cloud;
    OrientReport report = orient_cloud(cloud, options);
    EXPECT_FALSE(report.scale_guessed);
    clean_cloud(cloud, {});
    settle_height(cloud, options, report);
    EXPECT_NEAR(height_of(cloud), 23.5, 1e-3);
    EXPECT_DOUBLE_EQ(report.metres_per_unit, cloud.frame.metres_per_unit);
    // The frame still leads back to the scan.
    expect_point(cloud, 0, DVec3(before.positions[0]), 1e-4);
}

TEST(ScanScale, RefusesWhatIsNoLength) {
    auto refused = [](const OrientOptions& options) {
        PointCloud cloud = tree_in(1.0);
        EXPECT_THROW(orient_cloud(cloud, options), Error);
    };
    for (const double bad : {0.0, -1.0, std::nan(""), static_cast<double>(INFINITY)}) {
        OrientOptions options;
        options.known_height = bad;
        refused(options);
        options = {};
        options.known_length = KnownLength{{0, 0, 0}, {0, 0, 1}, bad};
        refused(options);
    }
    OrientOptions options;
    options.known_length = KnownLength{{1, 2, 3}, {1, 2, 3}, 1.0};
    refused(options);
    options.known_length = KnownLength{{1, 2, 3}, {1, 2, NAN}, 1.0};
    refused(options);
    options.known_length = KnownLength{{0, 0, 0}, {0, 0, 1}, 1.0};
    options.known_height = 5.0;
    refused(options);
}

}  // namespace
}  // namespace treerec
