#pragma once

#include <godot_cpp/classes/array_mesh.hpp>
#include <godot_cpp/classes/multi_mesh.hpp>
#include <godot_cpp/classes/resource.hpp>
#include <godot_cpp/core/class_db.hpp>
#include <godot_cpp/variant/packed_color_array.hpp>
#include <godot_cpp/variant/packed_vector3_array.hpp>
#include <godot_cpp/variant/typed_array.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "foliage/foliage.h"
#include "foliage/leaves.h"
#include "mesh/mesh.h"
#include "tree/tree.h"
#include "tree_reconstruction/edit_history.h"
#include "tree_reconstruction/leaf_settings.h"
#include "tree_reconstruction/part_caches.h"
#include "tree_reconstruction/shared_parts.h"

class TreeEdit;

// A reconstructed tree: its skeleton, where it comes from, and the rules by which it gets bark and leaves.
// The builders may run on any thread, also while another thread changes the tree: they see it as it was when
// they began. What it keeps lies in classes of its own, one for each concern; this is what Godot sees of
// them.
class TreeReconstruction : public godot::Resource {
    GDCLASS(TreeReconstruction, godot::Resource)

  public:
    enum NodeKind { NODE_KIND_LEAF, NODE_KIND_BRANCH, NODE_KIND_COMMON, NODE_KIND_TRUNK };
    enum LeafArrangement { LEAF_ARRANGEMENT_ALTERNATE, LEAF_ARRANGEMENT_OPPOSITE };
    enum { NO_NODE = treerec::kNoNode, FORMAT_VERSION = 3, FOLIAGE_VERSION = 1 };

    // For the other classes of this extension.
    void set_tree(treerec::Tree p_tree);
    std::shared_ptr<const treerec::Tree> get_tree() const;
    treerec::LeafRules get_leaf_rules() const;
    LeafSetting get_leaf_setting() const;
    void set_leaf_setting(const LeafSetting& p_setting);
    // With the season in them. Throws treerec::Error.
    std::vector<treerec::LeafKind> make_leaf_kinds(const treerec::Tree& p_tree) const;
    // The grown bark that is drawn on such a tree; null where there is none, or the wood beneath is another.
    std::shared_ptr<const treerec::GrownBark> get_bark_on(
        const std::shared_ptr<const treerec::Tree>& p_tree) const;
    void set_bark(const treerec::GrownBark& p_bark, const godot::String& p_recipe);
    void set_leaf_density(treerec::Foliage p_foliage);
    std::shared_ptr<const treerec::Foliage> get_leaf_density() const;

    // Stored properties.
    void set_skeleton(const godot::Dictionary& p_skeleton);
    godot::Dictionary get_skeleton() const;
    void set_foliage(const godot::Dictionary& p_foliage);
    godot::Dictionary get_foliage() const;
    void set_provenance(const godot::Dictionary& p_provenance);
    godot::Dictionary get_provenance() const { return provenance_; }
    void set_growth_recipe(const godot::String& p_recipe);
    godot::String get_growth_recipe() const { return growth_recipe_; }
    void set_grown_bark(const godot::PackedByteArray& p_bark);
    godot::PackedByteArray get_grown_bark() const { return packed_bark_; }
    void set_growth_meshes(const godot::Dictionary& p_meshes);
    godot::Dictionary get_growth_meshes() const { return growth_meshes_; }
    void set_growth_pending(bool p_pending);
    bool is_growth_pending() const { return growth_pending_; }
    void set_seed(int64_t p_seed);
    int64_t get_seed() const;
    void set_leaf_preset(const godot::String& p_name);
    godot::String get_leaf_preset() const;
    void set_leaves_enabled(bool p_enabled);
    bool are_leaves_enabled() const;
    void set_foliage_followed(bool p_followed);
    bool is_foliage_followed() const;
    void set_leaf_rule(const godot::Ref<LeafRule>& p_rule);
    godot::Ref<LeafRule> get_leaf_rule() const;
    void set_leaf_arrangement(LeafArrangement p_arrangement);
    LeafArrangement get_leaf_arrangement() const;
    void set_leaf_value(int p_index, double p_value);
    double get_leaf_value(int p_index) const;
    void set_maximum_leaves(int p_count);
    int get_maximum_leaves() const;

    // Queries.
    bool is_empty() const;
    int64_t get_node_count() const;
    int get_root() const;
    bool has_node(int64_t p_id) const;
    godot::Vector3 get_node_position(int64_t p_id) const;
    godot::PackedFloat64Array get_node_scan_position(int64_t p_id) const;
    godot::Vector3 get_position_in_tree(const godot::PackedFloat64Array& p_scan_position) const;
    double get_node_radius(int64_t p_id) const;
    int get_node_parent(int64_t p_id) const;
    godot::PackedInt32Array get_node_children(int64_t p_id) const;
    NodeKind get_node_kind(int64_t p_id) const;
    int get_node_depth(int64_t p_id) const;
    bool is_trunk(int64_t p_id) const;
    bool is_radius_measured(int64_t p_id) const;
    bool is_guess(int64_t p_id) const;
    godot::PackedInt32Array get_node_ids() const;
    godot::PackedInt32Array get_leaves() const;
    godot::PackedInt32Array get_branch_nodes() const;
    godot::PackedInt32Array get_trunk_nodes() const;
    godot::PackedVector3Array get_positions() const;
    godot::PackedFloat32Array get_radii() const;
    godot::PackedInt32Array get_parents() const;
    godot::AABB get_aabb() const;
    int64_t get_bark_revision() const;
    godot::String get_leaf_look() const;
    bool are_leaves_single() const;
    bool has_foliage() const;
    godot::PackedVector3Array get_foliage_positions() const;
    godot::PackedColorArray get_foliage_colors() const;
    godot::PackedInt32Array find_wood_points(const godot::PackedVector3Array& p_points) const;
    godot::Dictionary measure() const;
#ifdef TREEREC_EDITOR
    godot::Dictionary measure_fidelity(const godot::PackedVector3Array& p_points, double p_tolerance) const;
    // tree_completion.cpp
    godot::Dictionary preview_completion(const godot::PackedVector3Array& p_points, int64_t p_id,
                                         const godot::Vector3& p_direction,
                                         const godot::Dictionary& p_options) const;
    godot::Ref<TreeEdit> complete_branch(const godot::PackedVector3Array& p_points, int64_t p_id,
                                         const godot::Vector3& p_direction,
                                         const godot::Dictionary& p_options);
#endif

    // Builders.
    godot::Array build_mesh_arrays(int p_lod, bool p_whole_repeats = false, bool p_leaves = true,
                                   int64_t p_leaf_triangles = -1) const;
    godot::Ref<godot::ArrayMesh> build_mesh(int p_lod) const;
    godot::PackedFloat32Array build_leaf_buffer(int p_lod) const;
    godot::Ref<godot::MultiMesh> build_leaves(int p_lod) const;
    godot::Array build_skeleton_lines() const;
    static godot::Array widen_lines(const godot::Array& p_lines);
    godot::Array build_leaf_form_arrays(int p_lod) const;
    godot::Array build_joined_leaf_arrays(int p_lod) const;
    static godot::Array build_leaf_card_arrays(int p_lod);
    static godot::PackedStringArray get_leaf_preset_names();
    static godot::Dictionary get_wind_globals();

    // Wood with leaves of its own (tree_reconstruction_leaf_kinds.cpp).
    godot::TypedArray<godot::Dictionary> get_leaf_kinds(double p_season_shift) const;
    godot::Dictionary count_leaf_rules(const godot::PackedInt32Array& p_ids) const;
    godot::Ref<LeafRule> resolve_leaf_rule(const godot::String& p_rule) const;
    static godot::String check_leaf_rule(const godot::String& p_rule);
    godot::TypedArray<godot::Dictionary> build_foliage(int p_lod) const;
    godot::TypedArray<godot::Dictionary> build_joined_foliage(int p_lod) const;

    // tree_reconstruction_bark.cpp
    bool has_grown_bark() const;
    bool is_bark_stale() const;
    void take_bark_of(const godot::Ref<TreeReconstruction>& p_other);

    // tree_reconstruction_levels.cpp
    godot::TypedArray<godot::Dictionary> build_levels(const godot::PackedInt32Array& p_levels,
                                                      const godot::PackedInt32Array& p_budgets, bool p_joined,
                                                      bool p_leaves) const;

    // Editing (tree_reconstruction_editing.cpp), by one thread at a time.
    godot::Ref<TreeEdit> edit(const godot::String& p_command);
    void take_tree_of(const godot::Ref<TreeReconstruction>& p_other);
    godot::Variant try_edit(const godot::String& p_command);
    godot::String check_edit(const godot::String& p_command) const;
    godot::Error apply_edit(const godot::Ref<TreeEdit>& p_edit);
    godot::Error revert_edit(const godot::Ref<TreeEdit>& p_edit);
    godot::Dictionary replay(const godot::String& p_log, double p_tolerance);
    godot::Ref<TreeEdit> run_script(const godot::String& p_script);
    void set_edit_log(const godot::String& p_log);
    godot::String get_edit_log() const;
    godot::TypedArray<godot::Dictionary> get_unfit_edits() const;
    godot::String get_edit_log_without(int64_t p_index) const;
    godot::PackedInt32Array select_nodes(const godot::String& p_selection) const;
    godot::String check_selection(const godot::String& p_selection) const;
    static godot::TypedArray<godot::Dictionary> get_edit_commands();

    // Grafting (tree_reconstruction_grafting.cpp).
    godot::Ref<TreeEdit> make_twig(int64_t p_id, const godot::Dictionary& p_options);
    godot::Ref<TreeEdit> graft(int64_t p_id, const godot::Dictionary& p_options);
    godot::Ref<TreeEdit> graft_many(const godot::PackedInt32Array& p_ids, const godot::Dictionary& p_options);
    godot::String take_branch(int64_t p_id) const;
    godot::TypedArray<godot::Dictionary> find_collisions(int64_t p_id, double p_clearance) const;
    static godot::TypedArray<godot::Dictionary> get_twig_library();

    // For an editor (tree_reconstruction_viewing.cpp).
    int pick_node(const godot::Projection& p_to_screen, const godot::Vector2& p_viewport,
                  const godot::Vector2& p_position, double p_distance) const;
    godot::PackedInt32Array pick_nodes(const godot::Projection& p_to_screen, const godot::Vector2& p_viewport,
                                       const godot::Rect2& p_rect) const;
    int get_node_order(int64_t p_id) const;
    godot::Array build_selection_lines(const godot::PackedInt32Array& p_ids) const;
    godot::Dictionary preview_edit(const godot::String& p_command) const;
    godot::PackedByteArray draw(int p_size) const;

    // Physics (tree_reconstruction_physics.cpp).
    godot::TypedArray<godot::Dictionary> build_capsules(int p_maximum, double p_minimum_radius) const;
    godot::TypedArray<godot::Dictionary> build_convex_parts(int p_maximum, double p_minimum_radius,
                                                            bool p_trunk_only) const;
    godot::Dictionary weigh(double p_density) const;
    // tree_reconstruction_variants.cpp
    godot::Ref<TreeReconstruction> make_variant(int64_t p_seed, double p_amount, double p_age) const;

  protected:
    static void _bind_methods();
    void _validate_property(godot::PropertyInfo& p_property) const;
    // The inspector asks what else an undo has to bring back: a preset sets all leaf properties.
    godot::PackedStringArray _get_linked_undo_properties(const godot::StringName& p_property,
                                                         const godot::Variant& p_value) const;

  private:
    // A node's data, or nothing and an error that names the id.
    std::optional<treerec::Node> _find_node(int64_t p_id) const;
    godot::PackedInt32Array _nodes_of_kind(treerec::NodeKind p_kind) const;
    std::vector<treerec::LeafPlacement> _place_leaves(int p_lod) const;
    std::vector<std::vector<treerec::LeafPlacement>> _place_foliage(
        const treerec::Tree& p_tree, const std::vector<treerec::LeafKind>& p_kinds, int p_lod) const;
    size_t _count_leaf_triangles(const treerec::Tree& p_tree, const std::vector<treerec::LeafKind>& p_kinds,
                                 int p_lod) const;
    // Adds what is wanted of a kind's leaves and its card to what is told of the kind.
    using AddLeaves = void (*)(godot::Dictionary& r_part, const std::vector<treerec::LeafPlacement>& p_leaves,
                               treerec::Mesh p_card);
    godot::TypedArray<godot::Dictionary> _build_foliage(int p_lod, AddLeaves p_add) const;
    godot::Dictionary _describe_kind(const treerec::LeafKind& p_kind, double p_season_shift) const;
    static void _bind_properties();
    static void _bind_editing();
    static void _bind_grafting();
    static void _bind_physics();
    static void _bind_viewing();
    static void _bind_variants();
    static void _bind_levels();
    static void _bind_bark();
    static void _bind_leaf_kinds();
    std::shared_ptr<const treerec::Tree> _editable_tree() const;
    godot::Ref<TreeEdit> _edit(const godot::String& p_command);
    godot::Ref<TreeEdit> _edit_with(const char* p_command, const godot::Variant& p_where,
                                    const godot::Dictionary& p_options);

    SharedParts parts_;
    mutable BarkFit bark_fit_;
    mutable BarkRevision bark_revision_;
    mutable VariantSource variant_source_;
    LeafSettings leaf_settings_;
    EditHistory edit_history_;
    godot::Dictionary provenance_;
    godot::String growth_recipe_;
    godot::Dictionary growth_meshes_;  // never changed, only replaced
    bool growth_pending_ = false;
    godot::PackedByteArray packed_bark_;  // as it was given, also where this version can't read it
    godot::Dictionary newer_foliage_;     // likewise
    // Of a version that this one can't read; kept so that saving loses nothing.
    godot::Dictionary newer_skeleton_;
};

VARIANT_ENUM_CAST(TreeReconstruction::NodeKind);
VARIANT_ENUM_CAST(TreeReconstruction::LeafArrangement);
