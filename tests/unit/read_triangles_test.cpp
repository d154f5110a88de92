// Meshes of other programs as triangles (src/exchange/read_triangles).
#include "exchange/read_triangles.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <string>

#include "error.h"
#include "exchange/gltf.h"
#include "file_bytes.h"
#include "geometry/random.h"
#include "mesh/branch_tubes.h"
#include "mesh/leaf_cards.h"
#include "random_tree.h"

namespace treerec {
namespace {

using Triangles = std::vector<std::array<DVec3, 3>>;

class ReadTriangles : public testing::Test {
  protected:
    ReadTriangles() {
        folder_ = std::filesystem::temp_directory_path() / ("treerec meshes " + std::to_string(::getpid()));
        std::filesystem::create_directories(folder_);
    }
    ~ReadTriangles() override {
        std::error_code ignored;
        std::filesystem::remove_all(folder_, ignored);
    }
    std::string path(const std::string& name) const { return (folder_ / name).string(); }
    std::string write(const std::string& name, const std::string& text) const {
        write_file(path(name), text);
        return path(name);
    }
    std::string refusal(const std::string& file) const {
        try {
            read_triangles(file);
        } catch (const Error& error) {
            return error.what();
        }
        return "";
    }

    std::filesystem::path folder_;
};

void put(std::string& bytes, const auto& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
}

// Four corners of a square of one metre, at x, y = 0 and 1, and the indices of its two triangles.
std::string square_buffer() {
    std::string bytes;
    for (const float x : {0.0f, 1.0f})
        for (const float y : {0.0f, 1.0f})
            for (const float number : {x, y, 0.0f})
                put(bytes, number);
    for (const uint16_t index : {0, 2, 3, 0, 3, 1})
        put(bytes, index);
    return bytes;
}

std::string square_json(const std::string& nodes, const std::string& primitive = "\"indices\":1",
                        const std::string& accessors = "") {
    return "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[" + nodes +
           "],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}," + primitive +
           "}]}],\"accessors\":[" +
           (accessors.empty() ? "{\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\"},"
                                "{\"bufferView\":1,\"componentType\":5123,\"count\":6,\"type\":\"SCALAR\"}"
                              : accessors) +
           "],\"bufferViews\":[{\"buffer\":0,\"byteLength\":48},{\"buffer\":0,\"byteOffset\":48,"
           "\"byteLength\":12}],"
           "\"buffers\":[{\"byteLength\":60,\"uri\":\"square.bin\"}]}";
}

DVec3 area_of(const Triangles& triangles) {
    DVec3 sum(0.0);
    for (const std::array<DVec3, 3>& t : triangles)
        sum += 0.5 * glm::cross(t[1] - t[0], t[2] - t[0]);
    return sum;
}

void expect_near(const DVec3& a, const DVec3& b) {
    EXPECT_LT(glm::distance(a, b), 1e-6) << a.x << " " << a.y << " " << a.z;
}

}  // namespace

TEST_F(ReadTriangles, OurOwnModelsComeBackAsTheirFinestLevel) {
    const Tree tree = test::random_tree(3, 200);
    const Mesh bark = build_branch_tubes(tree),
               leaves = bake_leaves(place_leaves(tree, leaf_preset("oak"), 1));
    Mesh coarse = bark;
    coarse.indices.resize(3);
    ModelFile model;
    model.bark = &bark;
    model.leaves = &leaves;
    model.coarser = {{&coarse, nullptr, 10.0, {}}};
    model.pictures = make_pictures("oak", 32, 1);
    std::filesystem::create_directory(folder_ / "\u6728");
    for (const char* name : {"tree.glb", "tree.gltf", "\u6728/tree.gltf"}) {
        write_gltf(path(name), model);
        const Triangles found = read_triangles(path(name));
        ASSERT_EQ(found.size(), (bark.indices.size() + leaves.indices.size()) / 3) << name;
        for (size_t i = 0; i < bark.indices.size(); i++)
            ASSERT_EQ(found[i / 3][i % 3], DVec3(bark.positions[bark.indices[i]]));
        ASSERT_EQ(found.back()[2], DVec3(leaves.positions[leaves.indices.back()]));
    }
}

TEST_F(ReadTriangles, NodesPutThemInTheirPlace) {
    write("square.bin", square_buffer());
    const auto read = [&](const std::string& nodes) {
        return read_triangles(write("a.gltf", square_json(nodes)));
    };
    Triangles found = read("{\"mesh\":0}");
    ASSERT_EQ(found.size(), 2U);
    expect_near(area_of(found), DVec3(0.0, 0.0, 1.0));
    // Moved, scaled and turned by a quarter about X, below a node that is moved.
    found = read(
        "{\"translation\":[0,0,5],\"children\":[1]},{\"mesh\":0,\"translation\":[1,2,3],\"scale\":[2,3,1],"
        "\"rotation\":[0.70710678118,0,0,0.70710678118]}");
    expect_near(area_of(found), DVec3(0.0, -6.0, 0.0));
    expect_near(found[0][0], DVec3(1.0, 2.0, 8.0));
    expect_near(found[0][2], DVec3(3.0, 2.0, 11.0));
    // Mirrored, it still faces the way it is seen.
    found = read("{\"mesh\":0,\"matrix\":[-1,0,0,0, 0,1,0,0, 0,0,1,0, 4,0,0,1]}");
    expect_near(area_of(found), DVec3(0.0, 0.0, 1.0));
    expect_near(found[0][0], DVec3(4.0, 0.0, 0.0));
    // Strips, fans, and corners without indices.
    found = read_triangles(write("a.gltf", square_json("{\"mesh\":0}", "\"mode\":5")));
    ASSERT_EQ(found.size(), 2U);
    EXPECT_NEAR(std::abs(area_of(found).z), 1.0, 1e-6);
    found = read_triangles(write("a.gltf", square_json("{\"mesh\":0}", "\"mode\":6")));
    ASSERT_EQ(found.size(), 2U);
}

TEST_F(ReadTriangles, WhatIsDamagedGetsASentence) {
    write("square.bin", square_buffer());
    const auto refused = [&](const std::string& json) { return refusal(write("a.gltf", json)); };
    EXPECT_NE(refused("{"), "");
    EXPECT_NE(refused("").find("a.gltf"), std::string::npos);
    EXPECT_NE(refused(square_json("{\"mesh\":3}")).find("damaged"), std::string::npos);
    EXPECT_NE(refused(square_json("{\"children\":[0]}")).find("damaged"), std::string::npos);
    EXPECT_NE(refused(square_json("{}")).find("no triangles"), std::string::npos);
    const std::string far =
        "{\"bufferView\":0,\"componentType\":5126,\"count\":5,\"type\":\"VEC3\"},"
        "{\"bufferView\":1,\"componentType\":5123,\"count\":6,\"type\":\"SCALAR\"}";
    EXPECT_NE(refused(square_json("{\"mesh\":0}", "\"indices\":1", far)).find("damaged"), std::string::npos);
    const std::string huge =
        "{\"bufferView\":0,\"componentType\":5126,\"count\":4611686018427387904,\"type\":\"VEC3\"}";
    EXPECT_NE(refused(square_json("{\"mesh\":0}", "\"mode\":4", huge)), "");
    const std::string sparse =
        "{\"componentType\":5126,\"count\":4,\"type\":\"VEC3\"},"
        "{\"bufferView\":1,\"componentType\":5123,\"count\":6,\"type\":\"SCALAR\"}";
    EXPECT_NE(refused(square_json("{\"mesh\":0}", "\"indices\":1", sparse)).find("compress"),
              std::string::npos);
    std::filesystem::remove(path("square.bin"));
    EXPECT_NE(refused(square_json("{\"mesh\":0}")), "");
}

TEST_F(ReadTriangles, WhateverBytesAreChangedNothingElseHappens) {
    const Tree tree = test::random_tree(5, 30);
    const Mesh bark = build_branch_tubes(tree);
    ModelFile model;
    model.bark = &bark;
    model.pictures = make_pictures("oak", 16, 1);
    write_gltf(path("good.glb"), model);
    const std::string good(read_file(path("good.glb")).view());
    size_t refusals = 0;
    Random random(1);
    for (int round = 0; round < 300; round++) {
        std::string bad = good;
        if (round % 3 == 0) bad.resize(random.below(static_cast<uint32_t>(bad.size())));
        // Most in its JSON, where numbers become others.
        for (uint32_t i = 1 + random.below(4); i > 0 && !bad.empty(); i--)
            bad[random.below(static_cast<uint32_t>(std::min<size_t>(bad.size(), 4000)))] =
                static_cast<char>(random.below(2) == 0 ? '0' + random.below(10) : random.below(256));
        refusals += refusal(write("bad.glb", bad)).empty() ? 0 : 1;
    }
    EXPECT_GT(refusals, 100U);
}

}  // namespace treerec
