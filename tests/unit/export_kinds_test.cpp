// Model files of trees with several kinds of leaves: a mesh and a material for each.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "edit/commands/commands.h"
#include "mesh/leaf_cards.h"
#include "pipeline/export.h"
#include "random_tree.h"
#include "tree/branches.h"

namespace treerec {
namespace {

class ExportKinds : public testing::Test {
  protected:
    ExportKinds() {
        folder_ = std::filesystem::temp_directory_path() / ("treerec kinds " + std::to_string(::getpid()));
        std::filesystem::create_directories(folder_);
        tree_ = test::random_tree(3, 600);
        const BranchList list = list_branches(tree_);
        const char* const rules[] = {"pine", "maple form=simple leaf_size=0.1", "pine droop=60", "none",
                                     "droop=70"};
        size_t next = 0;
        for (const Branch& branch : list.branches) {
            const NodeId id = list.nodes[branch.begin];
            if (branch.order != 1 || tree_.depth_first(id).size() < 6 || next == std::size(rules)) continue;
            perform(tree_, "leaves where=below:" + std::to_string(id) + " rule=\"" + rules[next++] + "\"");
        }
        EXPECT_EQ(tree_.leaf_rules().size(), std::size(rules));
    }
    ~ExportKinds() override {
        std::error_code ignored;
        std::filesystem::remove_all(folder_, ignored);
    }
    std::string path(const char* name) const { return (folder_ / name).string(); }
    std::string text_of(const char* name) const {
        std::ifstream file(path(name));
        return {std::istreambuf_iterator<char>(file), {}};
    }

    std::filesystem::path folder_;
    Tree tree_;
};

TEST_F(ExportKinds, GltfHasAMeshAndAMaterialForEach) {
    ExportOptions options;
    options.leaves = leaf_preset("oak");
    options.textures = "oak";
    options.levels = 2;
    TreeExporter exporter(tree_, options);
    exporter.write(path("tree.gltf"));
    const nlohmann::json json = nlohmann::json::parse(text_of("tree.gltf"));
    const std::vector<LeafKind> kinds = leaf_kinds(tree_, options.leaves);
    std::map<std::string, std::map<std::string, size_t>> vertices;  // by level, and the material's name
    for (const auto& mesh : json["meshes"])
        for (const auto& primitive : mesh["primitives"])
            vertices[mesh["name"]][json["materials"][primitive["material"].get<size_t>()]["name"]] =
                json["accessors"][primitive["attributes"]["POSITION"].get<size_t>()]["count"];
    ASSERT_TRUE(vertices.contains("Tree_LOD0") && vertices.contains("Tree_LOD1"));
    EXPECT_TRUE(vertices["Tree_LOD0"].contains("bark"));
    size_t leaves = 0;
    for (size_t kind = 0; kind < kinds.size(); kind++) {
        std::string suffix;
        if (kind > 0) suffix.append("_").append(std::to_string(kind + 1));
        const size_t placed = exporter.placed()[kind].size();
        leaves += placed;
        const std::string name = "leaves" + suffix;
        if (kinds[kind].text == "none") {
            EXPECT_FALSE(vertices["Tree_LOD0"].contains(name));
            continue;
        }
        ASSERT_GT(placed, 0U);
        // Every card has two sides.
        EXPECT_EQ(vertices["Tree_LOD0"][name],
                  2 * placed * build_leaf_card(kinds[kind].rules).positions.size());
        EXPECT_GT(vertices["Tree_LOD1"][name], 0U);
    }
    EXPECT_EQ(exporter.leaves(), leaves);
    // The pictures of one look are there once; changes of the tree's own show its own.
    std::map<std::string, size_t> pictures;  // by material: the image
    std::map<std::string, std::string> rules;
    for (const auto& material : json["materials"]) {
        const size_t texture = material["pbrMetallicRoughness"]["baseColorTexture"]["index"];
        pictures[material["name"]] = json["textures"][texture]["source"];
        if (material.contains("extras")) rules[material["name"]] = material["extras"]["leaf_rule"];
    }
    EXPECT_EQ(pictures.size(), 6U);
    for (size_t kind = 1; kind < kinds.size(); kind++) {
        std::string name = "leaves_";
        name += std::to_string(kind + 1);
        if (kinds[kind].text == "none") continue;
        EXPECT_EQ(rules.at(name), kinds[kind].text);
        if (kinds[kind].text == "pine droop=60") {
            EXPECT_EQ(pictures.at(name), pictures.at("leaves_2"));
        }
        if (kinds[kind].text == "droop=70") {
            EXPECT_EQ(pictures.at(name), pictures.at("leaves"));
        }
    }
    EXPECT_NE(pictures.at("leaves_2"), pictures.at("leaves"));
    EXPECT_NE(pictures.at("leaves_3"), pictures.at("leaves"));
    for (const auto& image : json["images"])
        EXPECT_TRUE(std::filesystem::exists(folder_ / image["uri"].get<std::string>())) << image["uri"];
}

TEST_F(ExportKinds, ObjHasThemToo) {
    TreeExporter(tree_, {}).write(path("tree.obj"));
    const std::string model = text_of("tree.obj"), materials = text_of("tree.mtl");
    for (const char* name : {"leaves", "leaves_2", "leaves_3", "leaves_4", "leaves_6"}) {
        const std::string line = std::string(name) + "\n";
        EXPECT_NE(model.find("usemtl " + line), std::string::npos) << name;
        EXPECT_NE(materials.find("newmtl " + line), std::string::npos) << name;
    }
    EXPECT_EQ(model.find("usemtl leaves_5"), std::string::npos) << "a bare branch has no leaves";
    for (const char* picture : {"tree_leaf_albedo.png", "tree_leaf_albedo_2.png", "tree_leaf_normal_3.png"})
        EXPECT_TRUE(std::filesystem::exists(folder_ / picture)) << picture;
    // Every index is one of a vertex.
    size_t vertices = 0, largest = 0;
    for (size_t at = 0; at < model.size(); at = model.find('\n', at) + 1) {
        if (model.compare(at, 2, "v ") == 0) vertices++;
        if (model.compare(at, 2, "f ") == 0)
            largest = std::max<size_t>(largest, std::stoul(model.substr(at + 2)));
        if (model.find('\n', at) == std::string::npos) break;
    }
    EXPECT_GE(vertices, largest);
    EXPECT_GT(largest, vertices / 2);
}

}  // namespace
}  // namespace treerec
