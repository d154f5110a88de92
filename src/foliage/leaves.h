// Where leaves sit: leaf rules turned into placements (Chen 2025, 3.2.5).
#pragma once

#include <cstdint>
#include <vector>

#include "foliage/foliage.h"
#include "foliage/leaf_rule_text.h"
#include "foliage/leaf_rules.h"
#include "geometry/vec.h"
#include "tree/tree.h"

namespace treerec {

// One card. x,y,z: the card's axes (unit, right-handed): x across, y from the base to the tip, z out of
// its upper face. position: where the petiole leaves the bark. outward: unit, out of the leaves around it and
// of the crown (for rounded normals; leaf_area_grid.h).
struct LeafPlacement {
    Vec3 position;
    Vec3 x, y, z;
    Vec3 outward;
    float size = 0.1f;       // metres
    Vec2 wind{0.0f};         // WindGroups::codes() of primary and secondary branch (INSTANCE_CUSTOM.y, w)
    float phase = 0.0f;      // 0..1 (INSTANCE_CUSTOM.x)
    float hue = 0.0f;        // 0..1 (INSTANCE_CUSTOM.z)
    float stiffness = 0.0f;  // 0..1 of its branch
    float sway = 0.0f;       // 0..1, the bark's COLOR.r at its place
    float occlusion = 1.0f;  // of light from all sides: 1 at a crown's edge .. 0.35 deep in it
    float terminal = 0.0f;   // 1 at a twig's end, else 0
    float hold = 1.0f;       // 0..1: it falls when that share of the leaves has fallen
};

// Leaves on the last `twig_length` of every branch, and one at every tip. An empty tree or a lone root has
// none. seed: the same seed gives the same leaves. Each leaf's random numbers belong to its place
// (hash_seed), so pruning one branch leaves the leaves of others where they are, though in other light, and a
// leaf that a smaller density or share of standing leaves keeps is the same one.
// foliage, unless it is empty or the rules do not follow it: leaves fill its cells instead, each on the
// branch nearest to it and as many as the scan's density there asks for, none where there is no wood within
// about a metre; twigs end in a leaf only where the scan saw leaves. Between, with follow_density f, a share
// f of such leaves stands beside a share 1 - f of the rules' own. Its colours part the hues: the less
// green, the higher.
// All wood bears by these rules, whatever Tree::leaf_rules() says.
// Throws Error for rules that check_leaf_rules() refuses.
std::vector<LeafPlacement> place_leaves(const Tree& tree, const LeafRules& rules, uint64_t seed,
                                        const Foliage& foliage = {});

// The leaves of each kind on the wood that has it: a leaf is of the kind of the node above it, one at a tip
// or in a scan's foliage of the node that it hangs on. Each kind's leaves are where place_leaves() stands
// them by its rules, unless they are more than its maximum_leaves. kinds: leaf_kinds() of the tree.
std::vector<std::vector<LeafPlacement>> place_foliage(const Tree& tree, const std::vector<LeafKind>& kinds,
                                                      uint64_t seed, const Foliage& foliage = {});

}  // namespace treerec
