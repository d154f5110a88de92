#include "pipeline/export.h"

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "error.h"
#include "exchange/finite.h"
#include "exchange/gltf.h"
#include "exchange/lstring_file.h"
#include "exchange/obj.h"
#include "exchange/tree_files.h"
#include "file_bytes.h"
#include "foliage/foliage_twigs.h"
#include "geometry/parallel.h"
#include "mesh/branch_tubes.h"
#include "mesh/leaf_cards.h"
#include "photos/leaf_look.h"
#include "textures/linear_light.h"

namespace treerec {

namespace {

// Metres: the radius of a trunk whose bark is young, between where the shader's blending begins and ends.
constexpr double kYoungTrunk = 0.055;

// Other programs' materials know no age: all of a tree has the bark of its trunk.
bool has_young_bark(const Tree& tree, const ExportOptions& options) {
    if (tree.empty() || !options.bark.empty()) return false;
    const double dbh = measure(tree).dbh;
    return (dbh > 0.0 ? 0.5 * dbh : tree.node(tree.root()).radius) < kYoungTrunk;
}

void refine_repeats(Mesh& bark) {
    for (Vec2& uv : bark.uvs)
        uv /= static_cast<float>(kYoungScale);
}

enum class Format { kGltf, kObj, kPly, kTreefile, kCsv, kMtg, kLString, kUnknown };

// Where a coarser level takes over, in heights of the tree: as in nodes/tree_levels.gd.
constexpr double kSwitch[kMostLevels - 1] = {2.5, 6.0, 14.0, 30.0};
constexpr double kShade = 0.7;              // of stored colours, deep in the crown
constexpr size_t kMostFoldedCards = 20000;  // more leaves than this are flat cards

Format format_of(const std::string& path) {
    const std::string extension = extension_of(path);
    if (extension == "glb" || extension == "gltf") return Format::kGltf;
    if (extension == "obj") return Format::kObj;
    if (extension == "ply") return Format::kPly;
    if (extension == "txt") return Format::kTreefile;
    if (extension == "csv") return Format::kCsv;
    if (extension == "mtg") return Format::kMtg;
    if (extension == "lstring") return Format::kLString;
    return Format::kUnknown;
}

// Whether the model at `path` is there and was written by this program: with it, what lies beside it was.
bool is_own_model(const std::string& path, std::string_view mark) {
    std::ifstream stream(path_of(path), std::ios::binary);
    std::string begin(4096, '\0');
    stream.read(begin.data(), static_cast<std::streamsize>(begin.size()));
    begin.resize(static_cast<size_t>(stream.gcount()));
    return begin.find(mark) != std::string::npos;
}

// The course over its peak, and shade: other programs know nothing of the light in a crown.
LeafTint leaf_tint(const LeafColours& colours) {
    return [colours](const Vec3& place, float openness) {
        const double shade = linear_of(kShade + (1.0 - kShade) * static_cast<double>(openness));
        return Vec3(shade * course_at(colours, static_cast<double>(place.y)) / course_peak(colours));
    };
}

// A model of several files names all but one of them itself: none of these may be somebody else's.
void require_own_companions(const std::string& path, Format format) {
    const std::string extension = extension_of(path);
    const bool in_parts = format == Format::kObj || extension == "gltf";
    if (!in_parts) return;
    const std::string stem = stem_of(path);
    if (is_own_model(sibling_of(path, stem + ".gltf"), "(treerec)") ||
        is_own_model(sibling_of(path, stem + ".obj"), "# Metres, Y up."))
        return;
    std::vector<std::string> names{stem + (format == Format::kObj ? ".mtl" : ".bin")};
    for (const std::string& picture : picture_names())
        names.push_back(stem + "_" + picture + picture_ending(picture));
    // Of further kinds of leaves, however many the tree has.
    for (size_t kind = 2; kind <= kMostLeafRules + 1; kind++)
        for (const char* picture : {"_leaf_albedo_", "_leaf_normal_"})
            names.push_back(stem + picture + std::to_string(kind) + ".png");
    for (const std::string& name : names) {
        std::error_code failure;
        const std::string companion = sibling_of(path, name);
        if (std::filesystem::exists(path_of(companion), failure))
            throw Error("'" + companion + "', which '" + path +
                        "' needs for itself, is there already and no output of this program; it was left as "
                        "it is. Give the model another name, or move that file.");
    }
}

}  // namespace

void require_writable_format(const std::string& path) {
    if (format_of(path) == Format::kUnknown)
        throw Error(
            "'" + path +
            "' names no format that can be written; end it in .glb, .gltf or .obj (the tree with bark and "
            "leaves), or .ply, .txt, .csv, .mtg or .lstring (its skeleton).");
    require_writable(path);
    require_own_companions(path, format_of(path));
}

TreeExporter::TreeExporter(const Tree& tree, const ExportOptions& options, const Progress* progress)
    : tree_(tree),
      options_(options),
      progress_(progress),
      kinds_(leaf_kinds(tree, options.leaves)),
      young_(has_young_bark(tree, options)) {
    // "none" has leaf rules, but no look.
    if (options_.levels < 1 || options_.levels > kMostLevels)
        throw Error("A model has 1 to " + std::to_string(kMostLevels) + " levels of detail, not " +
                    std::to_string(options_.levels) + ".");
    if (!leaf_preset(options_.textures).enabled) options_.textures = ExportOptions().textures;
}

const Mesh& TreeExporter::bark() {
    if (!bark_) {
        TubeOptions tubes;
        tubes.pivots = false;
        tubes.whole_repeats = true;
        tubes.grown = options_.grown;
        bark_ = build_branch_tubes(leafy_tree(tree_, kinds_, options_.foliage), tubes, progress_);
        if (young_) refine_repeats(*bark_);
    }
    return *bark_;
}

const std::vector<std::vector<LeafPlacement>>& TreeExporter::placed() {
    if (!placed_) placed_ = place_foliage(tree_, kinds_, options_.seed, options_.foliage);
    return *placed_;
}

const std::vector<Mesh>& TreeExporter::leaf_cards() {
    if (!leaf_cards_) {
        std::vector<Mesh> cards;
        for (size_t kind = 0; kind < kinds_.size(); kind++)
            cards.push_back(bake_leaves(placed()[kind], build_leaf_card(kinds_[kind].rules, card_level(kind)),
                                        progress_));
        leaf_cards_ = std::move(cards);
    }
    return *leaf_cards_;
}

const Measurements& TreeExporter::measured() {
    if (!measured_) measured_ = measure(tree_);
    return *measured_;
}

void TreeExporter::prepare(const std::vector<std::string>& paths) {
    if (tree_.empty() || std::none_of(paths.begin(), paths.end(), [](const std::string& path) {
            const Format format = format_of(path);
            return format == Format::kGltf || format == Format::kObj;
        }))
        return;
    // Each has stretches that keep one core busy alone.
    parallel_for(3, 1, [&](size_t part, size_t) {
        if (part == 0) bark();
        if (part == 1) leaf_cards();
        if (part == 2) measured();
    });
}

const std::vector<TreeExporter::Coarser>& TreeExporter::coarser() {
    if (!coarser_.empty() || options_.levels == 1) return coarser_;
    const Tree leafy = leafy_tree(tree_, kinds_, options_.foliage);
    for (int level = 1; level < options_.levels; level++) {
        TubeOptions tubes;
        tubes.pivots = false;
        tubes.level = level;
        GrownBark lighter;
        tubes.grown = bark_of_level(options_.grown, level, lighter);
        Coarser made{build_branch_tubes(leafy, tubes, progress_), {}};
        if (young_) refine_repeats(made.bark);
        for (size_t kind = 0; kind < kinds_.size(); kind++) {
            // The finest level may have flat cards already.
            const Mesh card = build_leaf_card(kinds_[kind].rules, std::max(level, card_level(kind)));
            made.leaves.push_back(bake_leaves(thin_leaves(placed()[kind], level), card, progress_));
        }
        coarser_.push_back(std::move(made));
    }
    return coarser_;
}

size_t TreeExporter::triangles() {
    size_t count = bark().triangle_count();
    for (size_t kind = 0; kind < kinds_.size(); kind++)
        count += 2 * placed()[kind].size() *
                 build_leaf_card(kinds_[kind].rules, card_level(kind)).triangle_count();
    return count;
}

int TreeExporter::card_level(size_t kind) {
    return placed()[kind].size() > kMostFoldedCards ? 1 : 0;
}

size_t TreeExporter::leaves() {
    size_t count = 0;
    for (const std::vector<LeafPlacement>& kind : placed())
        count += kind.size();
    return count;
}

std::string TreeExporter::look_of(size_t kind) const {
    return kinds_[kind].look.empty() ? options_.textures : kinds_[kind].look;
}

std::vector<NamedPicture> TreeExporter::pictures_for(size_t kind) const {
    std::vector<NamedPicture> pictures =
        pictures_of_model(make_pictures(look_of(kind)), uses_blade_picture(kinds_[kind].rules), young_);
    // The bark is the tree's own.
    if (kind > 0)
        std::erase_if(pictures, [](const NamedPicture& picture) { return picture.name.starts_with("bark"); });
    for (NamedPicture& picture : pictures)
        for (const NamedPicture& own : options_.bark)
            if (own.name == picture.name) picture = own;
    if (recoloured(kind)) recolour_leaves(pictures, uses_blade_picture(kinds_[kind].rules));
    return pictures;
}

bool TreeExporter::recoloured(size_t kind) const {
    return options_.leaf_colours && options_.leaf_colours->seen() && look_of(kind) == look_of(0);
}

// So much lighter that the tints' factors, which glTF wants to be 0..1, bring them to the measured mean.
void TreeExporter::recolour_leaves(std::vector<NamedPicture>& pictures, bool blade) const {
    const LeafColours& colours = *options_.leaf_colours;
    Image albedo = (blade ? make_blade_textures(options_.textures, kTextureSize / 2, kTextureSeed)
                          : make_leaf_textures(options_.textures, kTextureSize, kTextureSeed))
                       .albedo;
    recolour(albedo, colours.albedo * course_peak(colours));
    auto png = std::make_shared<const std::vector<uint8_t>>(encode_png(albedo));
    for (NamedPicture& picture : pictures)
        if (picture.name == "leaf_albedo")
            picture = {picture.name, {reinterpret_cast<const char*>(png->data()), png->size()}, png};
}

void TreeExporter::write(const std::string& path) {
    if (tree_.empty()) throw Error("The tree is empty; there is nothing to write to '" + path + "'.");
    require_sound_measures(tree_, path);
    const Format format = format_of(path);
    switch (format) {
        case Format::kPly:
            return write_skeleton_ply(path, tree_);
        case Format::kTreefile:
            return write_treefile(path, tree_, options_.foliage);
        case Format::kCsv:
            return write_qsm_csv(path, tree_);
        case Format::kMtg:
            return write_mtg(path, tree_);
        case Format::kLString:
            return write_lstring_file(path, tree_, {}, progress_);
        case Format::kUnknown:
            return require_writable_format(path);
        case Format::kGltf:
        case Format::kObj:
            break;
    }
    prepare({path});
    if (bark().indices.empty())
        throw Error("'" + path + "' was not written: the tree has no wood that could be drawn.");
    if (pictures_.empty())
        for (size_t kind = 0; kind < kinds_.size(); kind++)
            // Other kinds than the tree's own may have lost their wood.
            pictures_.push_back(kind == 0 || !placed()[kind].empty() ? pictures_for(kind)
                                                                     : std::vector<NamedPicture>());
    const auto others = [](const std::vector<Mesh>& leaves) {
        std::vector<const Mesh*> meshes;
        for (size_t kind = 1; kind < leaves.size(); kind++)
            meshes.push_back(&leaves[kind]);
        return meshes;
    };
    ModelFile model;
    model.bark = &bark();
    model.leaves = &leaf_cards()[0];
    model.other_leaves = others(leaf_cards());
    if (format == Format::kGltf) {
        for (const Coarser& level : coarser())
            model.coarser.push_back(
                {&level.bark, &level.leaves[0], kSwitch[model.coarser.size()], others(level.leaves)});
    }
    model.preset = options_.textures;
    model.pictures_beside = options_.pictures_beside;
    model.pictures = pictures_[0];
    const auto tint_of = [&](size_t kind) {
        return recoloured(kind) ? leaf_tint(*options_.leaf_colours) : LeafTint();
    };
    model.leaf_tint = tint_of(0);
    for (size_t kind = 1; kind < kinds_.size(); kind++)
        model.other_materials.push_back({kinds_[kind].text, pictures_[kind], tint_of(kind)});
    model.extras = {{"height_m", measured().height},
                    {"dbh_m", measured().dbh},
                    {"nodes", static_cast<double>(measured().nodes)},
                    {"seed", static_cast<double>(options_.seed)}};
    if (format == Format::kGltf)
        write_gltf(path, model, progress_);
    else
        write_obj(path, model, progress_);
}

void export_tree(const std::string& path, const Tree& tree, const LeafRules& leaves, uint64_t seed,
                 const std::string& textures, const Progress* progress, const Foliage& foliage, int levels,
                 bool pictures_beside, const GrownBark* grown) {
    ExportOptions options{leaves, textures, seed, foliage, levels, pictures_beside};
    options.grown = grown;
    TreeExporter(tree, options, progress).write(path);
}

}  // namespace treerec
