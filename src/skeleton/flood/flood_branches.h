// From flooded nodes to branches with stations, as the rest of the skeleton room knows them.
#pragma once

#include <vector>

#include "skeleton/cylinders/axis.h"
#include "skeleton/cylinders/refine.h"
#include "skeleton/flood/flood.h"

namespace treerec {

struct FloodBranches {
    std::vector<SkeletonBranch> branches;  // no slices, only stations
    std::vector<std::vector<Station>> axes;
    PointPlaces places;  // by point of the grid
};

// At every fork the child with the most wood behind it continues the branch. What lies beyond a gap of more
// than four voxels that is five times as long as all the wood behind it is left out. Between far nodes there
// are stations about a radius apart. point_count: of the points in the grid.
FloodBranches flood_branches(const FloodResult& flooded, const FloodGrid& grid, size_t point_count);

// Takes away the branches that are marked in `goes`, whose children are, too, and returns by branch which it
// is now, -1 for those that are gone. The places know nothing of it.
std::vector<int32_t> drop_branches(FloodBranches& made, const std::vector<uint8_t>& goes);

// Takes away the branches that bear nothing and do not reach `least` metres along out of their parent. The
// places know nothing of it.
void drop_short(FloodBranches& made, double least);

}  // namespace treerec
