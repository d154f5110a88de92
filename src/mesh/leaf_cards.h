// Leaf geometry: the one card that a MultiMesh repeats, and all cards baked into one mesh for files.
#pragma once

#include <vector>

#include "foliage/leaves.h"
#include "geometry/bounds.h"
#include "mesh/mesh.h"
#include "progress.h"

namespace treerec {

// The card of size 1: base at the origin, tip at +Y, upper face +Z. level 0 is the finest; each further one
// has fewer triangles. What it shows, and of which picture uv are (v = 1 at the base), is the rules' form: a
// spray is one card over the whole spray picture, all others are put together from the picture of one blade,
// whose stalk (kBladeStalk) serves as petiole, rachis and wood too. A fold of 10 degrees or more is there at
// every level, which costs a flat card a second row of quads; a smaller one at level 0 alone. Throws Error
// for a sprig of more than kMostSprigParts pieces.
Mesh build_leaf_card(const LeafRules& rules, int level = 0);
Mesh build_leaf_card(int level = 0);  // of a spray

inline constexpr float kBladeStalk = 0.1f;        // the share of the blade's picture below the blade
inline constexpr float kBladeStalkWidth = 0.04f;  // of the picture
inline constexpr size_t kMostSprigParts = 4096;

// Whether the rules' card shows the picture of one blade rather than that of a spray.
bool uses_blade_picture(const LeafRules& rules);

// Whether its picture is shown from right to left, as it is on every other leaf: from near two sprays beside
// each other that are the same catch the eye. leaf.gdshader does the same.
bool shows_mirrored(const LeafPlacement& leaf);

// Every leaf as geometry for programs that have no shader of ours: its upper face, and its lower one a hair
// below with vertices of its own, so that neither needs a material of two sides, whose normals such programs
// turn to whoever looks. Both have normals outward of the crown, as far as a face can that looks inward. Wind
// channels in colors; colors.g runs from 0 at the card's base to 1 at its tip. custom0 stays empty. Throws
// Error for too many leaves, or Cancelled.
Mesh bake_leaves(const std::vector<LeafPlacement>& leaves, const Mesh& card,
                 const Progress* progress = nullptr);
// With the cards of sprays.
Mesh bake_leaves(const std::vector<LeafPlacement>& leaves, int level = 0, const Progress* progress = nullptr);

// Which leaves a level of detail keeps, and how much larger it draws them: fewer, larger, the same area, and
// about the same middles, so that the crown keeps its outline. Levels may lie between the whole ones; what
// one keeps, all finer ones do. Where there are no more than 64, all stay as they are up to level 4.
std::vector<LeafPlacement> thin_leaves(const std::vector<LeafPlacement>& leaves, double level);
float leaf_growth(double level);                // how much larger
double leaf_share(double level);                // how many of the leaves a level keeps, were they many
double kept_share(double level, size_t count);  // and of `count`
// Adds all that the cards of leaves may take, however they turn, each grown by `growth`.
void add_leaves(Bounds& bounds, const std::vector<LeafPlacement>& leaves, float growth = 1.0f);

// Godot's MultiMesh buffer: per leaf 12 floats of transform (3 rows of 4), 4 of colour (the outward direction
// in the leaf's own axes as rgb * 2 - 1, occlusion in a), 4 of custom data (phase, wind code of the primary
// branch, hue, wind code of the secondary branch; see foliage/wind.h).
std::vector<float> leaf_buffer(const std::vector<LeafPlacement>& leaves);

}  // namespace treerec
