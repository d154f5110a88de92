// Where leaves sit: leaf rules turned into placements (papers/000, 3.2.5).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "foliage/foliage.h"
#include "geometry/vec.h"
#include "tree/tree.h"

namespace treerec {

enum class LeafArrangement { kAlternate, kOpposite };

// A card shows a spray: a twig's end with several leaves, so that a crown looks full with few triangles.
// Lengths in metres; on a smaller tree they shrink with the square root of its height: leaf_size and
// internode below 12 m, the others below 6 m. Angles in degrees.
struct LeafRules {
    bool enabled = true;
    LeafArrangement arrangement = LeafArrangement::kAlternate;
    double internode = 0.05;   // distance between sprays along a twig; pairs stand twice as far apart
    double twig_length = 0.6;  // how far from its tip a branch bears leaves
    double maximum_radius =
        0.02;  // thicker wood bears none, but for the tips; nor do snags (snags.h) on wood twice as thick
    double leaf_size = 0.25;      // length of a spray
    double size_variation = 0.3;  // share
    double angle = 55.0;          // between the twig and the spray
    double droop = 20.0;          // towards the ground
    double angle_variation = 20.0;
    bool follow_foliage = true;  // where the scan saw leaves (Foliage), the sprays stand there
    int maximum_leaves = 24000;  // beyond it fewer, larger leaves cover the same area
};

// "generic", "maple", "cherry", "oak", "birch", "pine", "none". Throws Error for another name, listing these.
LeafRules leaf_preset(const std::string& name);
std::vector<std::string> leaf_preset_names();

// One card. x,y,z: the card's axes (unit, right-handed): x across, y from the base to the tip, z out of
// its upper face. position: where the petiole leaves the bark. outward: unit, from the crown's centre (for
// rounded normals).
struct LeafPlacement {
    Vec3 position;
    Vec3 x, y, z;
    Vec3 outward;
    float size = 0.1f;       // metres
    float phase = 0.0f;      // 0..1 (INSTANCE_CUSTOM.x)
    float hue = 0.0f;        // 0..1 (INSTANCE_CUSTOM.z)
    float stiffness = 0.0f;  // 0..1 of its branch (INSTANCE_CUSTOM.w)
    float sway = 0.0f;       // 0..1, the bark's COLOR.r at its place
    float occlusion = 1.0f;  // 1 open to the sky .. 0 deep in the crown
};

// Sprays on the last `twig_length` of every branch, and one at every tip. An empty tree or a lone root has
// none. seed: the same seed gives the same leaves. Each leaf's random numbers belong to its place
// (hash_seed), so pruning one branch leaves the leaves of others alone.
// foliage, unless it is empty or the rules do not follow it: sprays fill its cells instead, each on the
// branch nearest to it and as many as the scan's density there asks for, none where there is no wood within
// about a metre; twigs end in a spray only where the scan saw leaves. Its colours part the hues: the less
// green, the higher.
std::vector<LeafPlacement> place_leaves(const Tree& tree, const LeafRules& rules, uint64_t seed,
                                        const Foliage& foliage = {});

}  // namespace treerec
