#include <bit>

#include "scan_samples.h"

namespace treerec {
namespace {

using namespace scan_test;

// --- PLY ---------------------------------------------------------------------------------------------------

struct PlyProperty {
    std::string type;
    std::string name;  // "" for a list
};

template <typename T>
void append(std::string& bytes, double value, bool big) {
    const T typed = static_cast<T>(value);
    char raw[sizeof(T)];
    std::memcpy(raw, &typed, sizeof(T));
    if (big == (std::endian::native == std::endian::little)) std::reverse(raw, raw + sizeof(T));
    bytes.append(raw, sizeof(T));
}

void append_typed(std::string& bytes, const std::string& type, double value, const std::string& format) {
    if (format == "ascii") {
        std::ostringstream text;
        text.precision(17);
        text << value;
        bytes += text.str() + " ";
        return;
    }
    const bool big = format == "binary_big_endian";
    if (type == "char" || type == "int8") append<int8_t>(bytes, value, big);
    if (type == "uchar" || type == "uint8") append<uint8_t>(bytes, value, big);
    if (type == "short" || type == "int16") append<int16_t>(bytes, value, big);
    if (type == "ushort" || type == "uint16") append<uint16_t>(bytes, value, big);
    if (type == "int" || type == "int32") append<int32_t>(bytes, value, big);
    if (type == "uint" || type == "uint32") append<uint32_t>(bytes, value, big);
    if (type == "float" || type == "float32") append<float>(bytes, value, big);
    if (type == "double" || type == "float64") append<double>(bytes, value, big);
}

constexpr const char* kFormats[] = {"ascii", "binary_little_endian", "binary_big_endian"};

// Random headers: types, order, lists between, elements around, blanks, line ends.
TEST(ScanPly, ReadsEveryFlavour) {
    const char* types[] = {"char", "int8",  "uchar", "uint8",  "short", "int16",   "ushort", "uint16",
                           "int",  "int32", "uint",  "uint32", "float", "float32", "double", "float64"};
    Random random(7);
    for (int round = 0; round < 300; round++) {
        const std::string format = kFormats[round % 3];
        const std::string line_end = random.below(3) == 0 ? "\r\n" : random.below(3) == 0 ? "  \n" : "\n";
        std::vector<PlyProperty> properties;
        for (const char* name : {"x", "y", "z"})
            properties.push_back({types[random.below(16)], name});
        const bool colors = random.below(2) == 0;
        const bool normals = random.below(2) == 0;
        const std::string color_type = random.below(2) == 0   ? "uchar"
                                       : random.below(2) == 0 ? "float"
                                                              : "ushort";
        if (colors)
            for (const char* name : {"red", "green", "blue"})
                properties.push_back({color_type, random.below(2) ? std::string("diffuse_") + name : name});
        if (normals)
            for (const char* name : {"nx", "ny", "nz"})
                properties.push_back({"float", name});
        properties.push_back({"uchar", "alpha"});
        properties.push_back({types[random.below(16)], "scalar_Intensity"});
        if (random.below(2)) properties.push_back({types[random.below(16)], ""});
        for (size_t i = properties.size(); i > 1; i--)
            std::swap(properties[i - 1], properties[random.below(static_cast<uint32_t>(i))]);

        const size_t count = 1 + random.below(40);
        std::string file = "ply" + line_end + "format " + format + " 1.0" + line_end + "comment made here" +
                           line_end + "obj_info nothing" + line_end + "element camera 2" + line_end +
                           "property float f" + line_end + "property list uchar short view" + line_end +
                           "element vertex " + std::to_string(count) + line_end;
        for (const PlyProperty& p : properties)
            file += p.name.empty() ? "property list uchar " + p.type + " things" + line_end
                                   : "property " + p.type + " " + p.name + line_end;
        file += "element face 1" + line_end + "property list uchar int vertex_indices" + line_end +
                "end_header" + line_end;
        for (int camera = 0; camera < 2; camera++) {
            append_typed(file, "float", 1.5, format);
            append_typed(file, "uchar", 2, format);
            append_typed(file, "short", 3, format);
            append_typed(file, "short", 4, format);
            if (format == "ascii") file += line_end;
        }
        std::vector<DVec3> positions(count);
        std::vector<Color8> expected_colors(count);
        std::vector<DVec3> expected_normals(count);
        for (size_t i = 0; i < count; i++) {
            for (int k = 0; k < 3; k++)
                positions[i][k] = random.below(100);
            expected_normals[i] = random.direction();
            for (const PlyProperty& p : properties) {
                double value = random.below(100);
                const std::string name = p.name.starts_with("diffuse_") ? p.name.substr(8) : p.name;
                for (int k = 0; k < 3; k++) {
                    if (name == std::string(1, static_cast<char>('x' + k))) value = positions[i][k];
                    if (name == std::string("n") + static_cast<char>('x' + k)) value = expected_normals[i][k];
                    if (name == (k == 0 ? "red" : k == 1 ? "green" : "blue")) {
                        const uint8_t channel = static_cast<uint8_t>(random.below(256));
                        expected_colors[i][static_cast<size_t>(k)] = channel;
                        value = color_type == "uchar"   ? channel
                                : color_type == "float" ? channel / 255.0
                                                        : channel * 257;
                    }
                }
                if (p.name.empty()) {
                    append_typed(file, "uchar", 2, format);
                    append_typed(file, p.type, 5, format);
                    value = 6;
                }
                append_typed(file, p.type, value, format);
            }
            if (format == "ascii") file += line_end;
        }
        append_typed(file, "uchar", 1, format);
        append_typed(file, "int", 0, format);

        const PointCloud cloud = read_text_of(file, "cloud.ply");
        ASSERT_EQ(cloud.size(), count) << file;
        // A sole black point counts as colours that nobody filled in.
        const bool any_color = std::any_of(expected_colors.begin(), expected_colors.end(),
                                           [](const Color8& c) { return c[0] + c[1] + c[2] > 0; });
        ASSERT_EQ(cloud.has_colors(), colors && any_color);
        ASSERT_EQ(cloud.has_normals(), normals);
        for (size_t i = 0; i < count; i++) {
            expect_point(cloud, i, positions[i]);
            if (cloud.has_colors()) {
                EXPECT_EQ(cloud.colors[i], expected_colors[i]);
            }
            if (normals) {
                EXPECT_LE(glm::length(DVec3(cloud.normals[i]) - expected_normals[i]), 1e-5);
            }
        }
    }
}

TEST(ScanPly, OldMacintoshLineEnds) {
    const PointCloud cloud = read_text_of(
        "ply\rformat ascii 1.0\relement vertex 2\rproperty float x\rproperty float y\rproperty float z\r"
        "end_header\r1 2 3\r4 5 6\r",
        "mac.ply");
    ASSERT_EQ(cloud.size(), 2U);
    expect_point(cloud, 1, {4, 5, 6});
}

TEST(ScanPly, SaysWhatIsWrong) {
    const std::string head = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n";
    EXPECT_NE(error_of(head + "end_header\n1 2\n1 2\n1 2\n", "a.ply").find("lack x, y or z"),
              std::string::npos);
    const std::string good = head + "property float z\nend_header\n";
    EXPECT_NE(error_of(good + "1 2 3\n4 5 6\n", "a.ply").find("promises 3"), std::string::npos);
    EXPECT_NE(error_of(good + "1 2 3\n4 5 6\n7 8", "a.ply").find("holds 2"), std::string::npos);
    EXPECT_NE(error_of(good + "1 2 3\n4 5\n7 8 9\n", "a.ply").find("row 2"), std::string::npos);
    EXPECT_NE(error_of(good + "1 2 3\n4 5 oak\n7 8 9\n", "a.ply").find("row 2"), std::string::npos);
    EXPECT_NE(error_of("ply\nformat ascii 1.0\n", "a.ply").find("end_header"), std::string::npos);
    EXPECT_NE(error_of("ply\nend_header\n", "a.ply").find("format"), std::string::npos);
    EXPECT_NE(error_of("ply\nformat ascii 1.0\nend_header\n", "a.ply").find("without vertices"),
              std::string::npos);
    EXPECT_NE(error_of("ply\nformat ascii 1.0\nelement vertex 99999999999999999999\nend_header\n", "a.ply")
                  .find("impossible count"),
              std::string::npos);
    // What the file says is not obeyed by the terminal.
    EXPECT_NE(error_of("ply\nformat \x1B[31mred 1.0\nend_header\n", "a.ply").find("'?[31mred'"),
              std::string::npos);
    const std::string huge =
        "ply\nformat binary_little_endian 1.0\nelement vertex 999999999999\nproperty float x\nproperty float "
        "y\n"
        "property float z\nend_header\n";
    EXPECT_NE(error_of(huge + std::string(24, 'a'), "a.ply").find("holds 2"), std::string::npos);
}

// --- Text --------------------------------------------------------------------------------------------------

struct TextCase {
    const char* what;
    const char* text;
    const char* name;
    size_t points;
    DVec3 second;  // the second point
    bool colors;
    Color8 second_color;
    bool normals;
};

TEST(ScanText, UnderstandsItsQuirks) {
    const TextCase cases[] = {
        {"blanks", "1 2 3\n4 5 6\n7 8 9\n", "a.xyz", 3, {4, 5, 6}, false, {}, false},
        {"tabs and a header", "X\tY\tZ\n1\t2\t3\n4.5\t5\t6\n", "a.txt", 2, {4.5, 5, 6}, false, {}, false},
        {"quoted header", "\"x\" \"y\" \"z\"\n1 2 3\n4 5 6\n", "a.asc", 2, {4, 5, 6}, false, {}, false},
        {"row names of R",
         "\"x\" \"y\" \"z\"\n\"1\" 1 2 3\n\"2\" 4 5 6\n",
         "a.asc",
         2,
         {4, 5, 6},
         false,
         {},
         false},
        {"CSV",
         "x,y,z,r,g,b\n1,2,3,10,20,30\n4,5,6,40,50,255\n",
         "a.csv",
         2,
         {4, 5, 6},
         true,
         {40, 50, 255},
         false},
        {"CSV and blanks", "1.5, 2, 3\n4, 5.5, 6\n", "a.txt", 2, {4, 5.5, 6}, false, {}, false},
        {"decimal comma", "1,5;2,0;3,5\n4,25;5,0;6,0\n", "a.csv", 2, {4.25, 5, 6}, false, {}, false},
        {"decimal comma and tabs",
         "1,5\t2,0\t3,5\n4,25\t5,0\t6,0\n",
         "a.txt",
         2,
         {4.25, 5, 6},
         false,
         {},
         false},
        {"semicolons", "Z;Y;X\n3;2;1\n6;5;4\n", "a.csv", 2, {4, 5, 6}, false, {}, false},
        {"CloudCompare",
         "//X Y Z Rf Gf Bf Nx Ny Nz\n1 2 3 1 1 1 0 0 1\n4 5 6 0 0.2 1 0 1 0\n",
         "a.asc",
         2,
         {4, 5, 6},
         true,
         {0, 51, 255},
         true},
        {"byte order mark",
         "\xEF\xBB\xBF"
         "1 2 3\n4 5 6\n",
         "a.txt",
         2,
         {4, 5, 6},
         false,
         {},
         false},
        {"Windows line ends", "1 2 3\r\n4 5 6\r\n\r\n", "a.txt", 2, {4, 5, 6}, false, {}, false},
        {"old Macintosh line ends", "1 2 3\r4 5 6\r", "a.txt", 2, {4, 5, 6}, false, {}, false},
        {"comments", "# a scan\n# of 2020\n1 2 3\n# pause\n4 5 6\n", "a.txt", 2, {4, 5, 6}, false, {}, false},
        {"no end of line", "1 2 3\n4 5 6", "a.txt", 2, {4, 5, 6}, false, {}, false},
        {"plus and exponent", "+1 2e0 3\n+4.0 5.0E+00 0.6e1\n", "a.txt", 2, {4, 5, 6}, false, {}, false},
        {"COLMAP's points",
         "# 3D point list\n#   POINT3D_ID, X, Y, Z, R, G, B, ERROR, TRACK[] as (IMAGE_ID, IDX)\n"
         "17 1 2 3 10 20 30 0.5 1 2 3 4\n5 4 5 6 7 8 9 0.5 1 2\n",
         "points3D.txt",
         2,
         {4, 5, 6},
         true,
         {7, 8, 9},
         false},
        {"ParaView",
         "\"Points:0\",\"Points:1\",\"Points:2\"\n1,2,3\n4,5,6\n",
         "a.csv",
         2,
         {4, 5, 6},
         false,
         {},
         false},
        {"text column", "tree,x,y,z\noak,1,2,3\nold elm,4,5,6\n", "a.csv", 2, {4, 5, 6}, false, {}, false},
        {"empty field", "x,i,y,z\n1,7,2,3\n4,,5,6\n", "a.csv", 2, {4, 5, 6}, false, {}, false},
        {"count in .pts",
         "2\n1 2 3 -512 10 20 30\n4 5 6 -7 40 50 60\n",
         "a.pts",
         2,
         {4, 5, 6},
         true,
         {40, 50, 60},
         false},
        {"intensity as a byte",
         "1 2 3 200 10 20 30\n4 5 6 7 140 150 160\n",
         "a.txt",
         2,
         {4, 5, 6},
         true,
         {140, 150, 160},
         false},
        {"opacity",
         "1 2 3 10 20 30 255\n4 5 6 140 150 160 255\n",
         "a.txt",
         2,
         {4, 5, 6},
         true,
         {140, 150, 160},
         false},
        {"two blocks in .pts", "1\n1 2 3 0\n1\n4 5 6 1\n", "a.pts", 2, {4, 5, 6}, false, {}, false},
        {"normals and more",
         "1 2 3 0.6 0.8 0 1\n4 5 6 0 0.6 0.8 1\n",
         "a.txt",
         2,
         {4, 5, 6},
         false,
         {},
         true},
        {"running number", "1 7.5 2 3\n2 4.5 5 6\n3 9.5 5 6\n", "a.txt", 3, {4.5, 5, 6}, false, {}, false},
        {"colours as floats",
         "1 2 3 228.0 202.0 173.0\n4 5 6 63.0 43.0 41.0\n",
         "a.xyz",
         2,
         {4, 5, 6},
         true,
         {63, 43, 41},
         false},
        {"colours of 16 bits",
         "x y z r g b\n1 2 3 65535 0 0\n4 5 6 257 514 0\n",
         "a.txt",
         2,
         {4, 5, 6},
         true,
         {1, 2, 0},
         false},
    };
    for (const TextCase& c : cases) {
        SCOPED_TRACE(c.what);
        const PointCloud cloud = read_text_of(c.text, c.name);
        ASSERT_EQ(cloud.size(), c.points);
        expect_point(cloud, 1, c.second);
        ASSERT_EQ(cloud.has_colors(), c.colors);
        if (c.colors) {
            EXPECT_EQ(cloud.colors[1], c.second_color);
        }
        EXPECT_EQ(cloud.has_normals(), c.normals);
    }
}

TEST(ScanText, TakesTheUsersColumns) {
    ReadCloudOptions options;
    options.columns = {"-", "z", "y", "x", "intensity"};
    ReadCloudReport report;
    const PointCloud cloud = read_text_of("9 3 2 1 7\n9 6 5 4 7\n", "a.txt", &report, options);
    expect_point(cloud, 1, {4, 5, 6});
    EXPECT_EQ(report.format, "text, 5 columns: - z y x -");
    options.columns = {"x", "y"};
    EXPECT_THROW(read_text_of("1 2 3\n4 5 6\n", "a.txt", nullptr, options), Error);
    options.columns = {"x", "y", "z", "r", "g", "b"};
    EXPECT_THROW(read_text_of("1 2 3\n4 5 6\n", "a.txt", nullptr, options), Error);
}

TEST(ScanText, SaysWhatItLeftOut) {
    ReadCloudReport report;
    EXPECT_EQ(read_text_of("1 2 3\nnan 5 6\n1e999 1 1\n1.#QNAN 2 2\n4 5 6\n", "a.txt", &report).size(), 2U);
    ASSERT_EQ(report.warnings.size(), 1U);
    EXPECT_EQ(report.warnings[0], "3 of 5 points had no finite position and were left out.");
    EXPECT_EQ(read_text_of("1 2 3\n4 5 6\n7 8 9\noak\n3 2 1\n", "a.txt", &report).size(), 4U);
    ASSERT_EQ(report.warnings.size(), 1U);
    EXPECT_NE(report.warnings[0].find("line 4"), std::string::npos);
    EXPECT_EQ(read_text_of("1 2 3\n4 5 6\n7 8", "a.txt", &report).size(), 2U);
    ASSERT_EQ(report.warnings.size(), 1U);
    EXPECT_NE(report.warnings[0].find("cut off"), std::string::npos);
    EXPECT_EQ(read_text_of("1 2 3\n1e11 5 6\n4 5 6\n", "a.txt", &report).size(), 2U);
    EXPECT_NE(report.warnings.at(0).find("far away"), std::string::npos);
}

TEST(ScanText, SaysWhatIsWrong) {
    EXPECT_NE(error_of("", "a.txt").find("is empty"), std::string::npos);
    EXPECT_NE(error_of("\n\n  \n", "a.txt").find("no line"), std::string::npos);
    EXPECT_NE(error_of("1 2\n3 4\n", "a.txt").find("three numbers"), std::string::npos);
    EXPECT_NE(error_of("Dear diary,\ntoday we scanned 3 trees.\n", "a.txt").find("not a point cloud"),
              std::string::npos);
    EXPECT_NE(error_of("3\n1 2 3\n4 5 6\n", "a.pts").find("promises 3"), std::string::npos);
    EXPECT_NE(error_of("nan nan nan\nnan nan nan\n", "a.txt").find("finite"), std::string::npos);
    std::string diary = "1 2 3\n";
    for (int i = 0; i < 50; i++)
        diary += "1 2 3\nand a line of prose\n";
    EXPECT_NE(error_of(diary, "a.txt").find("not rows of numbers"), std::string::npos);
}

// --- LAS ---------------------------------------------------------------------------------------------------

struct LasFile {
    int minor = 2;
    int format = 3;
    size_t extra = 0;  // bytes after each record
    int depth = 16;    // bits of a colour channel

    std::string bytes(const std::vector<DVec3>& positions, const std::vector<Color8>& colors) const {
        const size_t sizes[] = {20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
        const size_t rgb_at[] = {0, 0, 20, 28, 0, 28, 0, 30, 30, 0, 30};
        const size_t header_size = minor >= 4 ? 375 : minor == 3 ? 235 : 227;
        const size_t stride = sizes[format] + extra;
        std::string file(header_size + 11, '\0');  // and a gap before the points
        auto put = [&](size_t at, auto value) { std::memcpy(&file[at], &value, sizeof(value)); };
        std::memcpy(file.data(), "LASF", 4);
        file[24] = 1;
        file[25] = static_cast<char>(minor);
        put(94, static_cast<uint16_t>(header_size));
        put(96, static_cast<uint32_t>(file.size()));
        file[104] = static_cast<char>(format);
        put(105, static_cast<uint16_t>(stride));
        if (minor >= 4)
            put(247, static_cast<uint64_t>(positions.size()));
        else
            put(107, static_cast<uint32_t>(positions.size()));
        for (size_t k = 0; k < 3; k++) {
            put(131 + 8 * k, 0.001);
            put(155 + 8 * k, 500000.0);
        }
        for (size_t i = 0; i < positions.size(); i++) {
            std::string record(stride, '\x55');
            record[15] = 0;  // no flags
            for (int k = 0; k < 3; k++) {
                const int32_t steps = static_cast<int32_t>(std::lround((positions[i][k] - 500000.0) / 0.001));
                std::memcpy(&record[static_cast<size_t>(4 * k)], &steps, 4);
                const uint16_t channel =
                    static_cast<uint16_t>(colors[i][static_cast<size_t>(k)] * (depth == 16 ? 257 : 1));
                if (rgb_at[format])
                    std::memcpy(&record[rgb_at[format] + static_cast<size_t>(2 * k)], &channel, 2);
            }
            file += record;
        }
        return file;
    }
};

TEST(ScanLas, ReadsEveryVersionAndFormat) {
    if constexpr (std::endian::native != std::endian::little)
        GTEST_SKIP() << "The test writes little endian.";
    Random random(3);
    std::vector<DVec3> positions;
    std::vector<Color8> colors;
    for (int i = 0; i < 50; i++) {
        positions.emplace_back(500000.0 + 0.001 * random.below(10000), 499990.0 + 0.001 * random.below(10000),
                               500020.0 + 0.001 * random.below(10000));
        colors.push_back(
            {static_cast<uint8_t>(random.below(256)), static_cast<uint8_t>(random.below(256)), 200});
    }
    for (int minor = 0; minor <= 4; minor++) {
        for (int format = 0; format <= (minor < 4 ? 5 : 10); format++) {
            for (const int depth : {8, 16}) {
                SCOPED_TRACE(std::to_string(minor) + " " + std::to_string(format) + " " +
                             std::to_string(depth));
                const LasFile las{minor, format, static_cast<size_t>(format % 3), depth};
                const PointCloud cloud = read_text_of(las.bytes(positions, colors), "a.las");
                ASSERT_EQ(cloud.size(), positions.size());
                const bool colored =
                    format == 2 || format == 3 || format == 5 || format == 7 || format == 8 || format == 10;
                ASSERT_EQ(cloud.has_colors(), colored);
                for (size_t i = 0; i < cloud.size(); i++) {
                    expect_point(cloud, i, positions[i]);
                    if (colored) {
                        EXPECT_EQ(cloud.colors[i], colors[i]);
                    }
                }
            }
        }
    }
}

TEST(ScanLas, SaysWhatIsWrong) {
    const std::string good = LasFile{}.bytes(std::vector<DVec3>(9, DVec3(500000.0)), std::vector<Color8>(9));
    EXPECT_NE(error_of(good.substr(0, 100), "a.las").find("cut off"), std::string::npos);
    EXPECT_NE(error_of(good.substr(0, good.size() - 1), "a.las").find("promises 9 points, but it holds 8"),
              std::string::npos);
    std::string bad = good;
    bad[104] = static_cast<char>(0x83);
    EXPECT_NE(error_of(bad, "a.laz"), "");
    bad = good;
    bad[25] = 7;
    EXPECT_NE(error_of(bad, "a.las").find("version 1.7"), std::string::npos);
    bad = good;
    bad[104] = 40;
    EXPECT_NE(error_of(bad, "a.las").find("point format 40"), std::string::npos);
    bad = good;
    std::memset(&bad[131], 0, 8);
    EXPECT_NE(error_of(bad, "a.las").find("damaged"), std::string::npos);
}

}  // namespace
}  // namespace treerec
