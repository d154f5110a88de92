#include "exchange/obj.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include "error.h"
#include "mesh/branch_tubes.h"
#include "mesh/leaf_cards.h"
#include "random_tree.h"

namespace treerec {
namespace {

struct Part {
    Mesh mesh;
    std::string material;
};

// Reads what write_obj writes: every corner has one number for position, uv and normal.
std::vector<Part> read_obj(const std::string& path) {
    std::ifstream file(path);
    std::vector<Part> parts;
    std::string line, word;
    size_t before = 0;
    while (std::getline(file, line)) {
        std::istringstream words(line);
        words >> word;
        if (word == "o") {
            if (!parts.empty()) before += parts.back().mesh.positions.size();
            parts.emplace_back();
        } else if (word == "v" || word == "vn") {
            Vec3 v(0.0f);
            words >> v.x >> v.y >> v.z;
            (word == "v" ? parts.back().mesh.positions : parts.back().mesh.normals).push_back(v);
        } else if (word == "vt") {
            Vec2 v(0.0f);
            words >> v.x >> v.y;
            parts.back().mesh.uvs.push_back(v);
        } else if (word == "usemtl") {
            words >> parts.back().material;
        } else if (word == "f") {
            for (int k = 0; k < 3; k++) {
                size_t a = 0, b = 0, c = 0;
                char slash = 0;
                words >> a >> slash >> b >> slash >> c;
                EXPECT_TRUE(a == b && b == c);
                parts.back().mesh.indices.push_back(static_cast<uint32_t>(a - 1 - before));
            }
        }
        EXPECT_FALSE(words.fail()) << line;
    }
    return parts;
}

class ObjWrite : public testing::Test {
  protected:
    ObjWrite() {
        folder_ = std::filesystem::temp_directory_path() / ("treerec obj " + std::to_string(::getpid()));
        std::filesystem::create_directories(folder_);
        const Tree tree = test::random_tree(3, 300);
        bark_ = build_branch_tubes(tree);
        leaves_ = bake_leaves(place_leaves(tree, leaf_preset("birch"), 1));
        model_.bark = &bark_;
        model_.leaves = &leaves_;
        model_.pictures = make_pictures("birch", 32, 1);
    }
    ~ObjWrite() override {
        std::error_code ignored;
        std::filesystem::remove_all(folder_, ignored);
    }
    std::string path(const char* name) const { return (folder_ / name).string(); }

    std::filesystem::path folder_;
    Mesh bark_, leaves_;
    ModelFile model_;
};

void expect_same(const Mesh& read, const Mesh& written) {
    ASSERT_EQ(read.positions.size(), written.positions.size());
    ASSERT_EQ(read.uvs.size(), written.uvs.size());
    ASSERT_EQ(read.normals.size(), written.normals.size());
    EXPECT_EQ(read.indices, written.indices);
    for (size_t i = 0; i < written.positions.size(); i++) {
        ASSERT_NEAR(glm::distance(read.positions[i], written.positions[i]), 0.0f, 2e-5f);
        ASSERT_NEAR(glm::distance(read.normals[i], written.normals[i]), 0.0f, 2e-4f);
        ASSERT_NEAR(read.uvs[i].x, written.uvs[i].x, 2e-5f);
        ASSERT_NEAR(1.0f - read.uvs[i].y, written.uvs[i].y, 2e-5f);
    }
}

TEST_F(ObjWrite, WhatIsReadIsWhatWasWritten) {
    write_obj(path("tree.obj"), model_);
    const std::vector<Part> parts = read_obj(path("tree.obj"));
    ASSERT_EQ(parts.size(), 2u);
    EXPECT_EQ(parts[0].material, "bark");
    EXPECT_EQ(parts[1].material, "leaves");
    expect_same(parts[0].mesh, bark_);
    expect_same(parts[1].mesh, leaves_);
    for (const char* beside : {"tree.mtl", "tree_bark_albedo.jpg", "tree_leaf_albedo.png"})
        EXPECT_TRUE(std::filesystem::exists(path(beside))) << beside;
}

// Every picture that the materials name is there, and the roughness is a grey one.
TEST_F(ObjWrite, TheMaterialsHaveTheirPictures) {
    write_obj(path("tree.obj"), model_);
    std::ifstream materials(path("tree.mtl"));
    std::string key, value;
    std::set<std::string> keys;
    for (std::string line; std::getline(materials, line);) {
        std::istringstream words(line);
        words >> key >> value;
        keys.insert(key);
        if (!value.ends_with(".png") && !value.ends_with(".jpg")) continue;
        std::ifstream picture(path(value.c_str()), std::ios::binary);
        std::string head(26, '\0');
        picture.read(head.data(), 26);
        ASSERT_TRUE(picture) << value;
        EXPECT_EQ(head.starts_with("\xFF\xD8\xFF"), value.ends_with(".jpg")) << value;
        if (value.ends_with(".jpg")) {
            EXPECT_NE(key, "map_Pr");
            continue;
        }
        EXPECT_EQ(head[25] == 0, key == "map_Pr") << value;  // PNG's colour type: grey
    }
    for (const char* wanted : {"map_Kd", "map_Pr", "map_d", "norm"})
        EXPECT_TRUE(keys.contains(wanted)) << wanted;
}

TEST_F(ObjWrite, NumbersOfEverySizeComeBack) {
    Mesh mesh;
    for (float x : {0.0f, -0.0f, 1e-9f, -1e-9f, 0.5f, -0.99999f, 1.0f, 123456.78f, -98765.4f, 1e12f})
        mesh.positions.push_back({x, -x, 0.25f});
    mesh.normals.assign(mesh.positions.size(), {0.0f, 1.0f, 0.0f});
    mesh.uvs.assign(mesh.positions.size(), {-3.25f, 7.5f});
    mesh.indices = {0, 1, 2, 3, 4, 5, 6, 7, 8};
    model_.bark = &mesh;
    model_.leaves = nullptr;
    write_obj(path("numbers.obj"), model_);
    const std::vector<Part> parts = read_obj(path("numbers.obj"));
    ASSERT_EQ(parts.size(), 1u);
    for (size_t i = 0; i < mesh.positions.size(); i++)
        EXPECT_NEAR(parts[0].mesh.positions[i].x, mesh.positions[i].x,
                    1e-5 + 1e-6 * std::abs(mesh.positions[i].x));
    EXPECT_FALSE(std::filesystem::exists(path("numbers_leaf_albedo.png")));
}

TEST_F(ObjWrite, FailuresNameThePath) {
    const std::string wrong = path("no folder/tree.obj");
    try {
        write_obj(wrong, model_);
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("no folder"), std::string::npos);
    }
    EXPECT_FALSE(std::filesystem::exists(path("no folder")));
}

}  // namespace
}  // namespace treerec
