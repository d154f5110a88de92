// The trees of one tile of a plot, and which tile's they are.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "progress.h"
#include "scan/plots/plot_tiles.h"
#include "scan/point_cloud.h"

namespace treerec {

struct PlotTree {
    DVec3 foot{0.0};      // metres, tree space
    double height = 0.0;  // metres
    double dbh = 0.0;     // metres: of a circle through what is seen at breast height; 0: none is
    size_t points = 0;
    std::vector<std::string> warnings;
    size_t tile = 0;
    double depth = 0.0;  // metres from the border of its tile's core; negative outside
};

struct TileTrees {
    std::vector<PlotTree> trees;
    std::vector<std::vector<uint32_t>> points;  // of the tile's cloud, by tree
    std::vector<uint32_t> ground;               // points of the tile's cloud
};

// What stands in the tile, with stems in its core or close to it, and at least so high. cloud: the tile and
// what lies around it, oriented. plot: the ground that the scan covers.
TileTrees find_tile_trees(const PointCloud& cloud, const TileCore& core, const TileCore& plot,
                          double least_height, Progress* progress);

// Which of all tiles' trees stay, by index: of those that two tiles found in one place, that of the tile in
// whose core its stem stands deeper. In the order of their places, along x and then z.
std::vector<size_t> choose_plot_trees(const std::vector<PlotTree>& trees);

}  // namespace treerec
