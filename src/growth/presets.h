// The recipes that ship with us, carried in every library.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "tree/tree.h"

namespace treerec {

struct GrowthPreset {
    std::string_view name;    // "old_oak"
    std::string_view title;   // a line for a list
    std::string_view recipe;  // growth/recipe.h; for a trunk whose radius is kPresetRadius
};

// Metres, of the trunk where it is thickest above its base's flare.
inline constexpr double kPresetRadius = 0.22;

// What that is of a tree: metres, at breast height; of lower trees at the base.
double trunk_radius(const Tree& tree);

// Longest edges for a preset, metres: a fifth of the trunk's radius, at which mouths and lips show, or as
// long as it takes for growth to stay about half a minute on one core.
double preset_edges(const Tree& tree);

// By name: fence_post_swallowed, hollow_refuge, old_oak, spiral_grain.
std::span<const GrowthPreset> growth_presets();

// Throws Error for another name, listing these.
const GrowthPreset& find_growth_preset(std::string_view name);

// A recipe's text with all its lengths times `factor`, so that it looks on a trunk so much thicker as it did.
// Throws as read_growth_recipe(), but for nodes, which stay as they are written.
std::string scale_recipe(std::string_view text, double factor);

// A preset for this tree: scaled to its trunk, with edges to suit it.
std::string preset_recipe(const GrowthPreset& preset, const Tree& tree);

}  // namespace treerec
