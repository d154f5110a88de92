// What TreeReconstruction keeps of the leaves that the scan saw, and its leaf rule.
#include <godot_cpp/classes/mesh.hpp>
#include <godot_cpp/variant/packed_color_array.hpp>
#include <godot_cpp/variant/packed_vector3_array.hpp>
#include <utility>

#include "convert.h"
#include "error.h"
#include "mesh/joined_leaves.h"
#include "mesh/leaf_cards.h"
#include "tree_reconstruction/tree_reconstruction.h"

using namespace godot;

void TreeReconstruction::set_leaf_density(treerec::Foliage p_foliage) {
    const auto foliage = std::make_shared<const treerec::Foliage>(std::move(p_foliage));
    parts_.replace([&](SharedParts::Parts& r_parts) { r_parts.foliage = foliage; });
    replace(newer_foliage_, Dictionary());
    emit_changed();
}

std::shared_ptr<const treerec::Foliage> TreeReconstruction::get_leaf_density() const {
    return parts_.get().foliage;
}

PackedInt32Array TreeReconstruction::find_wood_points(const PackedVector3Array& p_points) const {
    std::vector<treerec::Vec3> points;
    points.reserve(size_t(p_points.size()));
    for (int64_t i = 0; i < p_points.size(); i++) {
        const Vector3& point = p_points[i];
        points.emplace_back(point.x, point.y, point.z);
    }
    return to_godot(treerec::points_outside(*get_leaf_density(), points));
}

void TreeReconstruction::set_foliage(const Dictionary& p_foliage) {
    treerec::Foliage foliage;
    Dictionary newer;
    const Variant version = p_foliage.get("format_version", 0);
    if (p_foliage.is_empty()) {
        // The default: the scan saw none.
    } else if (version.get_type() != Variant::INT || int64_t(version) < 1) {
        ERR_PRINT(
            "The saved foliage is damaged: it doesn't say its format version. Reconstruct the tree again.");
    } else if (int64_t(version) > FOLIAGE_VERSION) {
        newer = p_foliage;
        ERR_PRINT(vformat(
            "This foliage was saved by a newer version of the addon (format %d; this one reads up to %d), so "
            "the leaves stand by the rules alone. Update the addon to see them.",
            version, int(FOLIAGE_VERSION)));
    } else {
        foliage = guarded(treerec::Foliage(), [&] { return foliage_from_dictionary(p_foliage); });
    }
    set_leaf_density(std::move(foliage));
    newer_foliage_ = newer;
}

Dictionary TreeReconstruction::get_foliage() const {
    if (!newer_foliage_.is_empty()) {
        return newer_foliage_;
    }
    const std::shared_ptr<const treerec::Foliage> foliage = get_leaf_density();
    return foliage->empty() ? Dictionary() : to_dictionary(*foliage, FOLIAGE_VERSION);
}

void TreeReconstruction::set_foliage_followed(bool p_followed) {
    leaf_settings_.change([&](LeafSetting& r_setting) { r_setting.foliage_followed = p_followed; });
    emit_changed();
}

bool TreeReconstruction::is_foliage_followed() const {
    return leaf_settings_.get().foliage_followed;
}

bool TreeReconstruction::has_foliage() const {
    return !get_leaf_density()->empty();
}

PackedVector3Array TreeReconstruction::get_foliage_positions() const {
    const std::shared_ptr<const treerec::Foliage> foliage = get_leaf_density();
    PackedVector3Array positions;
    positions.resize(int64_t(foliage->cells.size()));
    Vector3* write = positions.ptrw();
    for (const treerec::FoliageCell& cell : foliage->cells) {
        *write++ = to_godot(foliage->centre(cell));
    }
    return positions;
}

PackedColorArray TreeReconstruction::get_foliage_colors() const {
    const std::shared_ptr<const treerec::Foliage> foliage = get_leaf_density();
    PackedColorArray colors;
    if (!foliage->colored) {
        return colors;
    }
    colors.resize(int64_t(foliage->cells.size()));
    Color* write = colors.ptrw();
    for (const treerec::FoliageCell& cell : foliage->cells) {
        *write++ = Color(float(cell.color[0]) / 255.0f, float(cell.color[1]) / 255.0f,
                         float(cell.color[2]) / 255.0f);
    }
    return colors;
}

treerec::LeafRules TreeReconstruction::get_leaf_rules() const {
    return leaf_settings_.get_rules();
}

void TreeReconstruction::set_leaf_rule(const Ref<LeafRule>& p_rule) {
    const Ref<LeafRule> before = get_leaf_rule();
    if (before == p_rule) {
        return;
    }
    const Callable heard(this, "emit_changed");
    if (before.is_valid()) {
        before->disconnect("changed", heard);
    }
    leaf_settings_.change([&](LeafSetting& r_setting) { r_setting.rule = p_rule; });
    if (p_rule.is_valid()) {
        p_rule->connect("changed", heard);
    }
    notify_property_list_changed();
    emit_changed();
}

Ref<LeafRule> TreeReconstruction::get_leaf_rule() const {
    return leaf_settings_.get().rule;
}

String TreeReconstruction::get_leaf_look() const {
    return leaf_settings_.get_look();
}

bool TreeReconstruction::are_leaves_single() const {
    return treerec::uses_blade_picture(get_leaf_rules());
}

Array TreeReconstruction::build_leaf_form_arrays(int p_lod) const {
    ERR_FAIL_COND_V_MSG(p_lod < 0, Array(),
                        vformat("There is no level of detail %d; 0 is the finest.", p_lod));
    return guarded(Array(), [&] {
        treerec::Mesh card = treerec::build_leaf_card(get_leaf_rules(), p_lod);
        // The engine would multiply a leaf's own colour, which is a direction, with them.
        card.colors.clear();
        return to_surface_arrays(card);
    });
}

Array TreeReconstruction::build_joined_leaf_arrays(int p_lod) const {
    ERR_FAIL_COND_V_MSG(p_lod < 0, Array(),
                        vformat("There is no level of detail %d; 0 is the finest.", p_lod));
    return guarded(Array(), [&] {
        const treerec::LeafRules rules = get_leaf_rules();
        const treerec::JoinedLeaves joined =
            treerec::join_leaves(_place_leaves(p_lod), treerec::build_leaf_card(rules, p_lod));
        return to_surface_arrays(joined);
    });
}

std::vector<treerec::LeafPlacement> TreeReconstruction::_place_leaves(int p_lod) const {
    const std::shared_ptr<const treerec::Tree> tree = get_tree();
    return _place_foliage(*tree, make_leaf_kinds(*tree), p_lod).front();
}
