// From a tree to files of any format.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "exchange/material_textures.h"
#include "foliage/leaves.h"
#include "mesh/grown_bark.h"
#include "mesh/levels.h"
#include "mesh/mesh.h"
#include "photos/leaf_colours.h"
#include "progress.h"
#include "tree/measure.h"
#include "tree/tree.h"

namespace treerec {

struct ExportOptions {
    LeafRules leaves = leaf_preset("generic");  // the tree's own; others are Tree::leaf_rules()
    std::string textures = "generic";  // the preset whose bark and leaf pictures are used; "none" means these
    uint64_t seed = 1;                 // of the leaves
    Foliage foliage = {};              // what the scan saw of them
    int levels = 1;                    // of detail in .glb and .gltf files, 1..kMostLevels
    bool pictures_beside = false;      // of a .glb: in a folder, as those of a .gltf are
    // The tree's own bark (encode_bark()), instead of the preset's.
    std::vector<NamedPicture> bark = {};
    // Of the leaves that have no look of their own, instead of the preset's; passed over where not seen().
    std::optional<LeafColours> leaf_colours = {};
    // Bark that was grown on the tree; null: tubes alone. It must outlive the exporter.
    const GrownBark* grown = nullptr;
};

// Writes one tree to any number of files; bark, leaves and pictures are made once, when first needed. The
// tree and the progress must outlive it; every method may throw Cancelled.
class TreeExporter {
  public:
    TreeExporter(const Tree& tree, const ExportOptions& options, const Progress* progress = nullptr);

    // Makes all that write() needs for the files at these paths, but the coarser levels.
    void prepare(const std::vector<std::string>& paths);

    // Writes in the format that the extension of `path` names: .glb .gltf .obj (metres, Y up, the root where
    // the tree has it; with leaves) or .ply .txt .csv .mtg .lstring (the skeleton in scan coordinates).
    // Throws Error for another extension, or if it cannot be written.
    void write(const std::string& path);

    size_t triangles();  // of bark and leaves together, of the finest level
    size_t leaves();
    // By kind (leaf_kinds()).
    const std::vector<std::vector<LeafPlacement>>& placed();
    const Measurements& measured();  // of the tree

    const Mesh& bark();  // of the finest level

  private:
    const std::vector<Mesh>& leaf_cards();  // by kind
    int card_level(size_t kind);
    std::string look_of(size_t kind) const;
    std::vector<NamedPicture> pictures_for(size_t kind) const;
    bool recoloured(size_t kind) const;
    void recolour_leaves(std::vector<NamedPicture>& pictures, bool blade) const;
    struct Coarser {
        Mesh bark;
        std::vector<Mesh> leaves;
    };
    const std::vector<Coarser>& coarser();

    const Tree& tree_;
    ExportOptions options_;
    const Progress* progress_;
    const std::vector<LeafKind> kinds_;
    const bool young_;  // the bark
    std::optional<Mesh> bark_;
    std::optional<std::vector<std::vector<LeafPlacement>>> placed_;
    std::optional<std::vector<Mesh>> leaf_cards_;
    std::optional<Measurements> measured_;
    std::vector<Coarser> coarser_;
    std::vector<std::vector<NamedPicture>> pictures_;  // by kind
};

// Throws Error, naming the formats, if the extension of `path` is none of those that write() knows, or if no
// file can be written there (file_bytes.h): to be asked before the long work.
void require_writable_format(const std::string& path);

// One file: TreeExporter in one call.
void export_tree(const std::string& path, const Tree& tree, const LeafRules& leaves, uint64_t seed,
                 const std::string& textures = "generic", const Progress* progress = nullptr,
                 const Foliage& foliage = {}, int levels = 1, bool pictures_beside = false,
                 const GrownBark* grown = nullptr);

}  // namespace treerec
