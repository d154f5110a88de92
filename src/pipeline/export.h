// From a tree to files of any format.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "exchange/material_textures.h"
#include "foliage/leaves.h"
#include "mesh/mesh.h"
#include "tree/tree.h"

namespace treerec {

struct ExportOptions {
    LeafRules leaves = leaf_preset("generic");
    std::string textures = "generic";  // the preset whose bark and leaf pictures are used
    uint64_t seed = 1;                 // of leaves and pictures
};

// Writes one tree to any number of files; bark, leaves and pictures are made once, when first needed. The
// tree must outlive it.
class TreeExporter {
  public:
    TreeExporter(const Tree& tree, const ExportOptions& options);

    // Writes in the format that the extension of `path` names: .glb .gltf .obj (metres, Y up, the root where
    // the tree has it; with leaves) or .ply .txt .csv (the skeleton in scan coordinates). Throws Error for
    // another extension, or if it cannot be written.
    void write(const std::string& path);

    size_t triangles();  // of bark and leaves together
    size_t leaves();

  private:
    void build();

    const Tree& tree_;
    ExportOptions options_;
    bool built_ = false;
    Mesh bark_;
    Mesh leaves_;
    size_t leaf_count_ = 0;
    std::vector<NamedPicture> pictures_;
};

// Throws Error, naming the formats, if the extension of `path` is none of those that write() knows, or if no
// file can be written there (file_bytes.h): to be asked before the long work.
void require_writable_format(const std::string& path);

// One file: TreeExporter in one call.
void export_tree(const std::string& path, const Tree& tree, const LeafRules& leaves, uint64_t seed,
                 const std::string& textures = "generic");

}  // namespace treerec
