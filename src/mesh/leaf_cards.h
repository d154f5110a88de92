// Leaf geometry: the one card that a MultiMesh repeats, and all cards baked into one mesh for files.
#pragma once

#include <vector>

#include "foliage/leaves.h"
#include "mesh/mesh.h"
#include "progress.h"

namespace treerec {

// The card of size 1: base at the origin, tip at +Y, upper face +Z, slightly folded and curved; uv over the
// whole leaf texture (v = 1 at the base). level 0: 4 triangles or more; higher levels 2.
Mesh build_leaf_card(int level = 0);

// Every leaf as geometry, with rounded-canopy normals and wind channels in colors; colors.g runs from 0 at
// the card's base to 1 at its tip. tangents and custom0 stay empty: this is for files. Throws Error for too
// many leaves, or Cancelled.
Mesh bake_leaves(const std::vector<LeafPlacement>& leaves, int level = 0, const Progress* progress = nullptr);

// Which leaves a level of detail keeps, and how much larger it draws them (fewer, larger, the same area).
std::vector<LeafPlacement> thin_leaves(const std::vector<LeafPlacement>& leaves, int level);

// Godot's MultiMesh buffer: per leaf 12 floats of transform (3 rows of 4), 4 of colour (the outward direction
// in the leaf's own axes as rgb * 2 - 1, occlusion in a), 4 of custom data (phase, size, hue, stiffness).
std::vector<float> leaf_buffer(const std::vector<LeafPlacement>& leaves);

}  // namespace treerec
