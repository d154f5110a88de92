#include "pipeline/export.h"

#include "error.h"
#include "exchange/gltf.h"
#include "exchange/obj.h"
#include "exchange/tree_files.h"
#include "file_bytes.h"
#include "mesh/branch_tubes.h"
#include "mesh/leaf_cards.h"
#include "tree/measure.h"

namespace treerec {

namespace {

enum class Format { kGltf, kObj, kPly, kTreefile, kCsv, kUnknown };

Format format_of(const std::string& path) {
    const std::string extension = extension_of(path);
    if (extension == "glb" || extension == "gltf") return Format::kGltf;
    if (extension == "obj") return Format::kObj;
    if (extension == "ply") return Format::kPly;
    if (extension == "txt") return Format::kTreefile;
    if (extension == "csv") return Format::kCsv;
    return Format::kUnknown;
}

}  // namespace

void require_writable_format(const std::string& path) {
    if (format_of(path) == Format::kUnknown)
        throw Error(
            "'" + path +
            "' names no format that can be written; end it in .glb, .gltf or .obj (the tree with bark and "
            "leaves), or .ply, .txt or .csv (its skeleton).");
    require_writable(path);
}

TreeExporter::TreeExporter(const Tree& tree, const ExportOptions& options) : tree_(tree), options_(options) {}

void TreeExporter::build() {
    if (built_) return;
    bark_ = build_branch_tubes(tree_);
    if (options_.leaves.enabled) {
        const std::vector<LeafPlacement> placed = place_leaves(tree_, options_.leaves, options_.seed);
        leaf_count_ = placed.size();
        leaves_ = bake_leaves(placed);
    }
    built_ = true;
}

size_t TreeExporter::triangles() {
    build();
    return bark_.triangle_count() + leaves_.triangle_count();
}

size_t TreeExporter::leaves() {
    build();
    return leaf_count_;
}

void TreeExporter::write(const std::string& path) {
    if (tree_.empty()) throw Error("The tree is empty; there is nothing to write to '" + path + "'.");
    const Format format = format_of(path);
    switch (format) {
        case Format::kPly:
            return write_skeleton_ply(path, tree_);
        case Format::kTreefile:
            return write_treefile(path, tree_);
        case Format::kCsv:
            return write_qsm_csv(path, tree_);
        case Format::kUnknown:
            return require_writable_format(path);
        case Format::kGltf:
        case Format::kObj:
            break;
    }
    build();
    if (pictures_.empty()) pictures_ = make_pictures(options_.textures, kTextureSize, options_.seed);
    const Measurements measured = measure(tree_);
    ModelFile model;
    model.bark = &bark_;
    model.leaves = &leaves_;
    model.preset = options_.textures;
    model.texture_seed = options_.seed;
    model.pictures = pictures_;
    model.extras = {{"height_m", measured.height},
                    {"dbh_m", measured.dbh},
                    {"nodes", static_cast<double>(measured.nodes)},
                    {"seed", static_cast<double>(options_.seed)}};
    if (format == Format::kGltf)
        write_gltf(path, model);
    else
        write_obj(path, model);
}

void export_tree(const std::string& path, const Tree& tree, const LeafRules& leaves, uint64_t seed,
                 const std::string& textures) {
    TreeExporter(tree, {leaves, textures, seed}).write(path);
}

}  // namespace treerec
