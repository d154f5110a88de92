// PCD, COLMAP's points, Gaussian splats, LAZ and the flags of LAS points.
#include <bit>
#include <cmath>
#include <functional>

#include "geometry/parallel.h"
#include "scan_samples.h"

namespace treerec {
namespace {

using namespace scan_test;

template <typename T>
void append(std::string& bytes, T value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

struct SamplePoint {
    DVec3 position;
    Color8 color;
    DVec3 normal;
};

std::vector<SamplePoint> sample_points(uint64_t seed, size_t count) {
    Random random(seed);
    std::vector<SamplePoint> points;
    for (size_t i = 0; i < count; i++) {
        SamplePoint p;
        // Eighths, so that a float holds them exactly.
        for (int k = 0; k < 3; k++)
            p.position[k] = random.below(8000) / 8.0 - 500.0;
        for (uint8_t& channel : p.color)
            channel = static_cast<uint8_t>(random.below(256));
        p.normal = random.direction();
        points.push_back(p);
    }
    return points;
}

void expect_same(const PointCloud& cloud, const std::vector<SamplePoint>& points, bool normals) {
    ASSERT_EQ(cloud.size(), points.size());
    ASSERT_TRUE(cloud.has_colors());
    ASSERT_EQ(cloud.has_normals(), normals);
    for (size_t i = 0; i < points.size(); i++) {
        expect_point(cloud, i, points[i].position);
        EXPECT_EQ(cloud.colors[i], points[i].color);
        if (normals) {
            EXPECT_LE(glm::length(DVec3(cloud.normals[i]) - points[i].normal), 1e-5);
        }
    }
}

// --- PCD ---------------------------------------------------------------------------------------------------

uint32_t packed(const Color8& color) {
    return static_cast<uint32_t>(color[0] << 16 | color[1] << 8 | color[2]);
}

// LZF with copies of what was there before, found by plain search; not a good compressor, but a true one.
std::string to_lzf(const std::string& bytes) {
    std::string out;
    std::string literals;
    const auto flush = [&] {
        for (size_t at = 0; at < literals.size(); at += 32) {
            const std::string part = literals.substr(at, 32);
            out += static_cast<char>(part.size() - 1);
            out += part;
        }
        literals.clear();
    };
    for (size_t at = 0; at < bytes.size();) {
        size_t best = 0;
        size_t best_back = 0;
        for (size_t back = 1; back <= std::min<size_t>(at, 300); back++) {
            size_t length = 0;
            while (length < 264 && at + length < bytes.size() &&
                   bytes[at + length] == bytes[at - back + length])
                length++;
            if (length > best) {
                best = length;
                best_back = back;
            }
        }
        if (best < 3) {
            literals += bytes[at++];
            continue;
        }
        flush();
        const size_t code = best - 2;
        const size_t offset = best_back - 1;
        out += static_cast<char>(std::min<size_t>(code, 7) << 5 | offset >> 8);
        if (code >= 7) out += static_cast<char>(code - 7);
        out += static_cast<char>(offset & 255);
        at += best;
    }
    flush();
    return out;
}

struct PcdFile {
    std::string data = "binary";
    bool color_as_float = true;
    bool normals = true;
    bool doubles = false;

    std::string bytes(const std::vector<SamplePoint>& points) const {
        const std::string size = doubles ? "8" : "4";
        std::string file = "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z _ rgb";
        file += normals ? " normal_x normal_y normal_z" : "";
        file += "\nSIZE " + size + " " + size + " " + size + " 1 4" + (normals ? " 4 4 4" : "");
        file += std::string("\nTYPE F F F U ") + (color_as_float ? "F" : "U") + (normals ? " F F F" : "");
        file += std::string("\nCOUNT 1 1 1 3 1") + (normals ? " 1 1 1" : "");
        file += "\nWIDTH " + std::to_string(points.size()) + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " +
                std::to_string(points.size()) + "\nDATA " + data + "\n";
        if (data == "ascii") return file + text_of(points);
        // One string per field; a point's own bytes are interleaved unless compressed.
        std::vector<std::string> columns;
        for (const SamplePoint& p : points) {
            std::vector<std::string> row(normals ? 8 : 5);
            for (size_t k = 0; k < 3; k++) {
                if (doubles)
                    append(row[k], p.position[static_cast<int>(k)]);
                else
                    append(row[k], static_cast<float>(p.position[static_cast<int>(k)]));
                if (normals) append(row[5 + k], static_cast<float>(p.normal[static_cast<int>(k)]));
            }
            row[3] = "abc";
            append(row[4], packed(p.color));
            if (data == "binary") columns.push_back("");
            columns.resize(std::max(columns.size(), row.size()));
            for (size_t c = 0; c < row.size(); c++)
                (data == "binary" ? columns[0] : columns[c]) += row[c];
        }
        std::string body;
        for (const std::string& column : columns)
            body += column;
        if (data == "binary") return file + body;
        const std::string small = to_lzf(body);
        append(file, static_cast<uint32_t>(small.size()));
        append(file, static_cast<uint32_t>(body.size()));
        return file + small;
    }

    std::string text_of(const std::vector<SamplePoint>& points) const {
        std::ostringstream text;
        text.precision(9);
        for (const SamplePoint& p : points) {
            text << p.position.x << ' ' << p.position.y << ' ' << p.position.z << " 1 2 3 ";
            if (color_as_float)
                text << std::scientific << std::bit_cast<float>(packed(p.color)) << std::defaultfloat;
            else
                text << packed(p.color);
            if (normals) text << ' ' << p.normal.x << ' ' << p.normal.y << ' ' << p.normal.z;
            text << "\n";
        }
        return text.str();
    }
};

TEST(ScanPcd, ReadsEveryFlavour) {
    const std::vector<SamplePoint> points = sample_points(31, 300);
    for (const char* data : {"ascii", "binary", "binary_compressed"}) {
        for (int round = 0; round < 8; round++) {
            SCOPED_TRACE(std::string(data) + " " + std::to_string(round));
            const PcdFile pcd{data, (round & 1) != 0, (round & 2) != 0, (round & 4) != 0};
            ReadCloudReport report;
            expect_same(read_cloud_bytes("a.pcd", pcd.bytes(points), {}, &report), points, pcd.normals);
            EXPECT_EQ(report.format, std::string("PCD ") + data);
            EXPECT_TRUE(report.warnings.empty());
        }
    }
}

TEST(ScanPcd, WholeNumbersAsColoursInTextEvenWhereTheTypeIsFloat) {
    const PointCloud cloud = read_cloud_bytes(
        "a.pcd",
        "VERSION .7\nFIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F F\nWIDTH 2\nHEIGHT 1\nDATA ascii\n"
        "1 2 3 4210752\nnan 5 6 255\n4 5 6 255\n");
    ASSERT_EQ(cloud.size(), 1U);
    EXPECT_EQ(cloud.colors[0], (Color8{64, 64, 64}));
}

TEST(ScanPcd, MissingPointsAreLeftOut) {
    std::vector<SamplePoint> points = sample_points(32, 10);
    points[3].position = DVec3(std::nan(""));
    ReadCloudReport report;
    EXPECT_EQ(read_cloud_bytes("a.pcd", PcdFile{}.bytes(points), {}, &report).size(), 9U);
    ASSERT_EQ(report.warnings.size(), 1U);
    EXPECT_NE(report.warnings[0].find("1 of 10 points"), std::string::npos);
}

TEST(ScanPcd, SaysWhatIsWrong) {
    const std::vector<SamplePoint> points = sample_points(33, 9);
    for (const char* data : {"ascii", "binary", "binary_compressed"}) {
        const std::string good = PcdFile{data}.bytes(points);
        EXPECT_NE(error_of(good.substr(0, good.size() - 40), "a.pcd").find("cut off"), std::string::npos)
            << data;
        EXPECT_NE(error_of(good.substr(0, 60), "a.pcd").find("'DATA'"), std::string::npos) << data;
    }
    const std::string head = "# .PCD v0.7\nVERSION 0.7\nSIZE 4 4 4\nTYPE F F F\nWIDTH 1\nHEIGHT 1\n";
    EXPECT_NE(error_of(head + "FIELDS x y w\nDATA ascii\n1 2 3\n", "a.pcd").find("lack x, y or z"),
              std::string::npos);
    EXPECT_NE(error_of(head + "FIELDS x y\nDATA ascii\n1 2 3\n", "a.pcd").find("do not agree"),
              std::string::npos);
    EXPECT_NE(error_of(head + "FIELDS x y z\nDATA zip\n1 2 3\n", "a.pcd").find("'zip'"), std::string::npos);
    EXPECT_NE(error_of(head + "FIELDS x y z\nDATA ascii\n1 oak 3\n", "a.pcd").find("'oak'"),
              std::string::npos);
    EXPECT_NE(error_of(head + "POINTS -3\nFIELDS x y z\nDATA ascii\n1 2 3\n", "a.pcd").find("'-3'"),
              std::string::npos);
}

// --- COLMAP ------------------------------------------------------------------------------------------------

std::string to_colmap(const std::vector<SamplePoint>& points) {
    std::string file;
    append(file, uint64_t{points.size()});
    for (size_t i = 0; i < points.size(); i++) {
        append(file, uint64_t{7 * i + 3});
        for (int k = 0; k < 3; k++)
            append(file, points[i].position[k]);
        for (const uint8_t channel : points[i].color)
            append(file, channel);
        append(file, 0.75);
        append(file, uint64_t{i % 5});
        for (size_t k = 0; k < i % 5; k++)
            append(file, uint64_t{k << 32 | 9});
    }
    return file;
}

std::string to_colmap_text(const PointCloud& cloud) {
    std::ostringstream text;
    text.precision(17);
    text << "# 3D point list with one line of data per point:\n"
            "#   POINT3D_ID, X, Y, Z, R, G, B, ERROR, TRACK[] as (IMAGE_ID, POINT2D_IDX)\n"
            "# Number of points: "
         << cloud.size() << ", mean track length: 3.5\n";
    for (size_t i = 0; i < cloud.size(); i++) {
        const DVec3 p = scan_point(cloud, i);
        text << 3 * i + 17 << ' ' << p.x << ' ' << p.y << ' ' << p.z;
        for (const uint8_t channel : cloud.colors[i])
            text << ' ' << static_cast<int>(channel);
        text << " 0.5";
        for (size_t k = 0; k < 2 + i % 3; k++)
            text << ' ' << k + 1 << ' ' << 10 * k;
        text << '\n';
    }
    return text.str();
}

TEST(ScanColmap, ReadsPoints) {
    const std::vector<SamplePoint> points = sample_points(34, 200);
    ReadCloudReport report;
    const PointCloud cloud = read_cloud_bytes("points3D.bin", to_colmap(points), {}, &report);
    expect_same(cloud, points, false);
    EXPECT_EQ(report.format, "COLMAP points3D.bin");
    expect_same(read_cloud_bytes("points3D.txt", to_colmap_text(cloud)), points, false);
}

TEST(ScanColmap, SaysWhatIsCutOff) {
    const std::string good = to_colmap(sample_points(35, 20));
    EXPECT_NE(
        error_of(good.substr(0, good.size() - 1), "points3D.bin").find("promises 20 points, but holds 19"),
        std::string::npos);
    EXPECT_NE(error_of(good.substr(0, 90), "points3D.bin").find("promises 20 points"), std::string::npos);
}

// The models bring the same points as PLY, in floats.
TEST(ScanColmap, ReadsRealModels) {
    const std::string clouds = scans_folder();
    if (clouds.empty()) GTEST_SKIP() << "TREEREC_SCANS does not name the folder of the real scans.";
    for (const char* model : {"fern_20", "monstree_23", "south_building_48", "treehill_71"}) {
        SCOPED_TRACE(model);
        const std::string folder = clouds + "../colmap_sparse/" + model;
        const PointCloud bin = read_cloud(folder + "/points3D.bin");
        const PointCloud ply = read_cloud(folder + "/points.ply");
        ASSERT_EQ(bin.size(), ply.size());
        const PointCloud text = read_cloud_bytes("points3D.txt", to_colmap_text(bin));
        ASSERT_EQ(text.size(), bin.size());
        // The PLY has another order.
        const auto sums = [](const PointCloud& cloud) {
            DVec3 sum(0.0);
            DVec3 color(0.0);
            for (size_t i = 0; i < cloud.size(); i++) {
                sum += scan_point(cloud, i) / static_cast<double>(cloud.size());
                color += DVec3(cloud.colors[i][0], cloud.colors[i][1], cloud.colors[i][2]);
            }
            return std::pair(sum, color);
        };
        EXPECT_LE(glm::length(sums(bin).first - sums(ply).first), 1e-3);
        EXPECT_EQ(sums(bin).second, sums(ply).second);
        EXPECT_EQ(sums(bin).second, sums(text).second);
        for (size_t i = 0; i < text.size(); i += 101)
            expect_point(text, i, scan_point(bin, i), 1e-4);
    }
}

// --- Gaussian splats ---------------------------------------------------------------------------------------

// As the authors' own program writes it, with harmonics of higher degree and empty normals.
std::string to_splats(const std::vector<SamplePoint>& points, const std::function<double(size_t)>& opacity,
                      bool ascii) {
    std::string file = std::string("ply\nformat ") + (ascii ? "ascii" : "binary_little_endian") +
                       " 1.0\nelement vertex " + std::to_string(points.size()) + "\n";
    for (const char* name : {"x", "y", "z", "nx", "ny", "nz", "f_dc_0", "f_dc_1", "f_dc_2", "f_rest_0",
                             "opacity", "scale_0", "scale_1", "scale_2", "rot_0", "rot_1", "rot_2", "rot_3"})
        file += std::string("property float ") + name + "\n";
    file += "end_header\n";
    for (size_t i = 0; i < points.size(); i++) {
        std::vector<double> row = {points[i].position.x, points[i].position.y, points[i].position.z, 0, 0, 0};
        for (const uint8_t channel : points[i].color)
            row.push_back((channel / 255.0 - 0.5) / 0.28209479177387814);
        const double share = opacity(i);
        for (const double value :
             {0.3, std::log(share / (1.0 - share)), -4.0, -5.0, -4.5, 1.0, 0.0, 0.0, 0.0})
            row.push_back(value);
        for (const double value : row) {
            if (ascii)
                file += std::to_string(value) + " ";
            else
                append(file, static_cast<float>(value));
        }
        if (ascii) file += "\n";
    }
    return file;
}

TEST(ScanSplats, BecomeCentresWithTheirColours) {
    const std::vector<SamplePoint> points = sample_points(36, 300);
    for (const bool ascii : {false, true}) {
        ReadCloudReport report;
        const std::string file = to_splats(
            points, [](size_t) { return 0.6; }, ascii);
        expect_same(read_cloud_bytes("a.ply", file, {}, &report), points, false);
        EXPECT_NE(report.format.find("Gaussian splats"), std::string::npos);
        EXPECT_TRUE(report.warnings.empty());
    }
}

TEST(ScanSplats, LeaveOutWhatIsNearlyTransparent) {
    const std::vector<SamplePoint> points = sample_points(37, 300);
    ReadCloudReport report;
    const std::string file = to_splats(
        points, [](size_t i) { return i % 3 == 0   ? 0.11
                                      : i % 3 == 1 ? 0.09
                                                   : 0.99; }, false);
    const PointCloud cloud = read_cloud_bytes("a.ply", file, {}, &report);
    ASSERT_EQ(cloud.size(), 200U);
    expect_point(cloud, 0, points[0].position);
    expect_point(cloud, 1, points[2].position);
    ASSERT_EQ(report.warnings.size(), 1U);
    EXPECT_NE(report.warnings[0].find("100 of 300 splats"), std::string::npos);
    EXPECT_NE(error_of(to_splats(
                           points, [](size_t) { return 0.01; }, false),
                       "a.ply")
                  .find("transparent"),
              std::string::npos);
}

TEST(ScanSplats, CompressedOnesAreNamed) {
    EXPECT_NE(
        error_of("ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty uint packed_position\n"
                 "property uint packed_rotation\nend_header\n12345678",
                 "a.ply")
            .find("compressed Gaussian splat"),
        std::string::npos);
}

TEST(ScanPly, MeshesAreReadWithAWarning) {
    ReadCloudReport report;
    const PointCloud cloud = read_cloud_bytes(
        "a.ply",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
        {}, &report);
    EXPECT_EQ(cloud.size(), 3U);
    ASSERT_EQ(report.warnings.size(), 1U);
    EXPECT_NE(report.warnings[0].find("mesh"), std::string::npos);
}

// --- LAS flags and LAZ -------------------------------------------------------------------------------------

TEST(ScanLas, WithheldPointsAreLeftOut) {
    const Folder folder;
    const PointCloud cloud = random_cloud(38, 40, DVec3(0.0), 5.0, false, false);
    write_cloud(folder.file("a.las"), cloud);
    std::string bytes = bytes_of(folder.file("a.las"));
    for (size_t i = 0; i < 40; i += 4)
        bytes[227 + 20 * i + 15] = static_cast<char>(0x80 | 5);
    ReadCloudReport report;
    const PointCloud kept = read_cloud_bytes("a.las", bytes, {}, &report);
    ASSERT_EQ(kept.size(), 30U);
    expect_point(kept, 0, scan_point(cloud, 1), 1e-6);
    ASSERT_EQ(report.warnings.size(), 1U);
    EXPECT_NE(report.warnings[0].find("10 of 40 points are flagged as withheld"), std::string::npos);
    for (size_t i = 0; i < 40; i++)
        bytes[227 + 20 * i + 15] = static_cast<char>(0x80);
    EXPECT_NE(error_of(bytes, "a.las").find("flagged as withheld"), std::string::npos);
}

// A LAZ file says in its header how many points there are and what box they fill; so does LASzip's own
// reader.
TEST(ScanLaz, ReadsRealScans) {
    const std::string clouds = scans_folder();
    if (clouds.empty()) GTEST_SKIP() << "TREEREC_SCANS does not name the folder of the real scans.";
    struct Case {
        const char* name;
        size_t points;
        bool colors;
        const char* format;
        DVec3 sum;  // of all coordinates, by another program (laspy with lazrs)
    };
    const Case cases[] = {
        {"jeffgillan_tree_understory.laz",
         473974,
         false,
         "LAZ 1.2, point format 2",
         {-8921717.4300, 1319098.3200, 5013324.0927}},
        {"lidr_MixedConifer_ALS.laz",
         37657,
         false,
         "LAZ 1.2, point format 1, in metres",
         {18124509887.0000, 143584872818.7600, 452435.0100}},
        {"spanner_MLS_plot.laz",
         301477,
         false,
         "LAZ 1.4, point format 7",
         {141887437977.3740, 1148698530720.4146, 691195553.3553}},
        {"treels_pine.laz", 73851, false, "LAZ 1.2, point format 0", {2292.9657, -3048.1699, 726972.4826}},
        {"treels_pine_plot_with_ground.laz",
         114024,
         false,
         "LAZ 1.2, point format 0",
         {619077.6367, 559328.9356, 6280492.3027}},
    };
    for (const Case& c : cases) {
        SCOPED_TRACE(c.name);
        ReadCloudReport report;
        PointCloud cloud;
        try {
            cloud = read_cloud(clouds + c.name, {}, &report);
        } catch (const Error& error) {
            if (std::string(error.what()).find("LASzip") == std::string::npos) throw;
            GTEST_SKIP() << error.what();
        }
        EXPECT_EQ(cloud.size(), c.points);
        EXPECT_EQ(cloud.has_colors(), c.colors);
        EXPECT_EQ(report.format, c.format);
        DVec3 sum(0.0);
        for (size_t i = 0; i < cloud.size(); i++)
            sum += scan_point(cloud, i) - cloud.frame.origin;
        sum += static_cast<double>(cloud.size()) * cloud.frame.origin;
        for (int k = 0; k < 3; k++)
            EXPECT_NEAR(sum[k], c.sum[k], 1e-5 * static_cast<double>(c.points));
    }
}

// One that is cut off is damaged, wherever it is cut.
TEST(ScanLaz, SaysWhatIsCutOff) {
    const std::string clouds = scans_folder();
    if (clouds.empty()) GTEST_SKIP() << "TREEREC_SCANS does not name the folder of the real scans.";
    const std::string whole = bytes_of(clouds + "treels_pine.laz");
    for (const size_t size :
         {size_t{100}, size_t{300}, size_t{5000}, whole.size() / 2, whole.size() - 2000}) {
        const std::string sentence = error_of(whole.substr(0, size), "a.laz");
        EXPECT_NE(sentence, "") << size;
        EXPECT_TRUE(size < 227 || sentence.find("LASzip") != sentence.npos ||
                    sentence.find("cut off") != sentence.npos)
            << sentence;
    }
}

}  // namespace
}  // namespace treerec
