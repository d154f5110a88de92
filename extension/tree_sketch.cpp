#include "tree_sketch.h"

#include <algorithm>
#include <cmath>

#include "convert.h"

using namespace godot;

namespace {

constexpr double kLargestCanvas = 100000.0;  // pixels
constexpr double kTallest = 200.0;           // metres
constexpr double kMostDensity = 4.0;

// A stroke with all its keys, of the right types; whatever else it has goes.
Dictionary whole_stroke(const Dictionary& p_given) {
    Dictionary stroke;
    stroke["id"] = std::max(int64_t(p_given.get("id", 0)), int64_t(0));
    stroke["role"] =
        std::clamp(int64_t(p_given.get("role", 0)), int64_t(0), int64_t(TreeSketch::ROLE_BRANCH));
    const PackedVector2Array points = p_given.get("points", PackedVector2Array());
    const PackedFloat32Array pressure = p_given.get("pressure", PackedFloat32Array());
    stroke["points"] = points;
    stroke["pressure"] = pressure.size() == points.size() ? pressure : PackedFloat32Array();
    return stroke;
}

}  // namespace

void TreeSketch::set_strokes(const TypedArray<Dictionary>& p_strokes) {
    // Its own copies: whoever gave them may go on with theirs.
    replace(strokes_, TypedArray<Dictionary>());
    for (int64_t i = 0; i < p_strokes.size(); i++) {
        const Dictionary stroke = whole_stroke(p_strokes[i]);
        if (PackedVector2Array(stroke["points"]).is_empty()) {
            continue;
        }
        strokes_.push_back(stroke);
    }
    for (int64_t i = 0; i < strokes_.size(); i++) {
        Dictionary stroke = strokes_[i];
        const int64_t id = stroke["id"];
        if (id == 0 || find_stroke(id) < i) {
            stroke["id"] = _free_id();
        }
    }
    emit_changed();
}

TypedArray<Dictionary> TreeSketch::get_strokes() const {
    TypedArray<Dictionary> copies;
    for (int64_t i = 0; i < strokes_.size(); i++) {
        copies.push_back(Dictionary(strokes_[i]).duplicate());
    }
    return copies;
}

int64_t TreeSketch::_free_id() const {
    int64_t largest = 0;
    for (int64_t i = 0; i < strokes_.size(); i++) {
        largest = std::max(largest, int64_t(Dictionary(strokes_[i])["id"]));
    }
    return largest + 1;
}

int64_t TreeSketch::find_stroke(int64_t p_id) const {
    for (int64_t i = 0; i < strokes_.size(); i++) {
        if (int64_t(Dictionary(strokes_[i])["id"]) == p_id) {
            return i;
        }
    }
    return -1;
}

int64_t TreeSketch::add_stroke(const PackedVector2Array& p_points, const PackedFloat32Array& p_pressure,
                               Role p_role) {
    ERR_FAIL_COND_V_MSG(p_points.is_empty(), 0, "A stroke has at least one point.");
    Dictionary given;
    given["id"] = _free_id();
    given["role"] = int(p_role);
    given["points"] = p_points;
    given["pressure"] = p_pressure;
    const Dictionary stroke = whole_stroke(given);
    strokes_.push_back(stroke);
    emit_changed();
    return stroke["id"];
}

bool TreeSketch::remove_stroke(int64_t p_id) {
    const int64_t place = find_stroke(p_id);
    if (place < 0) {
        return false;
    }
    strokes_.remove_at(place);
    emit_changed();
    return true;
}

bool TreeSketch::reshape_stroke(int64_t p_id, const PackedVector2Array& p_points) {
    ERR_FAIL_COND_V_MSG(p_points.is_empty(), false, "A stroke has at least one point.");
    const int64_t place = find_stroke(p_id);
    if (place < 0) {
        return false;
    }
    Dictionary stroke = strokes_[place];
    stroke["points"] = p_points;
    stroke["pressure"] = PackedFloat32Array();
    emit_changed();
    return true;
}

bool TreeSketch::set_stroke_role(int64_t p_id, Role p_role) {
    const int64_t place = find_stroke(p_id);
    if (place < 0) {
        return false;
    }
    Dictionary stroke = strokes_[place];
    stroke["role"] = std::clamp(int(p_role), 0, int(ROLE_BRANCH));
    emit_changed();
    return true;
}

void TreeSketch::set_canvas_size(const Vector2& p_size) {
    ERR_FAIL_COND_MSG(
        !(p_size.x >= 1.0f && p_size.x <= kLargestCanvas && p_size.y >= 1.0f && p_size.y <= kLargestCanvas),
        "A canvas has 1 to 100000 pixels in width and height.");
    canvas_size_ = p_size;
    emit_changed();
}

void TreeSketch::set_species(const String& p_species) {
    species_ = p_species;
    emit_changed();
}

void TreeSketch::set_height(double p_height) {
    ERR_FAIL_COND_MSG(!std::isfinite(p_height), "height must be a finite number.");
    height_ = std::clamp(p_height, 0.0, kTallest);
    emit_changed();
}

void TreeSketch::set_trunk_radius(double p_radius) {
    ERR_FAIL_COND_MSG(!std::isfinite(p_radius), "trunk_radius must be a finite number.");
    trunk_radius_ = std::clamp(p_radius, 0.0, kTallest);
    emit_changed();
}

void TreeSketch::set_density(double p_density) {
    ERR_FAIL_COND_MSG(!std::isfinite(p_density), "density must be a finite number.");
    density_ = std::clamp(p_density, 0.0, kMostDensity);
    emit_changed();
}

void TreeSketch::set_depth(Depth p_depth) {
    ERR_FAIL_INDEX_MSG(int(p_depth), 2, "Depth is true (0) or the paper's (1).");
    depth_ = p_depth;
    emit_changed();
}

void TreeSketch::set_crown(Crown p_crown) {
    ERR_FAIL_INDEX_MSG(int(p_crown), 2, "A crown is bounded by sections (0) or alpha shapes (1).");
    crown_ = p_crown;
    emit_changed();
}

void TreeSketch::set_seed(int64_t p_seed) {
    seed_ = p_seed;
    emit_changed();
}

void TreeSketch::set_twigs(const String& p_twigs) {
    twigs_ = p_twigs;
    emit_changed();
}

void TreeSketch::set_leaf_rule(const Ref<LeafRule>& p_rule) {
    leaf_rule_ = p_rule;
    emit_changed();
}

void TreeSketch::_bind_methods() {
    ClassDB::bind_method(D_METHOD("set_strokes", "strokes"), &TreeSketch::set_strokes);
    ClassDB::bind_method(D_METHOD("get_strokes"), &TreeSketch::get_strokes);
    ClassDB::bind_method(D_METHOD("set_canvas_size", "size"), &TreeSketch::set_canvas_size);
    ClassDB::bind_method(D_METHOD("get_canvas_size"), &TreeSketch::get_canvas_size);
    ClassDB::bind_method(D_METHOD("set_species", "species"), &TreeSketch::set_species);
    ClassDB::bind_method(D_METHOD("get_species"), &TreeSketch::get_species);
    ClassDB::bind_method(D_METHOD("set_height", "height"), &TreeSketch::set_height);
    ClassDB::bind_method(D_METHOD("get_height"), &TreeSketch::get_height);
    ClassDB::bind_method(D_METHOD("set_trunk_radius", "radius"), &TreeSketch::set_trunk_radius);
    ClassDB::bind_method(D_METHOD("get_trunk_radius"), &TreeSketch::get_trunk_radius);
    ClassDB::bind_method(D_METHOD("set_density", "density"), &TreeSketch::set_density);
    ClassDB::bind_method(D_METHOD("get_density"), &TreeSketch::get_density);
    ClassDB::bind_method(D_METHOD("set_depth", "depth"), &TreeSketch::set_depth);
    ClassDB::bind_method(D_METHOD("get_depth"), &TreeSketch::get_depth);
    ClassDB::bind_method(D_METHOD("set_crown", "crown"), &TreeSketch::set_crown);
    ClassDB::bind_method(D_METHOD("get_crown"), &TreeSketch::get_crown);
    ClassDB::bind_method(D_METHOD("set_seed", "seed"), &TreeSketch::set_seed);
    ClassDB::bind_method(D_METHOD("get_seed"), &TreeSketch::get_seed);
    ClassDB::bind_method(D_METHOD("set_twigs", "twigs"), &TreeSketch::set_twigs);
    ClassDB::bind_method(D_METHOD("get_twigs"), &TreeSketch::get_twigs);
    ClassDB::bind_method(D_METHOD("set_leaf_rule", "rule"), &TreeSketch::set_leaf_rule);
    ClassDB::bind_method(D_METHOD("get_leaf_rule"), &TreeSketch::get_leaf_rule);
    ClassDB::bind_method(D_METHOD("add_stroke", "points", "pressure", "role"), &TreeSketch::add_stroke,
                         DEFVAL(PackedFloat32Array()), DEFVAL(int(ROLE_AUTO)));
    ClassDB::bind_method(D_METHOD("remove_stroke", "id"), &TreeSketch::remove_stroke);
    ClassDB::bind_method(D_METHOD("reshape_stroke", "id", "points"), &TreeSketch::reshape_stroke);
    ClassDB::bind_method(D_METHOD("set_stroke_role", "id", "role"), &TreeSketch::set_stroke_role);
    ClassDB::bind_method(D_METHOD("find_stroke", "id"), &TreeSketch::find_stroke);
    ADD_PROPERTY(PropertyInfo(Variant::ARRAY, "strokes", PROPERTY_HINT_NONE, "", PROPERTY_USAGE_STORAGE),
                 "set_strokes", "get_strokes");
    ADD_PROPERTY(PropertyInfo(Variant::VECTOR2, "canvas_size", PROPERTY_HINT_NONE, "suffix:px"),
                 "set_canvas_size", "get_canvas_size");
    ADD_PROPERTY(PropertyInfo(Variant::STRING, "species"), "set_species", "get_species");
    ADD_PROPERTY(PropertyInfo(Variant::FLOAT, "height", PROPERTY_HINT_RANGE, "0,40,0.1,or_greater,suffix:m"),
                 "set_height", "get_height");
    ADD_PROPERTY(
        PropertyInfo(Variant::FLOAT, "trunk_radius", PROPERTY_HINT_RANGE, "0,2,0.01,or_greater,suffix:m"),
        "set_trunk_radius", "get_trunk_radius");
    ADD_PROPERTY(PropertyInfo(Variant::FLOAT, "density", PROPERTY_HINT_RANGE, "0,4,0.05"), "set_density",
                 "get_density");
    ADD_PROPERTY(PropertyInfo(Variant::INT, "depth", PROPERTY_HINT_ENUM, "True,Paper"), "set_depth",
                 "get_depth");
    ADD_PROPERTY(PropertyInfo(Variant::INT, "crown", PROPERTY_HINT_ENUM, "Sections,Alpha Shapes"),
                 "set_crown", "get_crown");
    ADD_PROPERTY(PropertyInfo(Variant::INT, "seed"), "set_seed", "get_seed");
    ADD_PROPERTY(PropertyInfo(Variant::STRING, "twigs", PROPERTY_HINT_NONE, "", PROPERTY_USAGE_STORAGE),
                 "set_twigs", "get_twigs");
    ADD_PROPERTY(PropertyInfo(Variant::OBJECT, "leaf_rule", PROPERTY_HINT_RESOURCE_TYPE, "LeafRule"),
                 "set_leaf_rule", "get_leaf_rule");
    BIND_ENUM_CONSTANT(ROLE_AUTO);
    BIND_ENUM_CONSTANT(ROLE_OUTLINE);
    BIND_ENUM_CONSTANT(ROLE_TRUNK);
    BIND_ENUM_CONSTANT(ROLE_BRANCH);
    BIND_ENUM_CONSTANT(DEPTH_TRUE);
    BIND_ENUM_CONSTANT(DEPTH_PAPER);
    BIND_ENUM_CONSTANT(CROWN_SECTIONS);
    BIND_ENUM_CONSTANT(CROWN_ALPHA);
}
