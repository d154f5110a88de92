// What holds for every kind of cloud file.
#include "geometry/parallel.h"
#include "scan_samples.h"

namespace treerec {
namespace {

using namespace scan_test;

TEST(ScanRead, NamesForeignFiles) {
    struct Case {
        std::string bytes;
        const char* name;
        const char* word;
    };
    const Case cases[] = {
        {"\xFF\xD8\xFF\xE0....", "photo.jpg", "JPEG"},
        {"\x89PNG\r\n", "photo.ply", "PNG"},
        {std::string("\0\0\0\x18"
                     "ftypheic....",
                     16),
         "photo.heic", "HEIC"},
        {"%PDF-1.7", "paper.pdf", "PDF"},
        {"PK\x03\x04....", "scan.zip", "ZIP"},
        {"\x1F\x8B\x08....", "scan.ply.gz", "gzip"},
        {"<!DOCTYPE html>", "scan.ply", "web page"},
        {"glTF....", "a.glb", "glTF"},
        {"{\"asset\":{}}", "a.gltf", "JSON"},
        {"ASTM-E57....", "a.e57", "E57"},
        {"solid oak\n", "a.stl", "STL"},
        {"v 1 2 3\n", "a.obj", "OBJ"},
        {"Kaydara FBX Binary", "a.fbx", "FBX"},
        {"[gd_scene format=3]", "a.tscn", "Godot"},
        {std::string(64, '\7'), "a.splat", ".splat"},
        {"\x1F\x8B\x08....", "a.spz", ".spz"},
        {std::string("\x05\0\0\0\0\0\0\0", 8), "points3D.bin", "COLMAP"},
        {"# Camera list with one line of data per camera:\n", "cameras.txt", "points3D.txt"},
        {"1 2 3\n", "a.ply", "no PLY file"},
        {"1 2 3\n", "a.las", "no LAS file"},
        {"1 2 3\n", "a.pcd", "no PCD file"},
        {std::string("\x01\x02\0\x07", 4), "a.dat", "not a point cloud"},
    };
    for (const Case& c : cases)
        EXPECT_NE(error_of(c.bytes, c.name).find(c.word), std::string::npos)
            << c.name << ": " << error_of(c.bytes, c.name);
}

TEST(ScanRead, SaysThatNamedColumnsAreIgnored) {
    const Folder folder;
    const PointCloud cloud = random_cloud(5, 30, DVec3(0.0), 1.0, false, false);
    ReadCloudOptions options;
    options.columns = {"x", "y", "z"};
    for (const char* name : {"a.ply", "a.las", "a.xyz"}) {
        write_cloud(folder.file(name), cloud);
        ReadCloudReport report;
        EXPECT_EQ(read_cloud(folder.file(name), options, &report).size(), 30U);
        const bool ignored =
            !report.warnings.empty() && report.warnings[0].find("ignored") != std::string::npos;
        EXPECT_EQ(ignored, std::string(name) != "a.xyz") << name;
    }
}

TEST(ScanRead, FilesAndBytesAreReadAlike) {
    const Folder folder;
    const PointCloud cloud = random_cloud(6, 500, {455123.4, 5812345.6, 312.3}, 8.0, true, true);
    for (const char* name : {"a.ply", "a.las", "a.xyz"}) {
        write_cloud(folder.file(name), cloud);
        const PointCloud from_file = read_cloud(folder.file(name));
        const PointCloud from_bytes = read_cloud_bytes(name, bytes_of(folder.file(name)));
        EXPECT_EQ(from_file.frame, from_bytes.frame);
        EXPECT_EQ(from_file.positions, from_bytes.positions);
        EXPECT_EQ(from_file.colors, from_bytes.colors);
        EXPECT_EQ(from_file.normals, from_bytes.normals);
    }
}

// Files of several chunks, with comments and prose between the rows.
TEST(ScanRead, IsTheSameOnAnyNumberOfThreads) {
    const Folder folder;
    const PointCloud cloud = random_cloud(7, 60000, {455123.4, -312.0, 6.0}, 5.0, true, true);
    write_cloud(folder.file("a.txt"), cloud);
    std::string text = bytes_of(folder.file("a.txt"));
    size_t at = 0;
    size_t prose = 0;
    for (size_t line = 0; (at = text.find('\n', at)) != text.npos; line++) {
        at++;
        if (line % 1000 == 500) {
            text.insert(at, line % 2000 == 500 ? "# a comment between\n\n" : "some prose between\n");
            prose += line % 2000 != 500;
        }
    }
    folder.write("a.txt", text);
    write_cloud(folder.file("a.ply"), cloud);
    write_cloud(folder.file("a.las"), cloud);
    for (const char* name : {"a.txt", "a.ply", "a.las"}) {
        std::vector<PointCloud> clouds;
        for (const int threads : {1, 2, 7}) {
            set_thread_count(threads);
            ReadCloudReport report;
            clouds.push_back(read_cloud(folder.file(name), {}, &report));
            if (std::string(name) == "a.txt") {
                ASSERT_EQ(report.warnings.size(), 1U);
                EXPECT_NE(report.warnings[0].find(std::to_string(prose) + " of its"), std::string::npos)
                    << report.warnings[0];
                EXPECT_NE(report.warnings[0].find("line 1501 of the data"), std::string::npos)
                    << report.warnings[0];
            }
        }
        set_thread_count(0);
        EXPECT_EQ(clouds[0].size(), cloud.size());
        for (const PointCloud& other : clouds) {
            EXPECT_EQ(other.frame, clouds[0].frame);
            EXPECT_EQ(other.positions, clouds[0].positions);
            EXPECT_EQ(other.colors, clouds[0].colors);
            EXPECT_EQ(other.normals, clouds[0].normals);
        }
        for (size_t i = 0; i < cloud.size(); i += 977)
            expect_point(clouds[0], i, scan_point(cloud, i), 1e-6);
    }
}

// The short way through parse_number gives what the long one gives, to the last bit.
TEST(ScanRead, NumbersAreTheNearestDoubles) {
    Random random(8);
    std::string text;
    std::vector<DVec3> expected;
    for (int i = 0; i < 20000; i++) {
        DVec3 p(0.0);
        for (int k = 0; k < 3; k++) {
            std::string word = random.below(2) ? "-" : "";
            for (uint32_t n = 1 + random.below(k == 2 ? 3 : 9); n > 0; n--)
                word += static_cast<char>('0' + random.below(10));
            if (random.below(4)) word += '.';
            if (word.back() == '.')
                for (uint32_t n = random.below(14); n > 0; n--)
                    word += static_cast<char>('0' + random.below(10));
            if (random.below(16) == 0) word += "e-3";
            p[k] = std::strtod(word.c_str(), nullptr);
            text += word + (k == 2 ? "\n" : " ");
        }
        expected.push_back(p);
    }
    const PointCloud cloud = read_cloud_bytes("a.xyz", text);
    ASSERT_EQ(cloud.size(), expected.size());
    for (size_t i = 0; i < cloud.size(); i++)
        ASSERT_EQ(cloud.positions[i], Vec3(expected[i] - cloud.frame.origin)) << i;
}

TEST(ScanRead, TheOriginIsTheMedian) {
    Random random(9);
    for (const size_t count : {1U, 2U, 7U, 8191U, 50000U}) {
        for (const int kind : {0, 1, 2}) {
            std::string text;
            std::array<std::vector<double>, 3> values;
            for (size_t i = 0; i < count; i++) {
                for (size_t k = 0; k < 3; k++) {
                    // Spread out, in two far lumps, and sorted with nearly all of them alike.
                    const double value = kind == 0   ? random.below(100000)
                                         : kind == 1 ? 1e6 * random.below(2) + random.below(10)
                                                     : static_cast<double>(i < count / 50 ? i : count);
                    values[k].push_back(value);
                    text += std::to_string(static_cast<int64_t>(value)) + (k == 2 ? "\n" : " ");
                }
            }
            ReadCloudOptions options;
            options.columns = {"x", "y", "z"};
            const PointCloud cloud = read_cloud_bytes("a.xyz", text, options);
            for (size_t k = 0; k < 3; k++) {
                std::sort(values[k].begin(), values[k].end());
                EXPECT_EQ(cloud.frame.origin[static_cast<int>(k)], values[k][count / 2])
                    << count << " " << kind;
            }
        }
    }
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

TEST(ScanRead, PlyKeepsTheSpacing) {
    const Folder folder;
    PointCloud cloud = random_cloud(1, 10, DVec3(0.0), 1.0, true, false);
    for (const double spacing : {0.0, 0.1, 1.0 / 3.0, 1e-9}) {
        cloud.spacing = spacing;
        write_cloud(folder.file("a.ply"), cloud);
        EXPECT_EQ(read_cloud(folder.file("a.ply")).spacing, spacing);
    }
    for (const char* told : {"", "nan", "inf", "-1", "0", "1e999", "0.1 m", "0.1x", "wide"}) {
        const std::string header = "ply\nformat ascii 1.0\ncomment spacing " + std::string(told) +
                                   "\nelement vertex 1\nproperty float x\nproperty float y\nproperty "
                                   "float z\nend_header\n0 0 0\n";
        EXPECT_EQ(read_cloud_bytes("a.ply", header).spacing, 0.0) << told;
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
