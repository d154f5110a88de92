// Bark and leaf pictures made from nothing but a seed, so that a tree has a look without any asset.
#pragma once

#include <cstdint>
#include <string>

#include "mesh/image.h"

namespace treerec {

// Metres that one repeat of a bark's pictures covers: as wide as trees' texture coordinates have it
// (mesh/branch_tubes.h), and as high. Pixels are as wide as they are high.
inline constexpr double kBarkWidth = 0.6;
inline constexpr double kBarkLength = 1.0;
// Young bark is finer: its repeat covers this share of these.
inline constexpr double kYoungScale = 0.5;

// Seamless both ways.
struct BarkTextures {
    Image albedo;  // RGB, sRGB
    Image normal;  // RGB, tangent space, green up (glTF and Godot)
    // RGB: occlusion and roughness, as glTF and Godot's ORM materials pack them, and where theirs have the
    // metallic, which is 0 for bark and to be ignored, what moss and lichen start from: see bark.gdshader.
    // Drawn ones have half the pixels both ways.
    Image roughness;
};

enum class BarkAge { kYoung, kOld };

// A twig with its leaves, growing from the middle of the lower edge to the top.
struct LeafTextures {
    Image albedo;  // RGBA, sRGB, alpha for cut-out; the transparent part carries the leaves' mean colour
    Image normal;  // RGB, tangent space, green up
};

// Rows of a bark's pictures that are so many pixels wide.
int bark_rows(int size);

// preset: a leaf preset's name (foliage/leaf_rules.h). size: pixels along an edge, 16..4096; of bark around
// the stem, even, 16..8192. The same arguments give the same bytes. Throw Error for an unknown preset or
// another size.
BarkTextures make_bark_textures(const std::string& preset, int size, uint64_t seed,
                                BarkAge age = BarkAge::kOld);
LeafTextures make_leaf_textures(const std::string& preset, int size, uint64_t seed);

// kSprayColumns x kSprayRows sprays of so many pixels, each drawn anew; the upper left one is
// make_leaf_textures()'s. For shaders that choose one: leaf_picture.gdshaderinc.
LeafTextures make_spray_textures(const std::string& preset, int size, uint64_t seed);

inline constexpr int kSprayColumns = 3, kSprayRows = 2;

// One leaf, or one leaflet of a compound leaf, that fills the picture above its stalk (kBladeStalk in
// mesh/leaf_cards.h) whatever its width: LeafRules::blade_width gives it its shape back.
LeafTextures make_blade_textures(const std::string& preset, int size, uint64_t seed);

}  // namespace treerec
