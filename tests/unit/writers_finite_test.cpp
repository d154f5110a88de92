// No file that is written holds a number that is none, whatever the tree is.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>

#include "cases.h"
#include "error.h"
#include "exchange/ready_pictures.h"
#include "exchange/tree_files.h"
#include "fidelity/score.h"
#include "file_bytes.h"
#include "pipeline/export.h"
#include "pipeline/html_report.h"
#include "pipeline/report.h"
#include "random_tree.h"
#include "scan_samples.h"

namespace treerec {
namespace {

using scan_test::bytes_of;
using scan_test::Folder;

// Whether text has a word that stands for no number, but for what is packed as base64.
bool names_no_number(const std::string& text) {
    const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
    for (size_t at = 0; at < text.size();) {
        if (!is_letter(text[at])) {
            at++;
            continue;
        }
        std::string word;
        for (; at < text.size() && is_letter(text[at]); at++)
            word += static_cast<char>(text[at] | 0x20);
        if (word == "nan" || word == "inf" || word == "infinity") return true;
        if (word == "base") at = std::min(text.find('"', at), text.size());
    }
    return false;
}

// The floats of a GLB's accessors, and whether it has a mesh.
void expect_sound_glb(const std::string& bytes, const std::string& what) {
    uint32_t length = 0;
    std::memcpy(&length, bytes.data() + 12, 4);
    const auto json = nlohmann::json::parse(bytes.substr(20, length));
    const char* const data = bytes.data() + 20 + length + 8;
    EXPECT_FALSE(json["meshes"].empty()) << what;
    for (const auto& accessor : json["accessors"]) {
        if (accessor["componentType"] != 5126) continue;
        const auto& view = json["bufferViews"][accessor["bufferView"].get<size_t>()];
        const std::string type = accessor["type"];
        const size_t width = type == "SCALAR" ? 1 : static_cast<size_t>(type.back() - '0');
        const size_t begin = view.value("byteOffset", size_t{0}) + accessor.value("byteOffset", size_t{0});
        for (size_t i = 0; i < accessor["count"].get<size_t>() * width; i++) {
            float value = 0.0F;
            std::memcpy(&value, data + begin + 4 * i, 4);
            ASSERT_TRUE(std::isfinite(value)) << what << ", a " << type;
        }
    }
}

// The vertices of an OBJ are there, not all at one place, and its triangles name them.
void expect_sound_obj(const std::string& text, const std::string& what) {
    std::istringstream lines(text);
    size_t vertices = 0, largest = 0, triangles = 0;
    std::set<std::string> places;
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with("v ")) {
            vertices++;
            places.insert(line);
        }
        if (!line.starts_with("f ")) continue;
        triangles++;
        for (size_t at = line.find(' '); at != std::string::npos; at = line.find(' ', at + 1))
            largest = std::max(largest, static_cast<size_t>(std::stoul(line.substr(at + 1))));
    }
    EXPECT_GT(triangles, 0u) << what;
    EXPECT_LE(largest, vertices) << what;
    EXPECT_GT(places.size(), 2u) << what;
}

// How far the farthest node is from the root, in metres.
double reach_of(const Tree& tree) {
    double reach = 0.0;
    for (const NodeId id : tree.depth_first())
        reach = std::max(reach, glm::length(tree.node(id).position - tree.node(tree.root()).position));
    return reach;
}

// What the step between numbers at the tree's place in the scan makes of a length, in metres.
double step_of(const Tree& tree) {
    double largest = 0.0;
    for (const NodeId id : tree.depth_first()) {
        const DVec3 p = tree.frame().to_scan(tree.node(id).position);
        largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    }
    return largest * 1e-15 * tree.frame().metres_per_unit;
}

// The same nodes, as far from the root.
void expect_reads_back(const std::string& path, const Tree& tree, const std::string& what) {
    const ScanFrame& frame = tree.frame();
    try {
        const Tree read = read_skeleton(path, {frame.up});
        EXPECT_EQ(read.size(), tree.size()) << what;
        // A table of cylinders doesn't say its unit.
        const double unit = path.ends_with(".csv") ? frame.metres_per_unit : 1.0;
        const double reach = reach_of(tree);
        EXPECT_NEAR(reach_of(read) * unit, reach, 1e-4 * reach + 8.0 * step_of(tree)) << what;
    } catch (const Error& error) {
        ADD_FAILURE() << what << ": " << error.what();
    }
}

const char* const kNames[] = {"t.glb", "t.gltf", "t.obj", "t.txt", "t.csv", "t.lstring", "t.ply"};

// Writes the tree in every format: what is written is sound and can be read back, and what can't be gets a
// sentence and no file. Returns how many files were written.
int write_all(const Tree& tree, const std::string& what, const std::string& leaves = "none") {
    const Folder folder;
    ExportOptions options;
    options.leaves = leaf_preset(leaves);
    options.levels = 2;
    TreeExporter exporter(tree, options);
    int written = 0;
    for (const std::string name : kNames) {
        const std::string path = folder.file(name), here = what + ", " + name;
        try {
            exporter.write(path);
            written++;
        } catch (const Error& error) {
            EXPECT_GT(std::strlen(error.what()), 30u) << here;
            EXPECT_FALSE(std::filesystem::exists(path)) << here;
            continue;
        }
        const std::string bytes = bytes_of(path);
        if (name == "t.glb") {
            expect_sound_glb(bytes, here);
        } else if (name == "t.obj") {
            expect_sound_obj(bytes, here);
            EXPECT_FALSE(names_no_number(bytes)) << here;
        } else if (name == "t.gltf") {
            EXPECT_FALSE(names_no_number(bytes)) << here;
        } else {
            EXPECT_TRUE(name == "t.ply" || !names_no_number(bytes)) << here;
            expect_reads_back(path, tree, here);
        }
    }
    return written;
}

// A random frame of a scan: where it lies, what its unit is, where its sky is.
ScanFrame random_frame(Random& random, double far, double smallest_unit, double largest_unit) {
    ScanFrame frame;
    frame.set_sky(random.direction());
    frame.metres_per_unit = std::exp(random.uniform(std::log(smallest_unit), std::log(largest_unit)));
    frame.origin =
        far * DVec3(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0));
    return frame;
}

TEST(Writers, WriteAndReadBackTreesOfAnySize) {
    use_ready_pictures();
    Random random(3);
    const int count = test::cases(32);
    for (int i = 0; i < count; i++) {
        Tree tree = test::random_tree(static_cast<uint64_t>(i), 3 + static_cast<int>(random.below(25)));
        const double exponent = random.uniform(-2.0, 2.0);
        tree.scale(std::pow(10.0, exponent));
        tree.set_frame(random_frame(random, 1e7, 1e-3, 1e3));
        const std::string what = "tree " + std::to_string(i) + ", 12 m * 10^" + std::to_string(exponent);
        EXPECT_EQ(write_all(tree, what, i % 4 == 0 && exponent < 0.3 ? "generic" : "none"), 7) << what;
    }
}

TEST(Writers, WriteAndReadBackTreesOfAnyShape) {
    use_ready_pictures();
    Random random(4);
    const int count = test::cases(40);
    for (int i = 0; i < count; i++) {
        Tree tree = test::wild_tree(static_cast<uint64_t>(i), 2 + static_cast<int>(random.below(20)));
        tree.set_frame(random_frame(random, 1e6, 0.1, 10.0));
        // Internodes without a length, and twigs that are all but nothing.
        for (const NodeId id : tree.depth_first()) {
            const NodeId parent = tree.node(id).parent;
            if (parent != kNoNode && parent != tree.root() && random.below(4) == 0)
                tree.set_position(id, tree.node(parent).position);
            if (random.below(4) == 0) tree.set_radius(id, std::pow(10.0, random.uniform(-300.0, -4.0)));
        }
        write_all(tree, "wild tree " + std::to_string(i));
    }
}

TEST(Writers, RefuseWhatTheirReadersWould) {
    Random random(5);
    const double sizes[] = {1e-9, 1e-6, 1e-3, 1.0, 1e3, 1e5, 1e9, 1e30};
    const double places[] = {1e7, 1e9, 1e10, 1e11, 9e11, 1e12, 1e13, 1e300};
    const double units[] = {1e-13, 1e-9, 1e-4, 1.0, 1e4, 1e11, 1e13};
    const int count = test::cases(120);
    int written = 0;
    for (int i = 0; i < count; i++) {
        const double size = sizes[random.below(8)], place = places[random.below(8)];
        const double unit = units[random.below(7)];
        Tree tree = test::random_tree(static_cast<uint64_t>(i), 2 + static_cast<int>(random.below(6)));
        tree.scale(size);
        tree.set_frame(random_frame(random, place, unit, unit));
        written += write_all(tree, "tree " + std::to_string(i) + ", size " + std::to_string(size) +
                                       ", unit " + std::to_string(unit) + ", place " + std::to_string(place));
    }
    EXPECT_GT(written, count);
    // Wood that is none.
    Tree root;
    root.add_root(DVec3(1.0), 0.1);
    EXPECT_EQ(write_all(root, "a single node"), 0);
    Tree point = root;
    point.add_child(point.add_child(point.root(), DVec3(1.0), 0.1), DVec3(1.0), 0.05);
    EXPECT_EQ(write_all(point, "all at one place"), 0);
}

TEST(Writers, NeverWriteWhatIsNoNumber) {
    use_ready_pictures();
    Random random(8);
    const double odd[] = {1e300, 1e160, 1e39,  1e30,  1e20,   1e12,   1e7,    1e5,
                          1e-5,  1e-12, 1e-30, 1e-45, 1e-160, 1e-300, 5e-324, 0.0};
    const int count = test::cases(80);
    for (int i = 0; i < count; i++) {
        Tree tree = test::random_tree(static_cast<uint64_t>(i), 2 + static_cast<int>(random.below(8)));
        // Where one number is too large the tree is refused, so that most have small ones.
        const uint32_t first = random.below(3) == 0 ? 0 : 6;
        const auto any = [&] { return odd[first + random.below(16 - first)]; };
        for (const NodeId id : tree.depth_first()) {
            if (random.below(3) == 0)
                tree.set_position(
                    id, {any() * random.uniform(-1.0, 1.0), any(), any() * random.uniform(-1.0, 1.0)});
            const double radius = any();
            if (random.below(3) == 0 && radius > 0.0) tree.set_radius(id, radius);
        }
        ScanFrame frame;
        frame.up = UpAxis::kZ;
        if (random.below(2) == 0) frame.metres_per_unit = std::max(any(), 1e-11);
        if (random.below(2) == 0) frame.origin = DVec3(any(), 0.0, -any());
        tree.set_frame(frame);
        write_all(tree, "odd tree " + std::to_string(i));
    }
}

// Points that are nowhere, in every place of a scan's files and in all that is told of its tree.
TEST(Writers, TellNumbersAloneOfScansWithDamage) {
    use_ready_pictures();
    const Folder folder;
    std::string text = "x y z nx ny nz r g b\n";
    const char* const damage[] = {"inf", "-inf", "nan", "1e39", "-1e300", "1e11"};
    const std::vector<Vec3> points = scan_test::tree_points(4);
    for (size_t i = 0; i < points.size(); i++) {
        std::string values[9] = {std::to_string(points[i].x),
                                 std::to_string(-points[i].z),
                                 std::to_string(points[i].y),
                                 "0",
                                 "0",
                                 "1",
                                 "90",
                                 "80",
                                 "70"};
        if (i % 50 == 0) values[(i / 50) % 9] = damage[(i / 450) % 6];
        for (const std::string& value : values)
            text += value + " ";
        text += "\n";
    }
    Reconstruction result = reconstruct_file(folder.write("scan.txt", text), {});
    ReportDetails details;
    details.scan_path = "scan.txt";
    EXPECT_FALSE(names_no_number(report_html(result, details)));
    EXPECT_FALSE(names_no_number(report_json(result, details)));
    EXPECT_EQ(write_all(result.tree, "a damaged scan", "generic"), 7);
    for (const char* name : {"c.ply", "c.las", "c.xyz"}) {
        write_cloud(folder.file(name), result.cloud);
        EXPECT_FALSE(std::string(name) == "c.xyz" && names_no_number(bytes_of(folder.file(name))));
        EXPECT_EQ(read_cloud(folder.file(name)).size(), result.cloud.size()) << name;
    }
    PointCloud damaged = result.cloud;
    damaged.positions[3].y = std::numeric_limits<float>::quiet_NaN();
    for (const char* name : {"d.ply", "d.las", "d.xyz"})
        EXPECT_THROW(write_cloud(folder.file(name), damaged), Error) << name;
}

}  // namespace
}  // namespace treerec
