#pragma once

#include <godot_cpp/classes/curve.hpp>
#include <godot_cpp/classes/gradient.hpp>
#include <godot_cpp/classes/resource.hpp>
#include <godot_cpp/core/class_db.hpp>
#include <godot_cpp/variant/packed_color_array.hpp>
#include <godot_cpp/variant/packed_float32_array.hpp>
#include <memory>
#include <mutex>

#include "foliage/leaf_rules.h"

// What leaves a kind of tree bears, and how they stand. The main thread sets it; get_rules() may be called
// from any thread.
class LeafRule : public godot::Resource {
    GDCLASS(LeafRule, godot::Resource)

  public:
    enum Arrangement {
        ARRANGEMENT_ALTERNATE,
        ARRANGEMENT_OPPOSITE,
        ARRANGEMENT_DECUSSATE,
        ARRANGEMENT_WHORLED,
        ARRANGEMENT_SPIRAL,
        ARRANGEMENT_FASCICLED,
    };
    enum Form {
        FORM_SPRAY,
        FORM_SIMPLE,
        FORM_PINNATE,
        FORM_PALMATE,
        FORM_NEEDLES,
        FORM_SPRIG,
    };

    // As the core takes them: with the season in them.
    treerec::LeafRules get_rules() const;
    // Without the season; and what its season makes of rules.
    treerec::LeafRules get_plain_rules() const;
    treerec::LeafRules in_season(treerec::LeafRules p_rules, bool p_evergreen) const;
    // get_season_tints() when the season is p_shift later; of this rule's leaves, or where p_look names
    // another preset than its own, of that one's.
    godot::PackedColorArray get_tints_at(double p_shift, const godot::String& p_look = "") const;
    // By how much fewer and smaller leaves are then: (standing, unfolded).
    godot::Vector2 get_shares_at(double p_shift, bool p_evergreen) const;
    static bool is_look_evergreen(const godot::String& p_look);
    // A new one with such rules, and this one's season.
    godot::Ref<LeafRule> with_rules(const treerec::LeafRules& p_rules, const godot::String& p_look,
                                    bool p_evergreen) const;

    static godot::Ref<LeafRule> from_preset(const godot::String& p_name);

    void set_enabled(bool p_enabled);
    bool is_enabled() const { return rules_.enabled; }
    void set_look(const godot::String& p_look);
    godot::String get_look() const { return look_; }
    void set_arrangement(Arrangement p_arrangement);
    Arrangement get_arrangement() const { return Arrangement(rules_.arrangement); }
    void set_form(Form p_form);
    Form get_form() const { return Form(rules_.form); }
    void set_value(int p_index, double p_value);
    double get_value(int p_index) const;
    void set_count(int p_index, int p_value);
    int get_count(int p_index) const;
    void set_density_by_height(const godot::Ref<godot::Curve>& p_curve);
    godot::Ref<godot::Curve> get_density_by_height() const { return by_height_; }
    void set_density_by_radius(const godot::Ref<godot::Curve>& p_curve);
    godot::Ref<godot::Curve> get_density_by_radius() const { return by_radius_; }
    void set_density_by_order(const godot::PackedFloat32Array& p_shares);
    godot::PackedFloat32Array get_density_by_order() const;
    void set_sprig(const godot::Ref<godot::Resource>& p_sprig);
    godot::Ref<godot::Resource> get_sprig() const { return sprig_; }
    void set_sprig_string(const godot::String& p_string);
    godot::String get_sprig_string() const { return sprig_string_; }
    // An LSystem::Dialect.
    void set_sprig_dialect(int p_dialect);
    int get_sprig_dialect() const { return sprig_dialect_; }
    void set_season(double p_season);
    double get_season() const { return season_; }
    void set_evergreen(bool p_evergreen);
    bool is_evergreen() const { return evergreen_; }
    void set_season_colors(const godot::Ref<godot::Gradient>& p_colors);
    godot::Ref<godot::Gradient> get_season_colors() const { return season_colors_; }

    godot::PackedColorArray get_season_tints() const;
    double get_standing_share() const;
    double get_unfolded_share() const;

    // Heard from the resources in it.
    void take_resources();

  protected:
    static void _bind_methods();
    static void _bind_accessors();
    static void _bind_properties();
    void _validate_property(godot::PropertyInfo& p_property) const;

  private:
    struct Value;
    struct Count;
    static const Value kValues[];
    static const Count kCounts[];

    // Changes what other threads read, then says so.
    template <typename F>
    void _change(const F& p_function) {
        {
            const std::lock_guard lock(mutex_);
            p_function();
        }
        emit_changed();
    }
    template <typename T>
    void _replace(godot::Ref<T>& p_member, const godot::Ref<T>& p_value);

    mutable std::mutex mutex_;  // guards rules_, season_ and evergreen_
    treerec::LeafRules rules_;  // internode: between nodes
    double season_ = 0.4;
    bool evergreen_ = false;
    godot::String look_ = "generic";
    godot::Ref<godot::Curve> by_height_, by_radius_;
    godot::Ref<godot::Resource> sprig_;
    godot::String sprig_string_;
    int sprig_dialect_ = 2;  // told
    godot::Ref<godot::Gradient> season_colors_;
};

VARIANT_ENUM_CAST(LeafRule::Arrangement);
VARIANT_ENUM_CAST(LeafRule::Form);
