#pragma once

#include <godot_cpp/classes/resource.hpp>
#include <godot_cpp/core/class_db.hpp>
#include <godot_cpp/variant/packed_float32_array.hpp>
#include <godot_cpp/variant/packed_vector2_array.hpp>
#include <godot_cpp/variant/typed_array.hpp>

#include "leaf_rule.h"

// Strokes that a tree is made of, with what else decides it. Data alone: TreeReconstructor makes the tree, in
// the editor; a game that loads such a tree loads these along.
class TreeSketch : public godot::Resource {
    GDCLASS(TreeSketch, godot::Resource)

  public:
    enum Role { ROLE_AUTO, ROLE_OUTLINE, ROLE_TRUNK, ROLE_BRANCH };
    enum Depth { DEPTH_TRUE, DEPTH_PAPER };
    enum Crown { CROWN_SECTIONS, CROWN_ALPHA };

    // {"id": int, "role": Role, "points": PackedVector2Array, "pressure": PackedFloat32Array} each.
    void set_strokes(const godot::TypedArray<godot::Dictionary>& p_strokes);
    godot::TypedArray<godot::Dictionary> get_strokes() const;
    void set_canvas_size(const godot::Vector2& p_size);
    godot::Vector2 get_canvas_size() const { return canvas_size_; }
    void set_species(const godot::String& p_species);
    godot::String get_species() const { return species_; }
    void set_height(double p_height);
    double get_height() const { return height_; }
    void set_trunk_radius(double p_radius);
    double get_trunk_radius() const { return trunk_radius_; }
    void set_density(double p_density);
    double get_density() const { return density_; }
    void set_depth(Depth p_depth);
    Depth get_depth() const { return depth_; }
    void set_crown(Crown p_crown);
    Crown get_crown() const { return crown_; }
    void set_seed(int64_t p_seed);
    int64_t get_seed() const { return seed_; }
    // Twigs of one's own as JSON (src/sketch/twig_stock.h); empty: the species'.
    void set_twigs(const godot::String& p_twigs);
    godot::String get_twigs() const { return twigs_; }
    void set_leaf_rule(const godot::Ref<LeafRule>& p_rule);
    godot::Ref<LeafRule> get_leaf_rule() const { return leaf_rule_; }

    // The id of the new stroke, or 0 where it has no points.
    int64_t add_stroke(const godot::PackedVector2Array& p_points,
                       const godot::PackedFloat32Array& p_pressure = godot::PackedFloat32Array(),
                       Role p_role = ROLE_AUTO);
    bool remove_stroke(int64_t p_id);
    // Gives a stroke other points, without pressure.
    bool reshape_stroke(int64_t p_id, const godot::PackedVector2Array& p_points);
    bool set_stroke_role(int64_t p_id, Role p_role);
    // The place of a stroke in `strokes`, or -1.
    int64_t find_stroke(int64_t p_id) const;

  protected:
    static void _bind_methods();

  private:
    int64_t _free_id() const;

    godot::TypedArray<godot::Dictionary> strokes_;
    godot::Vector2 canvas_size_{1000.0f, 1000.0f};
    godot::String species_;
    double height_ = 0.0;
    double trunk_radius_ = 0.0;
    double density_ = 1.0;
    Depth depth_ = DEPTH_TRUE;
    Crown crown_ = CROWN_SECTIONS;
    int64_t seed_ = 1;
    godot::String twigs_;
    godot::Ref<LeafRule> leaf_rule_;
};

VARIANT_ENUM_CAST(TreeSketch::Role);
VARIANT_ENUM_CAST(TreeSketch::Depth);
VARIANT_ENUM_CAST(TreeSketch::Crown);
