// The thin wood that a flood's lines run between.
#pragma once

#include <vector>

#include "skeleton/flood/flood_branches.h"
#include "skeleton/geodesics/root.h"
#include "skeleton/twigs/twigs.h"

namespace treerec {

// drop_strips(); the points of branches that go have no place any more. The places must be of these branches.
void drop_flood_strips(FloodBranches& made, double least_escape);

// Takes away the branches that bear nothing and reach less than `escape` metres out of the bark of a branch
// that is thicker at its base than `stout`, its radius in metres. The places know nothing of it.
void drop_beside_stout(FloodBranches& made, double stout, double escape);

// Voxels must be as wide as the points are apart, and a scan of a fine crown has several twigs within that:
// the flood takes them for one neighbourhood and fits one line between them. Where voxels lie off the bark of
// all branches, the shortest ways back to it through the voxels are branches too (add_twigs()). Where
// voxels hold several points, they are fine enough for the wood, and what is left over is bark. The places
// are made anew: points that nothing explains have none. Throws Cancelled.
void add_flood_twigs(const std::vector<Vec3>& points, const FloodGrid& grid, const LocalScale& scale,
                     const RootGuess& root, const TwigOptions& options, FloodBranches& made,
                     Progress& progress);

}  // namespace treerec
