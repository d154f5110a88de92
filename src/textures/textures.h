// Bark and leaf pictures made from nothing but a seed, so that a tree has a look without any asset.
#pragma once

#include <cstdint>
#include <string>

#include "mesh/image.h"

namespace treerec {

// Seamless both ways. One repeat covers about a metre of bark.
struct BarkTextures {
    Image albedo;     // RGB, sRGB
    Image normal;     // RGB, tangent space, green up (glTF and Godot)
    Image roughness;  // RGB: occlusion, roughness, metallic (0), as glTF and Godot's ORM materials pack them
};

// A twig with its leaves, growing from the middle of the lower edge to the top.
struct LeafTextures {
    Image albedo;  // RGBA, sRGB, alpha for cut-out; the transparent part carries the leaves' mean colour
    Image normal;  // RGB, tangent space, green up
};

// preset: a leaf preset's name (foliage/leaf_rules.h). size: pixels along an edge, 16..4096. The same
// arguments give the same bytes. Throw Error for an unknown preset or another size.
BarkTextures make_bark_textures(const std::string& preset, int size, uint64_t seed);
LeafTextures make_leaf_textures(const std::string& preset, int size, uint64_t seed);

// One leaf, or one leaflet of a compound leaf, that fills the picture above its stalk (kBladeStalk in
// mesh/leaf_cards.h) whatever its width: LeafRules::blade_width gives it its shape back.
LeafTextures make_blade_textures(const std::string& preset, int size, uint64_t seed);

}  // namespace treerec
