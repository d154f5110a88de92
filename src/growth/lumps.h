// What a scan shows beside the round wood of its tree, as lines of a recipe: lumps become burls, deep dents
// hollows, and what winds about the trunk the grain's twist.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "growth/recipe.h"
#include "progress.h"
#include "scan/point_cloud.h"
#include "tree/tree.h"

namespace treerec {

struct GrowthProposal {
    std::string recipe;  // a line each, thickest branch first, to be added to the recipe
    size_t burls = 0, hollows = 0, sections = 0;
    double twist = 0.0;                // radians a metre, of the grain; 0: none was seen
    std::vector<std::string> remarks;  // sentences for the user
};

// recipe: how fine the surface is to be, and in how many steps; what it has beside that is not looked at. The
// cloud is the one that the tree was made of, best without ground and leaves; each has its own frame. Where
// the scan shows no bark nothing is proposed. The same tree, cloud and recipe give the same text. Throws
// Error for an empty cloud, for a tree without wood that is thick enough, and in a build without CGAL;
// Cancelled.
//
// Residuals of the scan on the unrolled bark, smoothed by normalised convolution (Knutsson and Westin 1993),
// are explained by the burls' own profiles one after the other (matching pursuit, Mallat and Zhang 1993),
// whose heights are then fitted together.
GrowthProposal propose_growth(const Tree& tree, const PointCloud& cloud, const GrowthRecipe& recipe,
                              Progress* progress = nullptr);

}  // namespace treerec
