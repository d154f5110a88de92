// No file that is written holds a number that is none, whatever the tree is.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "error.h"
#include "exchange/tree_files.h"
#include "fidelity/score.h"
#include "file_bytes.h"
#include "pipeline/export.h"
#include "pipeline/html_report.h"
#include "pipeline/report.h"
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

// Writes the tree in every format: what is written is sound, and what can't be gets a sentence and no file.
// Returns how many files were written.
int write_all(const Tree& tree, const Folder& folder, const std::string& what,
              const std::string& leaves = "generic") {
    ExportOptions options;
    options.leaves = leaf_preset(leaves);
    options.levels = 2;
    int written = 0;
    for (const char* name : {"t.glb", "t.obj", "t.txt", "t.csv", "t.lstring", "t.ply"}) {
        const std::string path = folder.file(name);
        try {
            TreeExporter(tree, options).write(path);
            written++;
        } catch (const Error& error) {
            EXPECT_GT(std::strlen(error.what()), 15u) << what;
            EXPECT_FALSE(std::filesystem::exists(path)) << what << name;
            continue;
        }
        const std::string bytes = bytes_of(path);
        if (std::string(name) == "t.glb")
            expect_sound_glb(bytes, what);
        else if (std::string(name) == "t.ply")
            EXPECT_EQ(read_skeleton(path).size(), tree.size()) << what;  // it refuses what is no number
        else
            EXPECT_FALSE(names_no_number(bytes)) << what << name;
        std::filesystem::remove(path);
    }
    return written;
}

// Points that are nowhere, in every place of a scan's files and in all that is told of its tree.
TEST(Writers, TellNumbersAloneOfScansWithDamage) {
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
    EXPECT_EQ(write_all(result.tree, folder, "a damaged scan"), 6);
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
