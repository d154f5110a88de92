// The whole way from a scan file to a tree: what the program, the demo and the editor all run.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fidelity/score.h"
#include "pipeline/export.h"
#include "progress.h"
#include "scan/clean_cloud.h"
#include "scan/point_cloud.h"
#include "scan/read_cloud.h"
#include "skeleton/skeleton.h"
#include "stage_clock.h"
#include "tree/measure.h"
#include "tree/tree.h"

namespace treerec {

struct ReconstructOptions {
    ReadCloudOptions read;
    OrientOptions orient;
    CleanOptions clean;
    SkeletonOptions skeleton;
    size_t score_points = 200000;  // about how many points the fit is measured on
};

struct Reconstruction {
    PointCloud cloud;  // cleaned, in the tree's frame: its points lie on the tree
    Tree raw;          // before pruning and simplification; same frame
    Tree tree;         // root at (0,0,0), metres, Y up
    size_t points_read = 0;
    double spacing = 0.0;  // metres: what the skeletonizer thinned to
    ReadCloudReport read;
    OrientReport orient;
    CleanReport clean;
    Measurements measured;              // of the tree
    ScanScore fit;                      // of the tree to the cleaned cloud
    std::vector<StageTime> stages;      // "Read", "Orient", "Clean", the skeletonizer's own, "Score"
    std::vector<std::string> warnings;  // of all stages, in order
};

// Throws Error with a sentence, or Cancelled.
Reconstruction reconstruct_file(const std::string& path, const ReconstructOptions& options,
                                Progress* progress = nullptr);

}  // namespace treerec
