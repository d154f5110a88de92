// What a recipe asks for, as the surface needs it. Internal to growth/.
#pragma once

#include <string>
#include <vector>

#include "growth/feature.h"
#include "growth/obstacles.h"
#include "growth/recipe.h"
#include "growth/tree_plan.h"

namespace treerec::growth {

// Takes the recipe's sections into the plan, before the others are asked.
void add_sections(const Tree& tree, const BranchList& list, const GrowthRecipe& recipe,
                  std::vector<std::string>& remarks, TreePlan& planned);
// What has no place on this tree is left out, with a sentence among the remarks. Both throw Error for files
// that can't be read.
std::vector<Feature> features_of(const Tree& tree, const BranchList& list, const TreePlan& planned,
                                 const GrowthRecipe& recipe, std::vector<std::string>& remarks);
// Throws Error, too, for one that stands where the tree's seed lies.
void add_obstacles(const Tree& tree, const BranchList& list, const TreePlan& planned,
                   const GrowthRecipe& recipe, std::vector<std::string>& remarks, Obstacles& obstacles);

}  // namespace treerec::growth
