// Levels of detail of a TreeReconstruction: see src/mesh/levels.h.
#include "mesh/levels.h"

#include "convert.h"
#include "error.h"
#include "mesh/joined_leaves.h"
#include "mesh/leaf_cards.h"
#include "tree_reconstruction/tree_reconstruction.h"

using namespace godot;

TypedArray<Dictionary> TreeReconstruction::build_levels(const PackedInt32Array& p_levels,
                                                        const PackedInt32Array& p_budgets, bool p_joined,
                                                        bool p_leaves) const {
    const TypedArray<Dictionary> none;
    for (const int32_t level : p_levels) {
        ERR_FAIL_COND_V_MSG(level < 0, none,
                            vformat("There is no level of detail %d; 0 is the finest.", level));
    }
    for (const int32_t budget : p_budgets) {
        ERR_FAIL_COND_V_MSG(budget < 0, none,
                            "A budget is a number of triangles, or 0 for the level's own number.");
    }
    return guarded(none, [&] {
        const std::shared_ptr<const treerec::Tree> tree = get_tree();
        const std::shared_ptr<const treerec::Foliage> foliage = get_leaf_density();
        std::vector<treerec::LeafKind> kinds = make_leaf_kinds(*tree);
        if (!p_leaves)
            for (treerec::LeafKind& kind : kinds)
                kind.rules.standing = 0.0;
        const std::shared_ptr<const treerec::GrownBark> bark = get_bark_on(tree);
        const treerec::LevelBuilder builder(*tree, kinds, uint64_t(get_seed()), *foliage, nullptr,
                                            bark.get());
        const treerec::Bounds& box = builder.box();
        TypedArray<Dictionary> levels;
        for (int64_t i = 0; i < p_levels.size(); i++) {
            const int32_t budget = i < p_budgets.size() ? p_budgets[i] : 0;
            const treerec::TreeLevel made = builder.build(p_levels[i], size_t(budget));
            Dictionary level;
            level["bark"] = to_surface_arrays(made.bark);
            TypedArray<Dictionary> parts;
            for (size_t kind = 0; kind < kinds.size(); kind++) {
                const treerec::LevelLeaves& leaves = made.foliage[kind];
                Dictionary part = _describe_kind(kinds[kind], 0.0);
                if (p_joined) {
                    part["arrays"] = to_surface_arrays(treerec::join_leaves(leaves.leaves, leaves.card));
                } else {
                    part["leaves"] = to_godot(treerec::leaf_buffer(leaves.leaves));
                    part["card"] = to_surface_arrays(leaves.card);
                }
                parts.push_back(part);
            }
            if (p_joined) {
                level["joined_foliage"] = parts;
            } else {
                const Dictionary own = parts[0];
                level["foliage"] = parts;
                level["leaves"] = own["leaves"];
                level["card"] = own["card"];
            }
            level["box"] = box.empty() ? AABB() : AABB(to_godot(box.min), to_godot(box.size()));
            level["triangles"] = int64_t(made.triangle_count());
            level["level"] = made.level;
            level["warning"] = to_godot(made.warning);
            levels.push_back(level);
        }
        return levels;
    });
}

void TreeReconstruction::_bind_levels() {
    ClassDB::bind_method(D_METHOD("build_levels", "levels", "budgets", "joined", "leaves"),
                         &TreeReconstruction::build_levels, DEFVAL(PackedInt32Array()), DEFVAL(false),
                         DEFVAL(true));
}
