// The stored rules of TreeReconstruction, and everything that it shows to the engine.
#include <algorithm>
#include <cmath>
#include <godot_cpp/variant/packed_string_array.hpp>
#include <iterator>

#include "convert.h"
#include "error.h"
#include "tree_edit.h"
#include "tree_reconstruction/tree_reconstruction.h"

using namespace godot;

constexpr int kMostLeaves = 2000000;

void TreeReconstruction::set_seed(int64_t p_seed) {
    leaf_settings_.change([&](LeafSetting& r_setting) { r_setting.seed = p_seed; });
    emit_changed();
}

int64_t TreeReconstruction::get_seed() const {
    return leaf_settings_.get().seed;
}

void TreeReconstruction::set_leaf_preset(const String& p_name) {
    bool known = true;
    const treerec::LeafRules rules = guarded(treerec::LeafRules(), [&] {
        known = false;
        const treerec::LeafRules preset = treerec::leaf_preset(to_std(p_name));
        known = true;
        return preset;
    });
    if (!known) {
        return;
    }
    leaf_settings_.change([&](LeafSetting& r_setting) {
        r_setting.preset = p_name;
        r_setting.rules = rules;
    });
    notify_property_list_changed();
    emit_changed();
}

String TreeReconstruction::get_leaf_preset() const {
    return leaf_settings_.get().preset;
}

void TreeReconstruction::set_leaves_enabled(bool p_enabled) {
    leaf_settings_.change([&](LeafSetting& r_setting) { r_setting.rules.enabled = p_enabled; });
    emit_changed();
}

bool TreeReconstruction::are_leaves_enabled() const {
    return leaf_settings_.get().rules.enabled;
}

void TreeReconstruction::set_leaf_arrangement(LeafArrangement p_arrangement) {
    ERR_FAIL_INDEX_MSG(int(p_arrangement), 2, "Leaves stand alternate (0) or opposite (1).");
    leaf_settings_.change([&](LeafSetting& r_setting) {
        r_setting.rules.arrangement = p_arrangement == LEAF_ARRANGEMENT_OPPOSITE
                                          ? treerec::LeafArrangement::kDecussate
                                          : treerec::LeafArrangement::kSpiral;
    });
    emit_changed();
}

TreeReconstruction::LeafArrangement TreeReconstruction::get_leaf_arrangement() const {
    const treerec::LeafRules rules = leaf_settings_.get().rules;
    // Bunches follow one another as single leaves do.
    const bool bunches = rules.arrangement == treerec::LeafArrangement::kFascicled;
    return treerec::leaves_per_node(rules) > 1 && !bunches ? LEAF_ARRANGEMENT_OPPOSITE
                                                           : LEAF_ARRANGEMENT_ALTERNATE;
}

void TreeReconstruction::set_leaf_value(int p_index, double p_value) {
    ERR_FAIL_INDEX(p_index, int(std::size(LeafSettings::kValues)));
    const LeafSettings::Value& value = LeafSettings::kValues[p_index];
    ERR_FAIL_COND_MSG(!std::isfinite(p_value), vformat("%s must be a finite number.", value.property));
    leaf_settings_.change([&](LeafSetting& r_setting) {
        r_setting.rules.*value.member = std::min(std::max(p_value, value.minimum), value.maximum);
    });
    emit_changed();
}

double TreeReconstruction::get_leaf_value(int p_index) const {
    ERR_FAIL_INDEX_V(p_index, int(std::size(LeafSettings::kValues)), 0.0);
    return leaf_settings_.get().rules.*LeafSettings::kValues[p_index].member;
}

void TreeReconstruction::set_maximum_leaves(int p_count) {
    leaf_settings_.change([&](LeafSetting& r_setting) {
        r_setting.rules.maximum_leaves = std::min(std::max(p_count, 0), kMostLeaves);
    });
    emit_changed();
}

int TreeReconstruction::get_maximum_leaves() const {
    return leaf_settings_.get().rules.maximum_leaves;
}

void TreeReconstruction::_validate_property(PropertyInfo& p_property) const {
    if (p_property.name == StringName("leaf_preset")) {
        p_property.hint = PROPERTY_HINT_ENUM;
        p_property.hint_string = String(",").join(get_leaf_preset_names());
    }
    // A rule stands in for all of these.
    const String name = p_property.name;
    if (get_leaf_rule().is_valid() &&
        (name == "maximum_leaves" || name == "leaves_enabled" || name == "foliage_followed" ||
         (name.begins_with("leaf_") && name != "leaf_rule"))) {
        p_property.usage = PROPERTY_USAGE_STORAGE;
    }
}

PackedStringArray TreeReconstruction::_get_linked_undo_properties(const StringName& p_property,
                                                                  const Variant&) const {
    PackedStringArray linked;
    if (p_property == StringName("leaf_preset")) {
        for (const char* property : {"leaves_enabled", "leaf_arrangement", "maximum_leaves"}) {
            linked.push_back(property);
        }
        for (const LeafSettings::Value& value : LeafSettings::kValues) {
            linked.push_back(value.property);
        }
    }
    return linked;
}

void TreeReconstruction::_bind_properties() {
    ClassDB::bind_method(D_METHOD("set_skeleton", "skeleton"), &TreeReconstruction::set_skeleton);
    ClassDB::bind_method(D_METHOD("get_skeleton"), &TreeReconstruction::get_skeleton);
    ClassDB::bind_method(D_METHOD("set_foliage", "foliage"), &TreeReconstruction::set_foliage);
    ClassDB::bind_method(D_METHOD("get_foliage"), &TreeReconstruction::get_foliage);
    ClassDB::bind_method(D_METHOD("set_foliage_followed", "followed"),
                         &TreeReconstruction::set_foliage_followed);
    ClassDB::bind_method(D_METHOD("is_foliage_followed"), &TreeReconstruction::is_foliage_followed);
    ClassDB::bind_method(D_METHOD("set_provenance", "provenance"), &TreeReconstruction::set_provenance);
    ClassDB::bind_method(D_METHOD("get_provenance"), &TreeReconstruction::get_provenance);
    ClassDB::bind_method(D_METHOD("set_seed", "seed"), &TreeReconstruction::set_seed);
    ClassDB::bind_method(D_METHOD("get_seed"), &TreeReconstruction::get_seed);
    ClassDB::bind_method(D_METHOD("set_leaf_preset", "name"), &TreeReconstruction::set_leaf_preset);
    ClassDB::bind_method(D_METHOD("get_leaf_preset"), &TreeReconstruction::get_leaf_preset);
    ClassDB::bind_method(D_METHOD("set_leaves_enabled", "enabled"), &TreeReconstruction::set_leaves_enabled);
    ClassDB::bind_method(D_METHOD("are_leaves_enabled"), &TreeReconstruction::are_leaves_enabled);
    ClassDB::bind_method(D_METHOD("set_leaf_rule", "rule"), &TreeReconstruction::set_leaf_rule);
    ClassDB::bind_method(D_METHOD("get_leaf_rule"), &TreeReconstruction::get_leaf_rule);
    ClassDB::bind_method(D_METHOD("set_leaf_arrangement", "arrangement"),
                         &TreeReconstruction::set_leaf_arrangement);
    ClassDB::bind_method(D_METHOD("get_leaf_arrangement"), &TreeReconstruction::get_leaf_arrangement);
    ClassDB::bind_method(D_METHOD("set_leaf_value", "index", "value"), &TreeReconstruction::set_leaf_value);
    ClassDB::bind_method(D_METHOD("get_leaf_value", "index"), &TreeReconstruction::get_leaf_value);
    ClassDB::bind_method(D_METHOD("set_maximum_leaves", "count"), &TreeReconstruction::set_maximum_leaves);
    ClassDB::bind_method(D_METHOD("get_maximum_leaves"), &TreeReconstruction::get_maximum_leaves);
    ClassDB::bind_method(D_METHOD("_get_linked_undo_properties", "property", "value"),
                         &TreeReconstruction::_get_linked_undo_properties);

    ADD_PROPERTY(
        PropertyInfo(Variant::DICTIONARY, "skeleton", PROPERTY_HINT_NONE, "", PROPERTY_USAGE_STORAGE),
        "set_skeleton", "get_skeleton");
    ADD_PROPERTY(PropertyInfo(Variant::DICTIONARY, "foliage", PROPERTY_HINT_NONE, "", PROPERTY_USAGE_STORAGE),
                 "set_foliage", "get_foliage");
    ADD_PROPERTY(PropertyInfo(Variant::DICTIONARY, "provenance", PROPERTY_HINT_NONE, "",
                              PROPERTY_USAGE_DEFAULT | PROPERTY_USAGE_READ_ONLY),
                 "set_provenance", "get_provenance");
    ADD_PROPERTY(PropertyInfo(Variant::INT, "seed"), "set_seed", "get_seed");
    // Without a prefix, so that all of them stand in the group.
    ADD_GROUP("Leaves", "");
    ADD_PROPERTY(PropertyInfo(Variant::OBJECT, "leaf_rule", PROPERTY_HINT_RESOURCE_TYPE, "LeafRule"),
                 "set_leaf_rule", "get_leaf_rule");
    // The preset comes first: it sets all that follow, which a file then sets again.
    ADD_PROPERTY(PropertyInfo(Variant::STRING, "leaf_preset"), "set_leaf_preset", "get_leaf_preset");
    ADD_PROPERTY(PropertyInfo(Variant::BOOL, "leaves_enabled"), "set_leaves_enabled", "are_leaves_enabled");
    ADD_PROPERTY(PropertyInfo(Variant::INT, "leaf_arrangement", PROPERTY_HINT_ENUM, "Alternate,Opposite"),
                 "set_leaf_arrangement", "get_leaf_arrangement");
    for (int i = 0; i < int(std::size(LeafSettings::kValues)); i++) {
        const LeafSettings::Value& value = LeafSettings::kValues[i];
        ADD_PROPERTYI(
            PropertyInfo(Variant::FLOAT, value.property, PROPERTY_HINT_RANGE, String::utf8(value.hint)),
            "set_leaf_value", "get_leaf_value", i);
    }
    ADD_PROPERTY(PropertyInfo(Variant::BOOL, "foliage_followed"), "set_foliage_followed",
                 "is_foliage_followed");
    ADD_PROPERTY(PropertyInfo(Variant::INT, "maximum_leaves", PROPERTY_HINT_RANGE, "0,200000,1,or_greater"),
                 "set_maximum_leaves", "get_maximum_leaves");
}

void TreeReconstruction::_bind_methods() {
    _bind_properties();
    _bind_editing();
    _bind_grafting();
    _bind_physics();
    _bind_viewing();
    _bind_variants();
    _bind_levels();
    _bind_bark();
    _bind_leaf_kinds();

    ClassDB::bind_method(D_METHOD("is_empty"), &TreeReconstruction::is_empty);
    ClassDB::bind_method(D_METHOD("get_node_count"), &TreeReconstruction::get_node_count);
    ClassDB::bind_method(D_METHOD("get_root"), &TreeReconstruction::get_root);
    ClassDB::bind_method(D_METHOD("has_node", "id"), &TreeReconstruction::has_node);
    ClassDB::bind_method(D_METHOD("get_node_position", "id"), &TreeReconstruction::get_node_position);
    ClassDB::bind_method(D_METHOD("get_node_scan_position", "id"),
                         &TreeReconstruction::get_node_scan_position);
    ClassDB::bind_method(D_METHOD("get_position_in_tree", "scan_position"),
                         &TreeReconstruction::get_position_in_tree);
    ClassDB::bind_method(D_METHOD("get_node_radius", "id"), &TreeReconstruction::get_node_radius);
    ClassDB::bind_method(D_METHOD("get_node_parent", "id"), &TreeReconstruction::get_node_parent);
    ClassDB::bind_method(D_METHOD("get_node_children", "id"), &TreeReconstruction::get_node_children);
    ClassDB::bind_method(D_METHOD("get_node_kind", "id"), &TreeReconstruction::get_node_kind);
    ClassDB::bind_method(D_METHOD("get_node_depth", "id"), &TreeReconstruction::get_node_depth);
    ClassDB::bind_method(D_METHOD("is_trunk", "id"), &TreeReconstruction::is_trunk);
    ClassDB::bind_method(D_METHOD("is_radius_measured", "id"), &TreeReconstruction::is_radius_measured);
    ClassDB::bind_method(D_METHOD("is_guess", "id"), &TreeReconstruction::is_guess);
    ClassDB::bind_method(D_METHOD("get_node_ids"), &TreeReconstruction::get_node_ids);
    ClassDB::bind_method(D_METHOD("get_leaves"), &TreeReconstruction::get_leaves);
    ClassDB::bind_method(D_METHOD("get_branch_nodes"), &TreeReconstruction::get_branch_nodes);
    ClassDB::bind_method(D_METHOD("get_trunk_nodes"), &TreeReconstruction::get_trunk_nodes);
    ClassDB::bind_method(D_METHOD("get_positions"), &TreeReconstruction::get_positions);
    ClassDB::bind_method(D_METHOD("get_radii"), &TreeReconstruction::get_radii);
    ClassDB::bind_method(D_METHOD("get_parents"), &TreeReconstruction::get_parents);
    ClassDB::bind_method(D_METHOD("get_aabb"), &TreeReconstruction::get_aabb);
    ClassDB::bind_method(D_METHOD("get_bark_revision"), &TreeReconstruction::get_bark_revision);
    ClassDB::bind_method(D_METHOD("get_leaf_look"), &TreeReconstruction::get_leaf_look);
    ClassDB::bind_method(D_METHOD("are_leaves_single"), &TreeReconstruction::are_leaves_single);
    ClassDB::bind_method(D_METHOD("has_foliage"), &TreeReconstruction::has_foliage);
    ClassDB::bind_method(D_METHOD("find_wood_points", "points"), &TreeReconstruction::find_wood_points);
    ClassDB::bind_method(D_METHOD("get_foliage_positions"), &TreeReconstruction::get_foliage_positions);
    ClassDB::bind_method(D_METHOD("get_foliage_colors"), &TreeReconstruction::get_foliage_colors);
    ClassDB::bind_method(D_METHOD("measure"), &TreeReconstruction::measure);
#ifdef TREEREC_EDITOR
    ClassDB::bind_method(D_METHOD("measure_fidelity", "points", "tolerance"),
                         &TreeReconstruction::measure_fidelity, DEFVAL(0.02));
    ClassDB::bind_method(D_METHOD("preview_completion", "points", "id", "direction", "options"),
                         &TreeReconstruction::preview_completion, DEFVAL(Dictionary()));
    ClassDB::bind_method(D_METHOD("complete_branch", "points", "id", "direction", "options"),
                         &TreeReconstruction::complete_branch, DEFVAL(Dictionary()));
#endif

    ClassDB::bind_method(D_METHOD("build_mesh_arrays", "lod", "whole_repeats", "leaves", "leaf_triangles"),
                         &TreeReconstruction::build_mesh_arrays, DEFVAL(0), DEFVAL(false), DEFVAL(true),
                         DEFVAL(-1));
    ClassDB::bind_method(D_METHOD("build_mesh", "lod"), &TreeReconstruction::build_mesh, DEFVAL(0));
    ClassDB::bind_method(D_METHOD("build_leaf_buffer", "lod"), &TreeReconstruction::build_leaf_buffer,
                         DEFVAL(0));
    ClassDB::bind_method(D_METHOD("build_leaves", "lod"), &TreeReconstruction::build_leaves, DEFVAL(0));
    ClassDB::bind_method(D_METHOD("build_skeleton_lines"), &TreeReconstruction::build_skeleton_lines);
    ClassDB::bind_static_method("TreeReconstruction", D_METHOD("widen_lines", "lines"),
                                &TreeReconstruction::widen_lines);
    ClassDB::bind_method(D_METHOD("build_leaf_form_arrays", "lod"),
                         &TreeReconstruction::build_leaf_form_arrays, DEFVAL(0));
    ClassDB::bind_method(D_METHOD("build_joined_leaf_arrays", "lod"),
                         &TreeReconstruction::build_joined_leaf_arrays, DEFVAL(0));
    ClassDB::bind_static_method("TreeReconstruction", D_METHOD("build_leaf_card_arrays", "lod"),
                                &TreeReconstruction::build_leaf_card_arrays, DEFVAL(0));
    ClassDB::bind_static_method("TreeReconstruction", D_METHOD("get_wind_globals"),
                                &TreeReconstruction::get_wind_globals);
    ClassDB::bind_static_method("TreeReconstruction", D_METHOD("get_leaf_preset_names"),
                                &TreeReconstruction::get_leaf_preset_names);

    BIND_ENUM_CONSTANT(NODE_KIND_LEAF);
    BIND_ENUM_CONSTANT(NODE_KIND_BRANCH);
    BIND_ENUM_CONSTANT(NODE_KIND_COMMON);
    BIND_ENUM_CONSTANT(NODE_KIND_TRUNK);
    BIND_ENUM_CONSTANT(LEAF_ARRANGEMENT_ALTERNATE);
    BIND_ENUM_CONSTANT(LEAF_ARRANGEMENT_OPPOSITE);
    BIND_CONSTANT(NO_NODE);
    BIND_CONSTANT(FORMAT_VERSION);
    BIND_CONSTANT(FOLIAGE_VERSION);
    ClassDB::bind_integer_constant("TreeReconstruction", "", "MESH_FLAGS", kSurfaceFlags);
    ClassDB::bind_integer_constant("TreeReconstruction", "", "JOINED_LEAF_FLAGS", kJoinedLeafFlags);
}
