#include "exchange/gltf.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "exchange/quiet_tiny_gltf.h"

#include "error.h"
#include "mesh/branch_tubes.h"
#include "mesh/leaf_cards.h"
#include "random_tree.h"

namespace treerec {
namespace {

class GltfWrite : public testing::Test {
  protected:
    GltfWrite() {
        folder_ = std::filesystem::temp_directory_path() / ("treerec gltf " + std::to_string(::getpid()));
        std::filesystem::create_directories(folder_);
        const Tree tree = test::random_tree(3, 300);
        bark_ = build_branch_tubes(tree);
        leaves_ = bake_leaves(place_leaves(tree, leaf_preset("oak"), 1));
        model_.bark = &bark_;
        model_.leaves = &leaves_;
        model_.preset = "oak";
        model_.pictures = make_pictures("oak", 32, 1);
        model_.extras = {{"height_m", 11.5}, {"nodes", 300.0}};
    }
    ~GltfWrite() override {
        std::error_code ignored;
        std::filesystem::remove_all(folder_, ignored);
    }
    std::string path(const char* name) const { return (folder_ / name).string(); }

    std::filesystem::path folder_;
    Mesh bark_, leaves_;
    ModelFile model_;
};

tinygltf::Model read(const std::string& path) {
    tinygltf::TinyGLTF reader;
    reader.SetImageLoader(
        [](tinygltf::Image* image, const int, std::string*, std::string*, int, int,
           const unsigned char* bytes, int size, void*) {
            image->image.assign(bytes, bytes + size);
            return true;
        },
        nullptr);
    tinygltf::Model model;
    std::string error, warning;
    const bool good = path.ends_with(".glb") ? reader.LoadBinaryFromFile(&model, &error, &warning, path)
                                             : reader.LoadASCIIFromFile(&model, &error, &warning, path);
    EXPECT_TRUE(good) << error;
    EXPECT_TRUE(error.empty() && warning.empty()) << error << warning;
    return model;
}

template <typename T, typename Allocator>
void expect_attribute(const tinygltf::Model& model, int accessor_index,
                      const std::vector<T, Allocator>& values) {
    const tinygltf::Accessor& accessor = model.accessors[static_cast<size_t>(accessor_index)];
    const tinygltf::BufferView& view = model.bufferViews[static_cast<size_t>(accessor.bufferView)];
    ASSERT_EQ(accessor.count, values.size());
    ASSERT_EQ(view.byteLength, values.size() * sizeof(T));
    EXPECT_EQ(view.byteOffset % 4, 0u);
    EXPECT_EQ(std::memcmp(model.buffers[0].data.data() + view.byteOffset, values.data(), view.byteLength), 0);
}

void expect_mesh(const tinygltf::Model& model, int mesh_index, const Mesh& mesh, size_t part = 0) {
    const tinygltf::Primitive& primitive = model.meshes[static_cast<size_t>(mesh_index)].primitives.at(part);
    // They are no colours: programs would multiply the picture by them.
    EXPECT_FALSE(primitive.attributes.contains("COLOR_0"));
    // Short indices where they suffice.
    if (mesh.positions.size() <= 65535)
        expect_attribute(model, primitive.indices,
                         std::vector<uint16_t>(mesh.indices.begin(), mesh.indices.end()));
    else
        expect_attribute(model, primitive.indices, mesh.indices);
    expect_attribute(model, primitive.attributes.at("POSITION"), mesh.positions);
    expect_attribute(model, primitive.attributes.at("NORMAL"), mesh.normals);
    expect_attribute(model, primitive.attributes.at("TANGENT"), mesh.tangents);
    expect_attribute(model, primitive.attributes.at("TEXCOORD_0"), mesh.uvs);
    const tinygltf::Accessor& wind = model.accessors[static_cast<size_t>(primitive.attributes.at("_WIND"))];
    EXPECT_TRUE(wind.normalized);
    const unsigned char* bytes =
        model.buffers[0].data.data() + model.bufferViews[static_cast<size_t>(wind.bufferView)].byteOffset;
    for (size_t i = 0; i < mesh.colors.size(); i++)
        for (int c = 0; c < 4; c++)
            ASSERT_NEAR(bytes[4 * i + static_cast<size_t>(c)] / 255.0f, mesh.colors[i][c], 0.003f);
}

TEST_F(GltfWrite, LevelsOfDetailAreNodesOfTheirOwn) {
    const Tree tree = test::random_tree(3, 300);
    std::vector<Mesh> bark, leaves;
    for (int level = 1; level < 4; level++) {
        TubeOptions options;
        options.level = level;
        bark.push_back(build_branch_tubes(tree, options));
        leaves.push_back(level == 3 ? Mesh() : bake_leaves(place_leaves(tree, leaf_preset("oak"), 1), level));
    }
    for (size_t i = 0; i < bark.size(); i++)
        model_.coarser.push_back({&bark[i], &leaves[i], 2.5 * (1.0 + i)});
    for (const char* name : {"levels.glb", "levels.gltf"}) {
        write_gltf(path(name), model_);
        const tinygltf::Model model = read(path(name));
        ASSERT_EQ(model.extensionsUsed, std::vector<std::string>{"MSFT_lod"});
        EXPECT_TRUE(model.extensionsRequired.empty());
        ASSERT_EQ(model.scenes.at(0).nodes, std::vector<int>{0});
        const tinygltf::Node& root = model.nodes.at(0);
        EXPECT_TRUE(root.extras.Has("height_m"));
        ASSERT_EQ(root.children.size(), 1u);  // the finest alone is in the scene
        const tinygltf::Node& finest = model.nodes.at(static_cast<size_t>(root.children[0]));
        const tinygltf::Value ids = finest.extensions.at("MSFT_lod").Get("ids");
        const tinygltf::Value coverage = finest.extras.Get("MSFT_screencoverage");
        ASSERT_EQ(ids.ArrayLen(), 3u);
        ASSERT_EQ(coverage.ArrayLen(), 4u);
        for (size_t level = 0; level < 4; level++) {
            SCOPED_TRACE(level);
            const int node = level == 0 ? root.children[0] : ids.Get(level - 1).GetNumberAsInt();
            const tinygltf::Node& shown = model.nodes.at(static_cast<size_t>(node));
            const std::string suffix = "_LOD" + std::to_string(level);
            EXPECT_EQ(shown.name, "Tree" + suffix);
            const double before = level > 0 ? coverage.Get(level - 1).GetNumberAsDouble() : 1.0;
            EXPECT_LT(coverage.Get(level).GetNumberAsDouble(), before);
            // The share of a square picture that a view of 75 degrees shows; the coarsest level never ends.
            const double high =
                level < 3 ? 0.5 / (std::tan(37.5 * M_PI / 180) * 2.5 * (1.0 + double(level))) : 0.0;
            EXPECT_NEAR(coverage.Get(level).GetNumberAsDouble(), high * high, 1e-3 * high * high);
            // As the extension's text has it: further levels are nodes that nothing else shows.
            if (level > 0) {
                EXPECT_TRUE(ids.Get(level - 1).IsInt());
                for (const tinygltf::Node& other : model.nodes)
                    EXPECT_EQ(std::count(other.children.begin(), other.children.end(), node), 0);
            }
            // One mesh of two surfaces, by whose name tools that scatter meshes know the level.
            EXPECT_TRUE(shown.children.empty());
            const tinygltf::Mesh& mesh = model.meshes.at(static_cast<size_t>(shown.mesh));
            EXPECT_EQ(mesh.name, "Tree" + suffix);
            ASSERT_EQ(mesh.primitives.size(), level < 3 ? 2u : 1u);
            for (size_t part = 0; part < mesh.primitives.size(); part++) {
                const Mesh& wanted = part == 0 ? (level == 0 ? bark_ : bark[level - 1])
                                               : (level == 0 ? leaves_ : leaves[level - 1]);
                expect_mesh(model, shown.mesh, wanted, part);
                EXPECT_EQ(mesh.primitives[part].material, static_cast<int>(part));
            }
        }
        EXPECT_EQ(model.materials.size(), 2u);
    }
}

// A share of the screen is one at most, however near its level begins.
TEST_F(GltfWrite, LevelsThatBeginCloseByCoverTheScreen) {
    model_.coarser.push_back({&bark_, &leaves_, 0.1});
    model_.coarser.push_back({&bark_, &leaves_, 0.3});
    write_gltf(path("near.glb"), model_);
    const tinygltf::Model model = read(path("near.glb"));
    const tinygltf::Value coverage = model.nodes.at(1).extras.Get("MSFT_screencoverage");
    ASSERT_EQ(coverage.ArrayLen(), 3u);
    EXPECT_EQ(coverage.Get(0).GetNumberAsDouble(), 1.0);
    EXPECT_EQ(coverage.Get(1).GetNumberAsDouble(), 1.0);
    EXPECT_EQ(coverage.Get(2).GetNumberAsDouble(), 0.0);
}

TEST_F(GltfWrite, WhatIsReadIsWhatWasWritten) {
    for (const char* name : {"a tree.glb", "a tree.gltf"}) {
        write_gltf(path(name), model_);
        const tinygltf::Model model = read(path(name));
        ASSERT_EQ(model.nodes.size(), 2u);
        EXPECT_EQ(model.nodes[0].name, "Tree");
        EXPECT_EQ(model.nodes[0].extras.Get("height_m").GetNumberAsDouble(), 11.5);
        EXPECT_EQ(model.nodes[1].name, "Tree_LOD0");
        EXPECT_TRUE(model.extensionsUsed.empty());
        expect_mesh(model, model.nodes[1].mesh, bark_, 0);
        expect_mesh(model, model.nodes[1].mesh, leaves_, 1);
        EXPECT_EQ(model.materials.at(1).alphaMode, "MASK");
        EXPECT_FALSE(model.materials.at(1).doubleSided);  // the leaves have a lower face of their own
        ASSERT_EQ(model.images.size(), 5u);
        for (const tinygltf::Image& image : model.images) {
            const auto picture = std::find_if(model_.pictures.begin(), model_.pictures.end(),
                                              [&](const NamedPicture& p) { return p.name == image.name; });
            ASSERT_NE(picture, model_.pictures.end());
            EXPECT_EQ(std::string(image.image.begin(), image.image.end()), picture->bytes)
                << name << " " << image.name;
        }
    }
}

TEST_F(GltfWrite, AMeshOfManyVerticesHasLongIndices) {
    bark_ = build_branch_tubes(test::random_tree(5, 20000));
    ASSERT_GT(bark_.positions.size(), 65535u);
    write_gltf(path("many.glb"), model_);
    const tinygltf::Model model = read(path("many.glb"));
    expect_mesh(model, model.nodes[1].mesh, bark_, 0);
    expect_mesh(model, model.nodes[1].mesh, leaves_, 1);
}

TEST_F(GltfWrite, PicturesMayLieInAFolderBesideIt) {
    model_.pictures_beside = true;
    for (const char* name : {"an oak.glb", "an oak.gltf"}) {
        const std::filesystem::path folder = folder_ / "an oak_textures";
        std::filesystem::remove_all(folder);
        write_gltf(path(name), model_);
        const tinygltf::Model model = read(path(name));
        expect_mesh(model, model.nodes.at(1).mesh, bark_, 0);
        expect_mesh(model, model.nodes.at(1).mesh, leaves_, 1);
        ASSERT_EQ(model.images.size(), 5u);
        for (const tinygltf::Image& image : model.images) {
            const std::string file_name = image.name + picture_ending(image.name);
            EXPECT_EQ(image.uri, "an%20oak_textures/" + file_name);
            EXPECT_EQ(image.bufferView, -1);
            std::ifstream file(folder / file_name, std::ios::binary);
            const std::string bytes{std::istreambuf_iterator<char>(file), {}};
            EXPECT_EQ(std::string(image.image.begin(), image.image.end()), bytes);
            EXPECT_EQ(bytes.starts_with("\xFF\xD8\xFF"), file_name.ends_with(".jpg")) << file_name;
            EXPECT_EQ(bytes.starts_with("\x89PNG"), file_name.ends_with(".png")) << file_name;
        }
        size_t files = 0;
        for (const auto& entry : std::filesystem::directory_iterator(folder))
            files += entry.is_regular_file();
        EXPECT_EQ(files, 5u);
        EXPECT_EQ(model.buffers.at(0).data.size(),
                  model.bufferViews.back().byteOffset + (model.bufferViews.back().byteLength + 3) / 4 * 4);
    }
    // What stands in its way is not ours to remove.
    std::ofstream(path("taken_textures")) << "mine";
    try {
        write_gltf(path("taken.glb"), model_);
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("taken_textures"), std::string::npos) << error.what();
    }
    EXPECT_FALSE(std::filesystem::exists(path("taken.glb")));
}

TEST_F(GltfWrite, ACancelledOneLeavesTheOldFile) {
    struct Stopped final : Progress {
        bool cancelled() const override { return true; }
    } stopped;
    for (const char* name : {"old.glb", "old.gltf"}) {
        std::ofstream(path(name)) << "old";
        EXPECT_THROW(write_gltf(path(name), model_, &stopped), Cancelled);
        EXPECT_EQ(std::filesystem::file_size(path(name)), 3u);
        EXPECT_FALSE(std::filesystem::exists(path(name) + ".part"));
    }
}

TEST_F(GltfWrite, LeavesOutWhatIsNotThere) {
    model_.leaves = nullptr;
    write_gltf(path("bare.glb"), model_);
    const tinygltf::Model bare = read(path("bare.glb"));
    EXPECT_EQ(bare.nodes.size(), 2u);
    EXPECT_EQ(bare.images.size(), 3u);
    const Mesh nothing;
    model_.bark = &nothing;
    for (const char* name : {"empty.glb", "empty.gltf"}) {
        write_gltf(path(name), model_);
        EXPECT_EQ(read(path(name)).nodes.size(), 1u);
    }
    model_.leaves = &leaves_;
    write_gltf(path("leaves.gltf"), model_);
    const tinygltf::Model leaves = read(path("leaves.gltf"));
    EXPECT_EQ(leaves.materials.size(), 1u);
    expect_mesh(leaves, leaves.nodes.at(1).mesh, leaves_);
}

TEST_F(GltfWrite, FailuresNameThePathAndLeaveNothing) {
    for (const std::string& wrong : {path("no folder/tree.glb"), path("tree.fbx")}) {
        try {
            write_gltf(wrong, model_);
            FAIL() << wrong;
        } catch (const Error& error) {
            EXPECT_NE(std::string(error.what()).find(wrong), std::string::npos) << error.what();
        }
        EXPECT_FALSE(std::filesystem::exists(wrong));
    }
    std::filesystem::create_directories(path("folder.glb"));
    EXPECT_THROW(write_gltf(path("folder.glb"), model_), Error);
    EXPECT_FALSE(std::filesystem::exists(path("folder.glb.tmp")));
}

}  // namespace
}  // namespace treerec
