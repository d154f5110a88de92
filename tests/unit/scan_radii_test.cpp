// How thick wood is, as a cloud's maker knows it (PointCloud::radii), from file to file and on the way to a
// skeleton.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "scan/cleaning/thin_cloud.h"
#include "scan/usual_size.h"
#include "scan_samples.h"

namespace treerec {
namespace {

using namespace scan_test;

// Of each point a radius that its place tells, so that one that goes to another point is found out: none in
// a third of the cloud.
float radius_at(const DVec3& scan) {
    const double told = 0.02 + 0.01 * std::sin(3.0 * scan.x) + 0.005 * std::cos(5.0 * scan.z);
    return scan.y < -0.3 ? 0.0F : static_cast<float>(told);
}

// Radii in the scan's unit. scale: metres of it.
PointCloud cloud_with_radii(uint64_t seed, size_t count, const DVec3& centre, double scale) {
    PointCloud cloud = random_cloud(seed, count, centre, 1.0, true, true);
    cloud.frame.metres_per_unit = scale;
    for (const Vec3& p : cloud.positions)
        cloud.radii.push_back(static_cast<float>(radius_at(DVec3(p)) * scale));
    for (Vec3& p : cloud.positions)
        p = Vec3(DVec3(p) * scale);
    return cloud;
}

// scale: of the cloud's unit in that which radius_at() was asked in.
void expect_radii(const PointCloud& cloud, double scale, double slack = 1e-5) {
    ASSERT_EQ(cloud.radii.size(), cloud.size());
    size_t known = 0;
    for (size_t i = 0; i < cloud.size(); i++) {
        const DVec3 place = DVec3(cloud.positions[i]) / scale;
        if (std::abs(place.y + 0.3) < 1e-3) continue;
        const double expected = radius_at(place) * scale;
        ASSERT_NEAR(cloud.radii[i], expected, slack * scale) << i;
        known += expected > 0.0;
    }
    EXPECT_GT(known, cloud.size() / 2);
    EXPECT_LT(known, cloud.size());
}

TEST(WoodRadii, PlyKeepsThemInTheScansUnit) {
    const Folder folder;
    for (const double scale : {1.0, 1e-3, 1e3, 0.3048})
        for (const DVec3& centre : {DVec3(0.0), DVec3(455123.0, -5812345.0, 312.0)}) {
            SCOPED_TRACE(scale);
            PointCloud cloud = cloud_with_radii(1, 300, DVec3(0.0), scale);
            cloud.frame.origin = centre;
            write_cloud(folder.file("a.ply"), cloud);
            PointCloud back = read_cloud(folder.file("a.ply"));
            for (Vec3& p : back.positions)
                p += Vec3(back.frame.origin - centre);
            // What was read has the file's unit.
            expect_radii(back, 1.0, 1e-4);
        }
    // A turn of the axes does not change them, and a cloud without them has none.
    PointCloud cloud = cloud_with_radii(2, 50, DVec3(0.0), 1.0);
    const std::vector<float> radii = cloud.radii;
    cloud.frame.up = UpAxis::kNegY;
    write_cloud(folder.file("a.ply"), cloud);
    EXPECT_EQ(read_cloud(folder.file("a.ply")).radii, radii);
    cloud.radii.clear();
    write_cloud(folder.file("a.ply"), cloud);
    EXPECT_TRUE(read_cloud(folder.file("a.ply")).radii.empty());
    EXPECT_EQ(bytes_of(folder.file("a.ply")).find("wood_radius"), std::string::npos);
}

std::string ply_of(const std::vector<std::string>& radii) {
    std::string text = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(radii.size()) +
                       "\nproperty float x\nproperty float y\nproperty float z\n"
                       "property float wood_radius\nend_header\n";
    for (size_t i = 0; i < radii.size(); i++)
        text += std::to_string(i) + " " + std::to_string(i * i) + " 1 " + radii[i] + "\n";
    return text;
}

TEST(WoodRadii, ThatAreNoneAreNotKnown) {
    const auto radii_of = [](const std::vector<std::string>& told) {
        return read_cloud_bytes("a.ply", ply_of(told)).radii;
    };
    EXPECT_EQ(radii_of({"0.5", "nan", "-1", "inf", "-inf", "0", "0.25"}),
              (std::vector<float>{0.5F, 0.0F, 0.0F, 0.0F, 0.0F, 0.0F, 0.25F}));
    // Where all are none, there is no such column.
    EXPECT_TRUE(radii_of({"0", "0", "0"}).empty());
    EXPECT_TRUE(radii_of({"nan", "-2", "inf"}).empty());
    const PointCloud text = read_text_of("//X Y Z wood_radius\n1 2 3 0.5\n2 3 5 0\n4 4 4 0.25\n");
    EXPECT_EQ(text.radii, (std::vector<float>{0.5F, 0.0F, 0.25F}));
}

TEST(WoodRadii, GoWithTheirPoints) {
    PointCloud cloud = cloud_with_radii(3, 5000, DVec3(0.0), 1.0);
    std::vector<uint8_t> keep(cloud.size());
    for (size_t i = 0; i < keep.size(); i++)
        keep[i] = i % 3 != 1;
    cloud.keep_only(keep);
    expect_radii(cloud, 1.0);
    thin_cloud(cloud, 1500);
    EXPECT_LE(cloud.size(), 1500U);
    expect_radii(cloud, 1.0);
}

TEST(WoodRadii, AreScaledWithTheirPoints) {
    expect_radii(enlarged(cloud_with_radii(4, 500, DVec3(0.0), 1.0), 7.5), 7.5);
    for (const double scale : {1.0, 1e-3, 1e3, 0.3048}) {
        SCOPED_TRACE(scale);
        PointCloud cloud;
        for (const Vec3& p : tree_points(1)) {
            cloud.positions.emplace_back(DVec3(p.x, -p.z, p.y) / scale);
            cloud.radii.push_back(static_cast<float>(0.02 / scale));
        }
        OrientOptions options;
        options.up = UpAxis::kZ;
        options.metres_per_unit = scale;
        OrientReport report = orient_cloud(cloud, options);
        ASSERT_EQ(cloud.radii.size(), cloud.size());
        for (const float radius : cloud.radii)
            ASSERT_NEAR(radius, 0.02, 1e-6);
        // By the height of the tree that is left after cleaning.
        const double before = report.metres_per_unit;
        options.known_height = 25.0;
        settle_height(cloud, options, report);
        const double factor = report.metres_per_unit / before;
        EXPECT_GT(factor, 2.0);
        for (const float radius : cloud.radii)
            ASSERT_NEAR(radius, 0.02 * factor, 1e-5);
    }
}

}  // namespace
}  // namespace treerec
