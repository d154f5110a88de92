// What holds for every kind of cloud file.
#include "scan_samples.h"

namespace treerec {
namespace {

using namespace scan_test;

TEST(ScanRead, NamesForeignFiles) {
    EXPECT_NE(error_of("\xFF\xD8\xFF\xE0....", "photo.jpg").find("JPEG"), std::string::npos);
    EXPECT_NE(error_of("glTF....", "a.glb").find("glTF"), std::string::npos);
    EXPECT_NE(error_of("{\"asset\":{}}", "a.gltf").find("JSON"), std::string::npos);
    EXPECT_NE(error_of("ASTM-E57....", "a.e57").find("E57"), std::string::npos);
    EXPECT_NE(error_of("# .PCD v0.7\n", "a.pcd").find("PCD"), std::string::npos);
    EXPECT_NE(error_of(std::string("\x05\0\0\0\0\0\0\0", 8), "points3D.bin").find("COLMAP"),
              std::string::npos);
    EXPECT_NE(error_of("v 1 2 3\n", "a.obj").find("OBJ"), std::string::npos);
    EXPECT_NE(error_of("1 2 3\n", "a.ply").find("no PLY file"), std::string::npos);
    EXPECT_NE(error_of("1 2 3\n", "a.las").find("no LAS file"), std::string::npos);
    EXPECT_NE(error_of(std::string("\x01\x02\0\x07", 4), "a.dat").find("not a point cloud"),
              std::string::npos);
}

TEST(ScanRead, MissingFilesAndFolders) {
    const Folder folder;
    EXPECT_THROW(read_cloud(folder.file("none.ply")), Error);
    EXPECT_THROW(read_cloud(folder.file("")), Error);
    EXPECT_THROW(read_cloud(""), Error);
}

TEST(ScanRead, OriginIsNearAndIndependentOfOrder) {
    const Folder folder;
    PointCloud cloud = random_cloud(5, 1001, {455123.4, 5812345.6, 312.3}, 8.0, true, false);
    write_cloud(folder.file("a.ply"), cloud);
    shuffle(cloud, 2);
    write_cloud(folder.file("b.ply"), cloud);
    const PointCloud a = read_cloud(folder.file("a.ply"));
    const PointCloud b = read_cloud(folder.file("b.ply"));
    EXPECT_EQ(a.frame, b.frame);
    EXPECT_LE(glm::length(a.frame.origin - DVec3(455123, 5812346, 312)), 2.0);
    EXPECT_EQ(a.frame.origin, glm::round(a.frame.origin));
}

TEST(ScanRead, RoundTrips) {
    const Folder folder;
    for (const char* name : {"a.ply", "a.las", "a.xyz", "a.txt", "a.asc"}) {
        for (int round = 0; round < 24; round++) {
            SCOPED_TRACE(std::string(name) + " " + std::to_string(round));
            const bool colors = round & 1;
            const bool normals = round & 2;
            const double size = std::pow(10.0, round % 5 - 1);
            const DVec3 centre = round & 4 ? DVec3(455123.4, -5812345.6, 1312.3) : DVec3(0.0);
            PointCloud cloud = random_cloud(static_cast<uint64_t>(round), 200, centre, size, colors, normals);
            cloud.frame.up = static_cast<UpAxis>(round % 6);
            cloud.frame.metres_per_unit = round % 3 == 0 ? 1.0 : 0.01;
            write_cloud(folder.file(name), cloud);
            const PointCloud back = read_cloud(folder.file(name));
            ASSERT_EQ(back.size(), cloud.size());
            ASSERT_EQ(back.has_colors(), colors);
            ASSERT_EQ(back.has_normals(), normals && std::string(name) != "a.las");
            const double tolerance = 1e-6 * size / cloud.frame.metres_per_unit;
            for (size_t i = 0; i < cloud.size(); i++) {
                expect_point(back, i, scan_point(cloud, i), tolerance);
                if (colors) {
                    EXPECT_EQ(back.colors[i], cloud.colors[i]);
                }
                if (back.has_normals()) {
                    EXPECT_LE(glm::length(DVec3(back.normals[i]) -
                                          cloud.frame.turn_to_scan(DVec3(cloud.normals[i]))),
                              1e-5);
                }
            }
        }
    }
}

TEST(ScanRead, WritingSaysWhatIsWrong) {
    const Folder folder;
    const PointCloud cloud = random_cloud(1, 10, DVec3(0.0), 1.0, false, false);
    EXPECT_THROW(write_cloud(folder.file("a.doc"), cloud), Error);
    EXPECT_THROW(write_cloud(folder.file("a.ply"), {}), Error);
    EXPECT_THROW(write_cloud(folder.file("none/a.ply"), cloud), Error);
    EXPECT_TRUE(std::filesystem::is_empty(folder.file("")));
}

class Cancelling final : public Progress {
  public:
    void update(double fraction, const char*) override {
        EXPECT_GE(fraction, last_);
        last_ = fraction;
    }
    bool cancelled() const override { return last_ > 0.2; }

  private:
    double last_ = 0.0;
};

TEST(ScanRead, CanBeCancelled) {
    const Folder folder;
    const PointCloud cloud = random_cloud(1, 300000, DVec3(0.0), 1.0, false, false);
    for (const char* name : {"a.ply", "a.las", "a.xyz"}) {
        write_cloud(folder.file(name), cloud);
        Cancelling progress;
        EXPECT_THROW(read_cloud(folder.file(name), {}, nullptr, &progress), Cancelled);
    }
}

}  // namespace
}  // namespace treerec
