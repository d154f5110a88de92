#include "tree_reconstruction/tree_reconstruction.h"

#include <algorithm>
#include <cmath>
#include <godot_cpp/variant/packed_color_array.hpp>
#include <godot_cpp/variant/packed_float64_array.hpp>
#include <godot_cpp/variant/packed_string_array.hpp>
#include <godot_cpp/variant/typed_array.hpp>
#include <utility>

#include "convert.h"
#include "error.h"
#include "foliage/foliage_twigs.h"
#include "mesh/leaf_cards.h"
#include "mesh/levels.h"
#include "tree/measure.h"
#include "tree_reconstruction/node_arrays.h"
#include "wind_globals.h"

using namespace godot;
using treerec::NodeId;
using treerec::Tree;

void TreeReconstruction::set_tree(Tree p_tree) {
    const auto tree = std::make_shared<const Tree>(std::move(p_tree));
    parts_.replace([&](SharedParts::Parts& r_parts) { r_parts.tree = tree; });
    replace(newer_skeleton_, Dictionary());
    emit_changed();
}

std::shared_ptr<const Tree> TreeReconstruction::get_tree() const {
    return parts_.get().tree;
}

int64_t TreeReconstruction::get_bark_revision() const {
    const SharedParts::Parts parts = parts_.get();
    std::vector<bool> followed = guarded(std::vector<bool>(), [&] {
        std::vector<bool> told;
        const std::vector<treerec::LeafKind> kinds = make_leaf_kinds(*parts.tree);
        for (const treerec::LeafKind& kind : kinds) {
            told.push_back(treerec::follows(kind.rules, *parts.foliage));
        }
        told.push_back(treerec::hide_twigs(kinds));
        return told;
    });
    return bark_revision_.count(parts, std::move(followed));
}

void TreeReconstruction::set_skeleton(const Dictionary& p_skeleton) {
    Tree tree;
    Dictionary newer;
    const Variant version = p_skeleton.get("format_version", 0);
    if (p_skeleton.is_empty()) {
        // The default: no tree.
    } else if (version.get_type() != Variant::INT || int64_t(version) < 1) {
        ERR_PRINT(
            "The saved tree is damaged: it doesn't say its format version. Reconstruct the tree again.");
    } else if (int64_t(version) > FORMAT_VERSION) {
        newer = p_skeleton;
        ERR_PRINT(
            vformat("This tree was saved by a newer version of the addon (format %d; this one reads up to "
                    "%d). Update the "
                    "addon to open it.",
                    version, int(FORMAT_VERSION)));
    } else {
        tree = guarded(Tree(), [&] { return tree_from_dictionary(p_skeleton); });
    }
    set_tree(std::move(tree));
    newer_skeleton_ = newer;
}

Dictionary TreeReconstruction::get_skeleton() const {
    if (!newer_skeleton_.is_empty()) {
        return newer_skeleton_;
    }
    const std::shared_ptr<const Tree> tree = get_tree();
    if (tree->empty()) {
        return Dictionary();
    }
    // The oldest version that reads all that there is: leaf rules came with the second, sections with the
    // third.
    const std::vector<NodeId> ids = tree->depth_first();
    const bool measured =
        std::any_of(ids.begin(), ids.end(), [&](NodeId p_id) { return tree->node(p_id).section > 0; });
    return to_dictionary(*tree, measured ? int(FORMAT_VERSION) : tree->leaf_rules().empty() ? 1 : 2);
}

// Until version 2 of the report, "delaunay" was the name of what is "geodesic" now.
static Dictionary with_words_of_today(const Dictionary& p_provenance) {
    constexpr int64_t RENAMED_SINCE = 2;
    const Variant options = p_provenance.get("options", Dictionary());
    const Variant report = p_provenance.get("report", Dictionary());
    if (options.get_type() != Variant::DICTIONARY ||
        Dictionary(options).get("skeleton", String()) != Variant("delaunay")) {
        return p_provenance;
    }
    if (report.get_type() == Variant::DICTIONARY &&
        int64_t(Dictionary(report).get("format_version", 1)) >= RENAMED_SINCE) {
        return p_provenance;
    }
    Dictionary renamed = Dictionary(options).duplicate();
    renamed["skeleton"] = "geodesic";
    Dictionary provenance = p_provenance.duplicate();
    provenance["options"] = renamed;
    return provenance;
}

void TreeReconstruction::set_provenance(const Dictionary& p_provenance) {
    replace(provenance_, with_words_of_today(p_provenance));
    emit_changed();
}

bool TreeReconstruction::is_empty() const {
    return get_tree()->empty();
}

int64_t TreeReconstruction::get_node_count() const {
    return int64_t(get_tree()->size());
}

int TreeReconstruction::get_root() const {
    return get_tree()->root();
}

bool TreeReconstruction::has_node(int64_t p_id) const {
    return holds_node(*get_tree(), p_id);
}

std::optional<treerec::Node> TreeReconstruction::_find_node(int64_t p_id) const {
    const std::shared_ptr<const Tree> tree = get_tree();
    ERR_FAIL_COND_V_MSG(!holds_node(*tree, p_id), std::nullopt, vformat("The tree has no node %d.", p_id));
    return tree->node(NodeId(p_id));
}

Vector3 TreeReconstruction::get_node_position(int64_t p_id) const {
    const std::optional<treerec::Node> node = _find_node(p_id);
    return node ? to_godot(node->position) : Vector3();
}

PackedFloat64Array TreeReconstruction::get_node_scan_position(int64_t p_id) const {
    const std::optional<treerec::Node> node = _find_node(p_id);
    if (!node) {
        return PackedFloat64Array();
    }
    const treerec::DVec3 scan = get_tree()->frame().to_scan(node->position);
    return PackedFloat64Array{scan.x, scan.y, scan.z};
}

Vector3 TreeReconstruction::get_position_in_tree(const PackedFloat64Array& p_scan_position) const {
    ERR_FAIL_COND_V_MSG(p_scan_position.size() != 3, Vector3(), "A place in a scan has three coordinates.");
    return to_godot(
        get_tree()->frame().to_tree({p_scan_position[0], p_scan_position[1], p_scan_position[2]}));
}

double TreeReconstruction::get_node_radius(int64_t p_id) const {
    const std::optional<treerec::Node> node = _find_node(p_id);
    return node ? node->radius : 0.0;
}

int TreeReconstruction::get_node_parent(int64_t p_id) const {
    const std::optional<treerec::Node> node = _find_node(p_id);
    return node ? node->parent : treerec::kNoNode;
}

PackedInt32Array TreeReconstruction::get_node_children(int64_t p_id) const {
    const std::shared_ptr<const Tree> tree = get_tree();
    ERR_FAIL_COND_V_MSG(!holds_node(*tree, p_id), PackedInt32Array(),
                        vformat("The tree has no node %d.", p_id));
    std::vector<NodeId> ids;
    for (const NodeId id : tree->children(NodeId(p_id))) {
        ids.push_back(id);
    }
    return to_godot(ids);
}

TreeReconstruction::NodeKind TreeReconstruction::get_node_kind(int64_t p_id) const {
    const std::optional<treerec::Node> node = _find_node(p_id);
    return node ? NodeKind(node->kind()) : NODE_KIND_COMMON;
}

int TreeReconstruction::get_node_depth(int64_t p_id) const {
    const std::optional<treerec::Node> node = _find_node(p_id);
    return node ? node->depth : 0;
}

bool TreeReconstruction::is_trunk(int64_t p_id) const {
    const std::optional<treerec::Node> node = _find_node(p_id);
    return node && node->is_trunk();
}

bool TreeReconstruction::is_radius_measured(int64_t p_id) const {
    const std::optional<treerec::Node> node = _find_node(p_id);
    return node && node->is_measured();
}

bool TreeReconstruction::is_guess(int64_t p_id) const {
    const std::optional<treerec::Node> node = _find_node(p_id);
    return node && node->is_guess();
}

PackedInt32Array TreeReconstruction::get_node_ids() const {
    return to_godot(node_arrays::list_nodes(*get_tree()));
}

PackedInt32Array TreeReconstruction::_nodes_of_kind(treerec::NodeKind p_kind) const {
    return to_godot(get_tree()->nodes_of_kind(p_kind));
}

PackedInt32Array TreeReconstruction::get_leaves() const {
    return _nodes_of_kind(treerec::NodeKind::kLeaf);
}

PackedInt32Array TreeReconstruction::get_branch_nodes() const {
    return _nodes_of_kind(treerec::NodeKind::kBranch);
}

PackedInt32Array TreeReconstruction::get_trunk_nodes() const {
    return node_arrays::trunk(*get_tree());
}

PackedVector3Array TreeReconstruction::get_positions() const {
    return node_arrays::positions(*get_tree());
}

PackedFloat32Array TreeReconstruction::get_radii() const {
    return node_arrays::radii(*get_tree());
}

PackedInt32Array TreeReconstruction::get_parents() const {
    return node_arrays::parents(*get_tree());
}

AABB TreeReconstruction::get_aabb() const {
    return node_arrays::box(*get_tree());
}

Dictionary TreeReconstruction::measure() const {
    return guarded(Dictionary(), [&] {
        const treerec::Measurements measured = treerec::measure(*get_tree());
        TypedArray<Dictionary> orders;
        for (const treerec::OrderMeasure& order : measured.by_order) {
            Dictionary entry;
            entry["branches"] = int64_t(order.branches);
            entry["length"] = order.length;
            orders.push_back(entry);
        }
        Dictionary result;
        result["nodes"] = int64_t(measured.nodes);
        result["tips"] = int64_t(measured.tips);
        result["height"] = measured.height;
        result["dbh"] = measured.dbh;
        result["stems"] = measured.stems;
        result["crown_radius"] = measured.crown_radius;
        result["crown_base"] = measured.crown_base;
        result["total_length"] = measured.total_length;
        result["volume"] = measured.volume;
        result["measured_share"] = measured.measured_share;
        result["orders"] = orders;
        return result;
    });
}

Array TreeReconstruction::build_mesh_arrays(int p_lod, bool p_whole_repeats, bool p_leaves,
                                            int64_t p_leaf_triangles) const {
    ERR_FAIL_COND_V_MSG(p_lod < 0, Array(),
                        vformat("There is no level of detail %d; 0 is the finest.", p_lod));
    return guarded(Array(), [&] {
        const std::shared_ptr<const Tree> tree = get_tree();
        const std::shared_ptr<const treerec::GrownBark> bark = get_bark_on(tree);
        const std::vector<treerec::LeafKind> kinds = make_leaf_kinds(*tree);
        treerec::LevelBark how{.whole_repeats = p_whole_repeats, .grown = bark.get()};
        if (p_leaves) {
            how.hidden = treerec::hide_twigs(kinds);
            how.leaves =
                p_leaf_triangles < 0 ? _count_leaf_triangles(*tree, kinds, p_lod) : size_t(p_leaf_triangles);
        }
        return to_surface_arrays(
            treerec::build_level_bark(treerec::leafy_tree(*tree, kinds, *get_leaf_density()), p_lod, how));
    });
}

Ref<ArrayMesh> TreeReconstruction::build_mesh(int p_lod) const {
    Ref<ArrayMesh> mesh;
    mesh.instantiate();
    const Array arrays = build_mesh_arrays(p_lod);
    if (!arrays.is_empty()) {
        mesh->add_surface_from_arrays(Mesh::PRIMITIVE_TRIANGLES, arrays, TypedArray<Array>(), Dictionary(),
                                      kSurfaceFlags);
    }
    return mesh;
}

PackedFloat32Array TreeReconstruction::build_leaf_buffer(int p_lod) const {
    ERR_FAIL_COND_V_MSG(p_lod < 0, PackedFloat32Array(),
                        vformat("There is no level of detail %d; 0 is the finest.", p_lod));
    return guarded(PackedFloat32Array(),
                   [&] { return to_godot(treerec::leaf_buffer(_place_leaves(p_lod))); });
}

Ref<MultiMesh> TreeReconstruction::build_leaves(int p_lod) const {
    constexpr int64_t kFloatsPerLeaf = 20;
    const PackedFloat32Array buffer = build_leaf_buffer(p_lod);
    Ref<ArrayMesh> card;
    card.instantiate();
    const Array arrays = build_leaf_form_arrays(p_lod);
    if (!arrays.is_empty()) {
        card->add_surface_from_arrays(Mesh::PRIMITIVE_TRIANGLES, arrays);
    }
    Ref<MultiMesh> leaves;
    leaves.instantiate();
    leaves->set_transform_format(MultiMesh::TRANSFORM_3D);
    leaves->set_use_colors(true);
    leaves->set_use_custom_data(true);
    leaves->set_mesh(card);
    leaves->set_instance_count(int32_t(buffer.size() / kFloatsPerLeaf));
    if (!buffer.is_empty()) {
        leaves->set_buffer(buffer);
    }
    return leaves;
}

Array TreeReconstruction::build_leaf_card_arrays(int p_lod) {
    ERR_FAIL_COND_V_MSG(p_lod < 0, Array(),
                        vformat("There is no level of detail %d; 0 is the finest.", p_lod));
    return guarded(Array(), [&] { return to_surface_arrays(treerec::build_leaf_card(p_lod)); });
}

Dictionary TreeReconstruction::get_wind_globals() {
    return ::get_wind_globals();
}

PackedStringArray TreeReconstruction::get_leaf_preset_names() {
    PackedStringArray names;
    for (const std::string& name : treerec::leaf_preset_names()) {
        names.push_back(to_godot(name));
    }
    return names;
}

Array TreeReconstruction::build_skeleton_lines() const {
    return node_arrays::lines(*get_tree());
}
