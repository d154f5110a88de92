// A plot's cloud into one cloud per tree.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "progress.h"
#include "scan/cleaning/clean_cloud.h"
#include "scan/formats/read_cloud.h"
#include "scan/plots/plot_trees.h"

namespace treerec {

struct SplitOptions {
    ReadCloudOptions read;
    OrientOptions orient;
    double tile = 40.0;    // metres: the edge of a tile's core
    double overlap = 0.0;  // metres around it that are looked at, too; 0: by the height of what stands there
    double least_height = 2.0;  // metres
    double pixel = 0.5;         // metres: of the ground
    size_t piece = 4'000'000;   // points of a LAS file that are read at once
};

struct SplitTree {
    std::string name;  // "tree_0001": of its file, without ".ply"
    DVec3 foot{0.0};   // scan coordinates
    PlotTree tree;
};

struct SplitReport {
    std::vector<SplitTree> trees;  // along the scan's x, and then its other level axis
    size_t points = 0;             // of the plot
    size_t tiles = 0;
    double overlap = 0.0;
    bool ground = false;
    std::vector<std::string> warnings;
};

// The first line of trees.csv, by which a folder of this kind is known.
inline constexpr const char* kSplitColumns = "id,file,x,y,z,height_m,dbh_cm,points,warnings";

// Throws Error where `folder` is there and is neither empty nor of this kind. To be asked before the work.
void require_split_folder(const std::string& folder);

// Writes tree_0001.ply …, trees.csv, plot.json and, where ground is seen, ground.exr into `folder`, where
// they take the place of an earlier run's when all is done; what else is there stays. Trees stand where they
// stood in the scan. Tile by tile: memory holds the points of one tile and what is around it, and of files
// other than LAS all points' places. Throws Error (no tree, flat, what read_cloud() says …), or Cancelled.
SplitReport split_plot(const std::string& scan, const std::string& folder, const SplitOptions& options,
                       Progress* progress = nullptr);

}  // namespace treerec
