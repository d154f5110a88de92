#include "leaf_rule.h"

#include <algorithm>
#include <cmath>
#include <godot_cpp/variant/packed_string_array.hpp>
#include <iterator>
#include <string>

#include "convert.h"
#include "error.h"
#include "foliage/leaf_rule_text.h"
#include "l_system.h"
#include "tree_reconstruction/tree_reconstruction.h"

using namespace godot;

namespace {

constexpr int kMostLeaves = 2000000;
constexpr int kCurveSteps = 33;
constexpr uint32_t kReferenceCounted = 8;  // Object.CONNECT_REFERENCE_COUNTED

std::vector<float> table_of(const Ref<Curve>& p_curve) {
    std::vector<float> table;
    if (p_curve.is_null()) {
        return table;
    }
    for (int i = 0; i < kCurveSteps; i++) {
        const double value = p_curve->sample(float(i) / float(kCurveSteps - 1));
        table.push_back(float(std::clamp(std::isfinite(value) ? value : 0.0, 0.0, 1.0)));
    }
    return table;
}

}  // namespace

struct LeafRule::Value {
    const char* property;
    double treerec::LeafRules::*member;
    double minimum;
    double maximum;
    const char* hint;  // range, step and unit for the inspector
};

const LeafRule::Value LeafRule::kValues[] = {
    {"divergence", &treerec::LeafRules::divergence, -360.0, 360.0, "0,180,0.1,suffix:°"},
    {"internode", &treerec::LeafRules::internode, 0.002, 10.0, "0.005,1,0.005,or_greater,suffix:m"},
    {"twig_length", &treerec::LeafRules::twig_length, 0.0, 100.0, "0,5,0.01,or_greater,suffix:m"},
    {"clustering", &treerec::LeafRules::clustering, 0.0, 1.0, "0,1,0.01"},
    {"maximum_radius", &treerec::LeafRules::maximum_radius, 0.0, 10.0, "0,0.2,0.001,or_greater,suffix:m"},
    {"leaf_area_index", &treerec::LeafRules::leaf_area_index, 0.0, 100.0, "0,12,0.1,or_greater"},
    {"leaf_size", &treerec::LeafRules::leaf_size, 0.005, 20.0, "0.01,3,0.005,or_greater,suffix:m"},
    {"size_variation", &treerec::LeafRules::size_variation, 0.0, 1.0, "0,1,0.01"},
    {"blade_width", &treerec::LeafRules::blade_width, 0.01, 4.0, "0.01,2,0.01"},
    {"petiole_length", &treerec::LeafRules::petiole, 0.0, 10.0, "0,0.5,0.005,or_greater,suffix:m"},
    {"angle", &treerec::LeafRules::angle, 0.0, 180.0, "0,180,1,suffix:°"},
    {"closing", &treerec::LeafRules::closing, 0.0, 1.0, "0,1,0.01"},
    {"droop", &treerec::LeafRules::droop, -180.0, 180.0, "-90,90,1,suffix:°"},
    {"angle_variation", &treerec::LeafRules::angle_variation, 0.0, 180.0, "0,90,1,suffix:°"},
    {"phototropism", &treerec::LeafRules::phototropism, 0.0, 1.0, "0,1,0.01"},
    {"curl", &treerec::LeafRules::curl, -180.0, 180.0, "-90,90,1,suffix:°"},
    {"fold", &treerec::LeafRules::fold, -80.0, 80.0, "-60,60,1,suffix:°"},
    {"follow_density", &treerec::LeafRules::follow_density, 0.0, 1.0, "0,1,0.01"},
    {"follow_color", &treerec::LeafRules::follow_color, 0.0, 1.0, "0,1,0.01"},
};

struct LeafRule::Count {
    const char* property;
    int treerec::LeafRules::*member;
    int minimum;
    int maximum;
    const char* hint;
};

const LeafRule::Count LeafRule::kCounts[] = {
    {"whorl_size", &treerec::LeafRules::whorl, 1, 64, "1,12,1,or_greater"},
    {"leaflets", &treerec::LeafRules::leaflets, 1, 128, "1,41,1,or_greater"},
    {"maximum_leaves", &treerec::LeafRules::maximum_leaves, 0, kMostLeaves, "0,200000,1,or_greater"},
};

treerec::LeafRules LeafRule::get_rules() const {
    return in_season(get_plain_rules(), is_evergreen());
}

treerec::LeafRules LeafRule::get_plain_rules() const {
    const std::lock_guard lock(mutex_);
    treerec::LeafRules rules = rules_;
    rules.internode /= treerec::leaves_per_node(rules);
    rules.spray_cover = treerec::leaf_preset(to_std(look_)).spray_cover;
    return rules;
}

Ref<LeafRule> LeafRule::with_rules(const treerec::LeafRules& p_rules, const String& p_look,
                                   bool p_evergreen) const {
    Ref<LeafRule> rule;
    rule.instantiate();
    rule->rules_ = p_rules;
    rule->rules_.internode *= treerec::leaves_per_node(p_rules);
    rule->look_ = p_look;
    rule->season_ = get_season();
    rule->evergreen_ = p_evergreen;
    return rule;
}

Ref<LeafRule> LeafRule::from_preset(const String& p_name) {
    Ref<LeafRule> rule;
    rule.instantiate();
    return guarded(Ref<LeafRule>(), [&] {
        treerec::LeafRules preset = treerec::leaf_preset(to_std(p_name));
        preset.internode *= treerec::leaves_per_node(preset);
        rule->rules_ = preset;
        rule->look_ = preset.enabled ? p_name : String("generic");
        rule->evergreen_ = is_look_evergreen(rule->look_);
        return rule;
    });
}

void LeafRule::set_enabled(bool p_enabled) {
    _change([&] { rules_.enabled = p_enabled; });
}

void LeafRule::set_look(const String& p_look) {
    const bool known = guarded(false, [&] { return treerec::leaf_preset(to_std(p_look)).enabled; });
    ERR_FAIL_COND_MSG(!known, vformat("'%s' is no look of leaves.", p_look));
    look_ = p_look;
    emit_changed();
}

void LeafRule::set_arrangement(Arrangement p_arrangement) {
    ERR_FAIL_INDEX_MSG(int(p_arrangement), int(ARRANGEMENT_FASCICLED) + 1,
                       vformat("There is no leaf arrangement %d.", int(p_arrangement)));
    _change([&] { rules_.arrangement = treerec::LeafArrangement(p_arrangement); });
    notify_property_list_changed();
}

void LeafRule::set_form(Form p_form) {
    ERR_FAIL_INDEX_MSG(int(p_form), int(FORM_SPRIG) + 1, vformat("There is no leaf form %d.", int(p_form)));
    _change([&] { rules_.form = treerec::LeafForm(p_form); });
    notify_property_list_changed();
}

void LeafRule::set_value(int p_index, double p_value) {
    ERR_FAIL_INDEX(p_index, int(std::size(kValues)));
    const Value& value = kValues[p_index];
    ERR_FAIL_COND_MSG(!std::isfinite(p_value), vformat("%s must be a finite number.", value.property));
    _change([&] { rules_.*value.member = std::clamp(p_value, value.minimum, value.maximum); });
}

double LeafRule::get_value(int p_index) const {
    ERR_FAIL_INDEX_V(p_index, int(std::size(kValues)), 0.0);
    return rules_.*kValues[p_index].member;
}

void LeafRule::set_count(int p_index, int p_value) {
    ERR_FAIL_INDEX(p_index, int(std::size(kCounts)));
    const Count& count = kCounts[p_index];
    _change([&] { rules_.*count.member = std::clamp(p_value, count.minimum, count.maximum); });
}

int LeafRule::get_count(int p_index) const {
    ERR_FAIL_INDEX_V(p_index, int(std::size(kCounts)), 0);
    return rules_.*kCounts[p_index].member;
}

// Keeps the connection to a resource in this one.
template <typename T>
void LeafRule::_replace(Ref<T>& p_member, const Ref<T>& p_value) {
    if (p_member == p_value) {
        return;
    }
    const Callable heard(this, "_take_resources");
    if (p_member.is_valid()) {
        p_member->disconnect("changed", heard);
    }
    p_member = p_value;
    if (p_member.is_valid()) {
        // One resource may serve two properties.
        p_member->connect("changed", heard, kReferenceCounted);
    }
    take_resources();
}

void LeafRule::take_resources() {
    std::shared_ptr<const treerec::LeafSprig> sprig;
    const Ref<TreeReconstruction> tree = sprig_;
    if (!sprig_string_.is_empty()) {
        sprig = guarded(sprig, [&] {
            const treerec::LStringOptions options = LSystem::read_options(LSystem::Dialect(sprig_dialect_));
            return treerec::read_sprig(to_std(sprig_string_), options.dialect_is_told
                                                                  ? std::optional(options.dialect)
                                                                  : std::nullopt);
        });
    } else if (tree.is_valid() && tree->get_tree()->size() > 1) {
        auto made = std::make_shared<treerec::LeafSprig>();
        made->wood = *tree->get_tree();
        sprig = std::move(made);
    }
    const std::vector<float> by_height = table_of(by_height_), by_radius = table_of(by_radius_);
    _change([&] {
        rules_.sprig = sprig;
        rules_.by_height = by_height;
        rules_.by_radius = by_radius;
    });
}

void LeafRule::set_density_by_height(const Ref<Curve>& p_curve) {
    _replace(by_height_, p_curve);
}

void LeafRule::set_density_by_radius(const Ref<Curve>& p_curve) {
    _replace(by_radius_, p_curve);
}

void LeafRule::set_density_by_order(const PackedFloat32Array& p_shares) {
    std::vector<float> shares;
    for (int64_t i = 0; i < p_shares.size(); i++) {
        ERR_FAIL_COND_MSG(!(p_shares[i] >= 0.0f && p_shares[i] <= 1.0f),
                          "density_by_order holds shares of leaves, from 0 to 1.");
        shares.push_back(p_shares[i]);
    }
    _change([&] { rules_.by_order = shares; });
}

PackedFloat32Array LeafRule::get_density_by_order() const {
    return to_godot(rules_.by_order);
}

void LeafRule::set_sprig(const Ref<Resource>& p_sprig) {
    ERR_FAIL_COND_MSG(p_sprig.is_valid() && Ref<TreeReconstruction>(p_sprig).is_null(),
                      "A sprig is a TreeReconstruction.");
    _replace(sprig_, p_sprig);
}

void LeafRule::set_sprig_string(const String& p_string) {
    if (sprig_string_ != p_string) {
        sprig_string_ = p_string;
        take_resources();
    }
}

void LeafRule::set_sprig_dialect(int p_dialect) {
    ERR_FAIL_INDEX_MSG(p_dialect, int(LSystem::DIALECT_TOLD) + 1,
                       vformat("There is no dialect %d of L-strings.", p_dialect));
    if (sprig_dialect_ != p_dialect) {
        sprig_dialect_ = p_dialect;
        take_resources();
    }
}

void LeafRule::set_season_colors(const Ref<Gradient>& p_colors) {
    _replace(season_colors_, p_colors);
}

void LeafRule::_validate_property(PropertyInfo& p_property) const {
    const auto hide_unless = [&](const char* p_name, bool p_shown) {
        if (!p_shown && p_property.name == StringName(p_name)) {
            p_property.usage = PROPERTY_USAGE_STORAGE;
        }
    };
    if (p_property.name == StringName("look")) {
        p_property.hint = PROPERTY_HINT_ENUM;
        PackedStringArray names;
        for (const std::string& name : treerec::leaf_preset_names()) {
            if (treerec::leaf_preset(name).enabled) {
                names.push_back(to_godot(name));
            }
        }
        p_property.hint_string = String(",").join(names);
    }
    const treerec::LeafArrangement arrangement = rules_.arrangement;
    const treerec::LeafForm form = rules_.form;
    hide_unless("whorl_size", arrangement == treerec::LeafArrangement::kWhorled ||
                                  arrangement == treerec::LeafArrangement::kFascicled);
    hide_unless("divergence", arrangement == treerec::LeafArrangement::kSpiral ||
                                  arrangement == treerec::LeafArrangement::kFascicled);
    hide_unless("leaflets", form == treerec::LeafForm::kPinnate || form == treerec::LeafForm::kPalmate ||
                                form == treerec::LeafForm::kNeedles);
    hide_unless("fold", form != treerec::LeafForm::kNeedles);
    hide_unless("blade_width", form != treerec::LeafForm::kSpray);
    hide_unless("petiole_length", form != treerec::LeafForm::kSpray && form != treerec::LeafForm::kSprig);
    hide_unless("sprig", form == treerec::LeafForm::kSprig);
    hide_unless("sprig_string", form == treerec::LeafForm::kSprig);
    hide_unless("sprig_dialect", form == treerec::LeafForm::kSprig);
}

void LeafRule::_bind_accessors() {
    ClassDB::bind_method(D_METHOD("set_enabled", "enabled"), &LeafRule::set_enabled);
    ClassDB::bind_method(D_METHOD("is_enabled"), &LeafRule::is_enabled);
    ClassDB::bind_method(D_METHOD("set_look", "look"), &LeafRule::set_look);
    ClassDB::bind_method(D_METHOD("get_look"), &LeafRule::get_look);
    ClassDB::bind_method(D_METHOD("set_arrangement", "arrangement"), &LeafRule::set_arrangement);
    ClassDB::bind_method(D_METHOD("get_arrangement"), &LeafRule::get_arrangement);
    ClassDB::bind_method(D_METHOD("set_form", "form"), &LeafRule::set_form);
    ClassDB::bind_method(D_METHOD("get_form"), &LeafRule::get_form);
    ClassDB::bind_method(D_METHOD("set_value", "index", "value"), &LeafRule::set_value);
    ClassDB::bind_method(D_METHOD("get_value", "index"), &LeafRule::get_value);
    ClassDB::bind_method(D_METHOD("set_count", "index", "value"), &LeafRule::set_count);
    ClassDB::bind_method(D_METHOD("get_count", "index"), &LeafRule::get_count);
    ClassDB::bind_method(D_METHOD("set_density_by_height", "curve"), &LeafRule::set_density_by_height);
    ClassDB::bind_method(D_METHOD("get_density_by_height"), &LeafRule::get_density_by_height);
    ClassDB::bind_method(D_METHOD("set_density_by_radius", "curve"), &LeafRule::set_density_by_radius);
    ClassDB::bind_method(D_METHOD("get_density_by_radius"), &LeafRule::get_density_by_radius);
    ClassDB::bind_method(D_METHOD("set_density_by_order", "shares"), &LeafRule::set_density_by_order);
    ClassDB::bind_method(D_METHOD("get_density_by_order"), &LeafRule::get_density_by_order);
    ClassDB::bind_method(D_METHOD("set_sprig", "sprig"), &LeafRule::set_sprig);
    ClassDB::bind_method(D_METHOD("get_sprig"), &LeafRule::get_sprig);
    ClassDB::bind_method(D_METHOD("set_sprig_string", "string"), &LeafRule::set_sprig_string);
    ClassDB::bind_method(D_METHOD("get_sprig_string"), &LeafRule::get_sprig_string);
    ClassDB::bind_method(D_METHOD("set_sprig_dialect", "dialect"), &LeafRule::set_sprig_dialect);
    ClassDB::bind_method(D_METHOD("get_sprig_dialect"), &LeafRule::get_sprig_dialect);
    ClassDB::bind_method(D_METHOD("set_season", "season"), &LeafRule::set_season);
    ClassDB::bind_method(D_METHOD("get_season"), &LeafRule::get_season);
    ClassDB::bind_method(D_METHOD("set_evergreen", "evergreen"), &LeafRule::set_evergreen);
    ClassDB::bind_method(D_METHOD("is_evergreen"), &LeafRule::is_evergreen);
    ClassDB::bind_method(D_METHOD("set_season_colors", "colors"), &LeafRule::set_season_colors);
    ClassDB::bind_method(D_METHOD("get_season_colors"), &LeafRule::get_season_colors);
}

void LeafRule::_bind_properties() {
    const auto add_value = [](const char* p_first, const char* p_last) {
        bool within = false;
        for (int i = 0; i < int(std::size(kValues)); i++) {
            within = within || String(kValues[i].property) == String(p_first);
            if (within) {
                ADD_PROPERTYI(PropertyInfo(Variant::FLOAT, kValues[i].property, PROPERTY_HINT_RANGE,
                                           String::utf8(kValues[i].hint)),
                              "set_value", "get_value", i);
            }
            within = within && String(kValues[i].property) != String(p_last);
        }
    };
    const auto add_count = [](int p_index) {
        ADD_PROPERTYI(
            PropertyInfo(Variant::INT, kCounts[p_index].property, PROPERTY_HINT_RANGE, kCounts[p_index].hint),
            "set_count", "get_count", p_index);
    };
    ADD_PROPERTY(PropertyInfo(Variant::BOOL, "enabled"), "set_enabled", "is_enabled");
    ADD_PROPERTY(PropertyInfo(Variant::STRING, "look"), "set_look", "get_look");
    add_count(2);
    ADD_GROUP("Arrangement", "");
    ADD_PROPERTY(PropertyInfo(Variant::INT, "arrangement", PROPERTY_HINT_ENUM,
                              "Alternate,Opposite,Decussate,Whorled,Spiral,Fascicled"),
                 "set_arrangement", "get_arrangement");
    add_count(0);
    add_value("divergence", "maximum_radius");
    ADD_PROPERTY(PropertyInfo(Variant::OBJECT, "density_by_height", PROPERTY_HINT_RESOURCE_TYPE, "Curve"),
                 "set_density_by_height", "get_density_by_height");
    ADD_PROPERTY(PropertyInfo(Variant::OBJECT, "density_by_radius", PROPERTY_HINT_RESOURCE_TYPE, "Curve"),
                 "set_density_by_radius", "get_density_by_radius");
    ADD_PROPERTY(PropertyInfo(Variant::PACKED_FLOAT32_ARRAY, "density_by_order"), "set_density_by_order",
                 "get_density_by_order");
    add_value("leaf_area_index", "leaf_area_index");
    ADD_GROUP("Leaf", "");
    ADD_PROPERTY(
        PropertyInfo(Variant::INT, "form", PROPERTY_HINT_ENUM, "Spray,Simple,Pinnate,Palmate,Needles,Sprig"),
        "set_form", "get_form");
    add_value("leaf_size", "size_variation");
    add_count(1);
    add_value("blade_width", "petiole_length");
    ADD_PROPERTY(PropertyInfo(Variant::OBJECT, "sprig", PROPERTY_HINT_RESOURCE_TYPE, "TreeReconstruction"),
                 "set_sprig", "get_sprig");
    // Before the string: a saved one of the paper's would be refused without it.
    ADD_PROPERTY(PropertyInfo(Variant::INT, "sprig_dialect", PROPERTY_HINT_ENUM, "Turtle,Paper,Told"),
                 "set_sprig_dialect", "get_sprig_dialect");
    ADD_PROPERTY(PropertyInfo(Variant::STRING, "sprig_string", PROPERTY_HINT_MULTILINE_TEXT),
                 "set_sprig_string", "get_sprig_string");
    ADD_GROUP("Pose", "");
    add_value("angle", "fold");
    ADD_GROUP("Season", "");
    ADD_PROPERTY(PropertyInfo(Variant::FLOAT, "season", PROPERTY_HINT_RANGE, "0,1,0.01"), "set_season",
                 "get_season");
    ADD_PROPERTY(PropertyInfo(Variant::BOOL, "evergreen"), "set_evergreen", "is_evergreen");
    ADD_PROPERTY(PropertyInfo(Variant::OBJECT, "season_colors", PROPERTY_HINT_RESOURCE_TYPE, "Gradient"),
                 "set_season_colors", "get_season_colors");
    ADD_GROUP("Scan", "");
    add_value("follow_density", "follow_color");
}

void LeafRule::_bind_methods() {
    ClassDB::bind_static_method("LeafRule", D_METHOD("from_preset", "name"), &LeafRule::from_preset);
    ClassDB::bind_method(D_METHOD("get_season_tints"), &LeafRule::get_season_tints);
    ClassDB::bind_method(D_METHOD("get_standing_share"), &LeafRule::get_standing_share);
    ClassDB::bind_method(D_METHOD("get_unfolded_share"), &LeafRule::get_unfolded_share);
    ClassDB::bind_method(D_METHOD("_take_resources"), &LeafRule::take_resources);
    _bind_accessors();
    _bind_properties();

    BIND_ENUM_CONSTANT(ARRANGEMENT_ALTERNATE);
    BIND_ENUM_CONSTANT(ARRANGEMENT_OPPOSITE);
    BIND_ENUM_CONSTANT(ARRANGEMENT_DECUSSATE);
    BIND_ENUM_CONSTANT(ARRANGEMENT_WHORLED);
    BIND_ENUM_CONSTANT(ARRANGEMENT_SPIRAL);
    BIND_ENUM_CONSTANT(ARRANGEMENT_FASCICLED);
    BIND_ENUM_CONSTANT(FORM_SPRAY);
    BIND_ENUM_CONSTANT(FORM_SIMPLE);
    BIND_ENUM_CONSTANT(FORM_PINNATE);
    BIND_ENUM_CONSTANT(FORM_PALMATE);
    BIND_ENUM_CONSTANT(FORM_NEEDLES);
    BIND_ENUM_CONSTANT(FORM_SPRIG);
}
