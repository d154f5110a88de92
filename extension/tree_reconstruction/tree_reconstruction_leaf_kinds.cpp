// Wood of a TreeReconstruction that bears leaves of its own: see src/foliage/leaf_rule_text.h.
#include <algorithm>
#include <string>
#include <utility>

#include "convert.h"
#include "error.h"
#include "foliage/leaf_rule_text.h"
#include "mesh/joined_leaves.h"
#include "mesh/leaf_cards.h"
#include "mesh/level_leaves.h"
#include "tree_reconstruction/tree_reconstruction.h"

using namespace godot;

LeafSetting TreeReconstruction::get_leaf_setting() const {
    return leaf_settings_.get();
}

void TreeReconstruction::set_leaf_setting(const LeafSetting& p_setting) {
    leaf_settings_.change([&](LeafSetting& r_setting) {
        // The rule is taken below, which has to be heard from then on.
        const Ref<LeafRule> rule = r_setting.rule;
        r_setting = p_setting;
        r_setting.rule = rule;
    });
    set_leaf_rule(p_setting.rule);
}

// own: the tree's rule.
static bool _is_evergreen(const LeafRule& p_own, const treerec::LeafKind& p_kind) {
    return p_kind.look.empty() ? p_own.is_evergreen() : LeafRule::is_look_evergreen(to_godot(p_kind.look));
}

std::vector<treerec::LeafKind> TreeReconstruction::make_leaf_kinds(const treerec::Tree& p_tree) const {
    const Ref<LeafRule> rule = get_leaf_rule();
    if (rule.is_null()) {
        return treerec::leaf_kinds(p_tree, get_leaf_rules());
    }
    std::vector<treerec::LeafKind> kinds = treerec::leaf_kinds(p_tree, rule->get_plain_rules());
    for (treerec::LeafKind& kind : kinds) {
        kind.rules = rule->in_season(std::move(kind.rules), _is_evergreen(*rule.ptr(), kind));
    }
    return kinds;
}

std::vector<std::vector<treerec::LeafPlacement>> TreeReconstruction::_place_foliage(
    const treerec::Tree& p_tree, const std::vector<treerec::LeafKind>& p_kinds, int p_lod) const {
    std::vector<std::vector<treerec::LeafPlacement>> placed =
        treerec::place_foliage(p_tree, p_kinds, uint64_t(get_seed()), *get_leaf_density());
    if (p_lod > 0) {
        for (std::vector<treerec::LeafPlacement>& leaves : placed) {
            leaves = treerec::thin_leaves(leaves, p_lod);
        }
    }
    return placed;
}

size_t TreeReconstruction::_count_leaf_triangles(const treerec::Tree& p_tree,
                                                 const std::vector<treerec::LeafKind>& p_kinds,
                                                 int p_lod) const {
    const auto placed = _place_foliage(p_tree, p_kinds, 0);
    size_t count = 0;
    for (size_t i = 0; i < placed.size(); i++) {
        count += treerec::leaves_of_level(placed[i], p_kinds[i].rules, p_lod).triangle_count();
    }
    return count;
}

Dictionary TreeReconstruction::_describe_kind(const treerec::LeafKind& p_kind, double p_season_shift) const {
    const Ref<LeafRule> rule = get_leaf_rule();
    const String look = p_kind.look.empty() ? get_leaf_look() : to_godot(p_kind.look);
    PackedColorArray tints;
    Vector2 shares(1.0f, 1.0f);
    if (rule.is_valid()) {
        tints = rule->get_tints_at(p_season_shift, to_godot(p_kind.look));
        shares = rule->get_shares_at(p_season_shift, _is_evergreen(*rule.ptr(), p_kind));
    }
    Dictionary kind;
    kind["rule"] = to_godot(p_kind.text);
    kind["look"] = look;
    kind["single"] = treerec::uses_blade_picture(p_kind.rules);
    kind["tints"] = tints;
    kind["standing"] = shares.x;
    kind["unfolded"] = shares.y;
    return kind;
}

TypedArray<Dictionary> TreeReconstruction::get_leaf_kinds(double p_season_shift) const {
    return guarded(TypedArray<Dictionary>(), [&] {
        const std::shared_ptr<const treerec::Tree> tree = get_tree();
        const std::vector<treerec::LeafKind> kinds = make_leaf_kinds(*tree);
        std::vector<int64_t> nodes(kinds.size(), 0);
        for (treerec::NodeId id = 0; id < tree->id_end(); id++) {
            if (tree->contains(id)) {
                nodes[tree->node(id).leaf_rule]++;
            }
        }
        TypedArray<Dictionary> list;
        for (size_t i = 0; i < kinds.size(); i++) {
            Dictionary kind = _describe_kind(kinds[i], p_season_shift);
            kind["nodes"] = nodes[i];
            list.push_back(kind);
        }
        return list;
    });
}

Dictionary TreeReconstruction::count_leaf_rules(const PackedInt32Array& p_ids) const {
    const std::shared_ptr<const treerec::Tree> tree = get_tree();
    std::vector<int64_t> nodes(tree->leaf_rules().size() + 1, 0);
    for (int64_t i = 0; i < p_ids.size(); i++) {
        if (tree->contains(p_ids[i])) {
            nodes[tree->node(p_ids[i]).leaf_rule]++;
        }
    }
    Dictionary counts;
    for (size_t i = 0; i < nodes.size(); i++) {
        if (nodes[i] > 0) {
            counts[i == 0 ? String() : to_godot(tree->leaf_rules()[i - 1])] = nodes[i];
        }
    }
    return counts;
}

Ref<LeafRule> TreeReconstruction::resolve_leaf_rule(const String& p_rule) const {
    return guarded(Ref<LeafRule>(), [&] {
        Ref<LeafRule> rule = get_leaf_rule();
        const bool seasonal = rule.is_valid();
        if (!seasonal) {
            rule.instantiate();
        }
        const treerec::LeafKind kind =
            treerec::make_leaf_kind(to_std(p_rule), seasonal ? rule->get_plain_rules() : get_leaf_rules());
        const String look = kind.look.empty() ? get_leaf_look() : to_godot(kind.look);
        return rule->with_rules(
            kind.rules, look,
            kind.look.empty() && seasonal ? rule->is_evergreen() : LeafRule::is_look_evergreen(look));
    });
}

String TreeReconstruction::check_leaf_rule(const String& p_rule) {
    try {
        treerec::plain_leaf_rule(to_std(p_rule));
        return String();
    } catch (const std::exception& error) {
        return to_godot(std::string(error.what()));
    }
}

TypedArray<Dictionary> TreeReconstruction::_build_foliage(int p_lod, AddLeaves p_add) const {
    const TypedArray<Dictionary> none;
    ERR_FAIL_COND_V_MSG(p_lod < 0, none, vformat("There is no level of detail %d; 0 is the finest.", p_lod));
    return guarded(none, [&] {
        const std::shared_ptr<const treerec::Tree> tree = get_tree();
        const std::vector<treerec::LeafKind> kinds = make_leaf_kinds(*tree);
        const auto placed = _place_foliage(*tree, kinds, 0);
        TypedArray<Dictionary> parts;
        for (size_t i = 0; i < kinds.size(); i++) {
            Dictionary part = _describe_kind(kinds[i], 0.0);
            const treerec::LevelLeaves made = treerec::leaves_of_level(placed[i], kinds[i].rules, p_lod);
            p_add(part, made.leaves, made.card);
            parts.push_back(part);
        }
        return parts;
    });
}

TypedArray<Dictionary> TreeReconstruction::build_foliage(int p_lod) const {
    return _build_foliage(p_lod, [](Dictionary& r_part, const std::vector<treerec::LeafPlacement>& p_leaves,
                                    treerec::Mesh p_card) {
        treerec::Bounds box;
        treerec::add_leaves(box, p_leaves);
        r_part["leaves"] = to_godot(treerec::leaf_buffer(p_leaves));
        r_part["box"] = box.empty() ? AABB() : AABB(to_godot(box.min), to_godot(box.size()));
        // As in build_leaf_form_arrays().
        p_card.colors.clear();
        r_part["card"] = to_surface_arrays(p_card);
    });
}

TypedArray<Dictionary> TreeReconstruction::build_joined_foliage(int p_lod) const {
    return _build_foliage(p_lod, [](Dictionary& r_part, const std::vector<treerec::LeafPlacement>& p_leaves,
                                    treerec::Mesh p_card) {
        r_part["arrays"] = to_surface_arrays(treerec::join_leaves(p_leaves, p_card));
    });
}

void TreeReconstruction::_bind_leaf_kinds() {
    ClassDB::bind_method(D_METHOD("get_leaf_kinds", "season_shift"), &TreeReconstruction::get_leaf_kinds,
                         DEFVAL(0.0));
    ClassDB::bind_method(D_METHOD("count_leaf_rules", "ids"), &TreeReconstruction::count_leaf_rules);
    ClassDB::bind_method(D_METHOD("resolve_leaf_rule", "rule"), &TreeReconstruction::resolve_leaf_rule);
    ClassDB::bind_static_method("TreeReconstruction", D_METHOD("check_leaf_rule", "rule"),
                                &TreeReconstruction::check_leaf_rule);
    ClassDB::bind_method(D_METHOD("build_foliage", "lod"), &TreeReconstruction::build_foliage, DEFVAL(0));
    ClassDB::bind_method(D_METHOD("build_joined_foliage", "lod"), &TreeReconstruction::build_joined_foliage,
                         DEFVAL(0));
}
