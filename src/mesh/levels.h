// Levels of detail: the one place that says what level k of a tree is.
//
// All levels are of one skeleton and one set of leaves: everything random is used up before, so that they
// have the same silhouette and, the wind being a function of the place, the same motion. Level k
//   - has half the sides of level k - 1, and rings only where the axis bends by more than twice as much;
//   - draws an even share of the twigs that are thinner than level_width(), or short, and with a twig that is
//     not drawn goes what it bears; what stays is as much wider, so that the bark covers as much of a
//     picture as at level 0 (twig_shares.h, tube_widths.cpp). From level 2 on a tree in leaf has the twigs of
//     the next level;
//   - draws grown bark with a quarter of the vertices of level k - 1 (grown_bark.h: lighter_bark());
//   - has 0.42 of the leaves of level k - 1 where level 0 puts them, as much larger about their middles
//     (leaf_cards.h), with cards of fewer triangles; from where that would make them twice as large, sprays
//     are gathered into boughs instead (level_leaves.h).
// Wind channels and colours are functions of the place and the wood at level 0, so they are the same in all.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "foliage/foliage.h"
#include "foliage/leaves.h"
#include "geometry/bounds.h"
#include "mesh/grown_bark.h"
#include "mesh/level_leaves.h"
#include "mesh/mesh.h"
#include "progress.h"
#include "tree/tree.h"

namespace treerec {

inline constexpr int kMostLevels = 5;

// Metres: of a tree of such a height the width at which twigs begin to stand for others. At the distances
// where levels are first seen (2.5, 6, 14 and 30 heights) a pixel of a picture of 1080 lines and 75 degrees
// is about five times as wide. level: any number, doubles per level.
double level_width(double height, double level);

// What a level without a budget may have: 60,000 in all at level 0, 600 at level 3. It becomes coarser than
// it would be by itself, where it can: what no level leaves out may be more.
size_t level_triangles(double level);
size_t foliage_triangles(double level);  // of them, all leaves of a kind; bark has what leaves leave

struct TreeLevel {
    Mesh bark;
    std::vector<LevelLeaves> foliage;  // by kind of leaves (leaf_kinds())
    double level = 0.0;                // what it has become: other than asked for where a budget is given
    // A sentence where the budget could not be kept, else empty.
    std::string warning;

    size_t triangle_count() const {
        size_t count = bark.triangle_count();
        for (const LevelLeaves& kind : foliage)
            count += kind.triangle_count();
        return count;
    }
};

// Makes the levels of one tree. What they share is made once; the tree and the foliage must outlive it.
class LevelBuilder {
  public:
    // Throws Error for rules that check_leaf_rules() refuses, or Cancelled.
    // grown: drawn instead of the tubes that it covers; without lighter levels at level 0 alone. It must
    // outlive this; null: tubes alone.
    LevelBuilder(const Tree& tree, std::vector<LeafKind> kinds, uint64_t seed, const Foliage& foliage = {},
                 const Progress* progress = nullptr, const GrownBark* grown = nullptr);
    LevelBuilder(const Tree& tree, const LeafRules& rules, uint64_t seed, const Foliage& foliage = {},
                 const Progress* progress = nullptr);

    // level: 0 is the finest, which has no more than level_triangles() without a budget. budget: if not 0,
    // the finest thing between the levels, down from level 0, that has at most so many triangles of bark and
    // leaves; `level` is then of no matter. Deterministic; up to 12 times the time of one level with a
    // budget. Throws Error for a negative level, or Cancelled.
    TreeLevel build(int level, size_t budget = 0, const Progress* progress = nullptr) const;
    // Metres, around all levels at rest.
    const Bounds& box() const { return box_; }

  private:
    TreeLevel build_at(double level, bool limited, const Progress* progress) const;

    const Tree wood_;
    const std::vector<LeafKind> kinds_;
    const std::vector<std::vector<LeafPlacement>> leaves_;  // by kind
    const GrownBark* const grown_;
    Bounds box_;
};

// Whether most of a tree's wood is hidden by leaves of the first of these kinds, its own: such wood needs
// fewer twigs from afar.
bool hide_twigs(const std::vector<LeafKind>& kinds);

struct LevelBark {
    bool hidden = false;               // see hide_twigs()
    bool whole_repeats = false;        // see TubeOptions
    bool limited = true;               // to level_triangles()
    const GrownBark* grown = nullptr;  // see LevelBuilder
    size_t leaves = 0;                 // triangles that the level has of leaves
};

// The bark alone, of a level or between two: wood is what leafy_tree() makes of a tree.
Mesh build_level_bark(const Tree& wood, double level, const LevelBark& how = {},
                      const Progress* progress = nullptr);

}  // namespace treerec
