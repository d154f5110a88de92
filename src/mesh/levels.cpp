#include "mesh/levels.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "error.h"
#include "foliage/crown.h"
#include "foliage/foliage_twigs.h"
#include "geometry/portable_math.h"
#include "mesh/branch_tubes.h"
#include "mesh/leaf_cards.h"
#include "mesh/root_flare.h"

namespace treerec {

namespace {

constexpr double kWidth = 0.0004;     // over the tree's height, at level 0
constexpr double kCoarsest = 16.0;    // a trunk of a few triangles
constexpr double kStep = 1.0 / 64;    // between two levels that a budget tells apart
constexpr double kHiding = 0.5;       // of full foliage: so much hides most of the wood,
constexpr double kFewerTwigs = 1.75;  // levels: and so many farther ones are its twigs, from level 2 on
constexpr double kFinest = 60000.0;   // triangles at level 0,
constexpr double kFewer = 4.65;       // times fewer per level,
constexpr double kOfBark = 0.57;      // and so much of them is bark at least
constexpr double kWidestBark = 1.5;   // of a node's radius
constexpr double kBase = 4.0;         // likewise, where the trunk stands on its roots

int whole(double level) {
    return static_cast<int>(level + 0.5);
}

size_t triangles_left(double level, size_t leaves) {
    return level_triangles(level) - std::min(leaves, foliage_triangles(level));
}

}  // namespace

double level_width(double height, double level) {
    return kWidth * height * portable::pow(2.0, level);
}

size_t level_triangles(double level) {
    return static_cast<size_t>(kFinest * portable::pow(kFewer, -level));
}

size_t foliage_triangles(double level) {
    return static_cast<size_t>((1.0 - kOfBark) * kFinest * portable::pow(kFewer, -level));
}

bool hide_twigs(const std::vector<LeafKind>& kinds) {
    if (kinds.empty()) return false;
    const LeafRules& own = kinds.front().rules;
    return own.enabled && own.maximum_leaves > 0 && own.standing * own.unfolded > kHiding;
}

Mesh build_level_bark(const Tree& wood, double level, const LevelBark& how, const Progress* progress) {
    TubeOptions options;
    options.most_triangles = how.limited ? triangles_left(level, how.leaves) : 0;
    options.level = whole(level);
    options.twig_level = level + (how.hidden ? kFewerTwigs * std::clamp(level - 1.0, 0.0, 1.0) : 0.0);
    options.whole_repeats = how.whole_repeats;
    GrownBark lighter;
    options.grown = bark_of_level(how.grown, level, lighter);
    return build_branch_tubes(wood, options, progress);
}

LevelBuilder::LevelBuilder(const Tree& tree, const LeafRules& rules, uint64_t seed, const Foliage& foliage,
                           const Progress* progress)
    : LevelBuilder(tree, leaf_kinds(tree, rules), seed, foliage, progress) {}

LevelBuilder::LevelBuilder(const Tree& tree, std::vector<LeafKind> kinds, uint64_t seed,
                           const Foliage& foliage, const Progress* progress, const GrownBark* grown)
    : wood_(leafy_tree(tree, kinds, foliage)),
      kinds_(std::move(kinds)),
      leaves_(place_foliage(tree, kinds_, seed, foliage)),
      grown_(grown) {
    if (progress) progress->check();
    // Collars, and wood that stands for others, are wider than the skeleton says; the trunk goes on below it.
    for (NodeId id = 0; id < wood_.id_end(); id++)
        if (wood_.contains(id)) box_.add(wood_.node(id).position, kWidestBark * wood_.node(id).radius);
    if (!wood_.empty()) {
        const double wider = 2.0 * level_width(box_.size().y, kMostLevels - 1);
        box_.min -= wider;
        box_.max += wider;
        const Node& root = wood_.node(wood_.root());
        const double depth = foot_depth(measure_crown(wood_).height);
        box_.add(root.position, kBase * root.radius);
        box_.add(root.position - DVec3(0.0, depth, 0.0), kBase * root.radius);
    }
    if (grown_)
        for (const GrownBark::Vertex& vertex : grown_->vertices)
            box_.add(DVec3(vertex.position), grown_->parents.empty() ? 0.0 : kMostSwell * vertex.radius);
    for (size_t kind = 0; kind < kinds_.size(); kind++) {
        for (int level = 0; level < kMostLevels; level++)
            add_leaves(box_, leaves_of_level(leaves_[kind], kinds_[kind].rules, level).leaves);
        // Between two levels, leaves may be larger than at both.
        std::vector<LeafPlacement> largest = leaves_[kind];
        for (LeafPlacement& leaf : largest)
            leaf.size *= static_cast<float>(kMostGrowth);
        add_leaves(box_, largest);
    }
}

TreeLevel LevelBuilder::build_at(double level, bool limited, const Progress* progress) const {
    TreeLevel made;
    made.level = level;
    for (size_t kind = 0; kind < kinds_.size(); kind++)
        made.foliage.push_back(leaves_of_level(leaves_[kind], kinds_[kind].rules, level, limited));
    const LevelBark how{hide_twigs(kinds_), false, limited, grown_, made.triangle_count()};
    made.bark = build_level_bark(wood_, level, how, progress);
    return made;
}

TreeLevel LevelBuilder::build(int level, size_t budget, const Progress* progress) const {
    if (level < 0) throw Error("There is no level of detail " + std::to_string(level) + "; 0 is the finest.");
    if (budget == 0) return build_at(level, true, progress);
    TreeLevel made;
    for (const bool limited : {false, true}) {
        made = build_at(0.0, limited, progress);
        if (made.triangle_count() <= budget) return made;
    }
    // The finest that keeps the budget lies between these.
    double finer = 0.0, coarser = kCoarsest;
    made = build_at(coarser, false, progress);
    if (made.triangle_count() > budget) {
        made.warning = "A level of " + std::to_string(budget) +
                       " triangles was asked for, but this tree has " +
                       std::to_string(made.triangle_count()) + " at least. Give the level a larger budget.";
        return made;
    }
    while (coarser - finer > kStep) {
        const double between = 0.5 * (finer + coarser);
        TreeLevel tried = build_at(between, false, progress);
        if (tried.triangle_count() > budget) {
            finer = between;
        } else {
            coarser = between;
            made = std::move(tried);
        }
    }
    return made;
}

}  // namespace treerec
