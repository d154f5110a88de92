// The whole way from a scan file to a tree with leaves, and from there to files: what the program, the demo and the
// editor all run.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "foliage/leaves.h"
#include "progress.h"
#include "scan/clean_cloud.h"
#include "scan/point_cloud.h"
#include "scan/read_cloud.h"
#include "skeleton/skeleton.h"
#include "tree/measure.h"
#include "tree/tree.h"

namespace treerec {

struct ReconstructOptions {
    ReadCloudOptions read;
    OrientOptions orient;
    CleanOptions clean;
    SkeletonOptions skeleton;
};

struct StageTime {
    std::string name;  // "Read", "Orient", "Clean", and the skeletonizer's own
    double milliseconds = 0.0;
    size_t count = 0;  // points or nodes after the stage
};

struct Reconstruction {
    PointCloud cloud;  // cleaned, in the tree's frame: its points lie on the tree
    Tree raw;          // before pruning and simplification; same frame
    Tree tree;
    size_t points_read = 0;
    ReadCloudReport read;
    OrientReport orient;
    CleanReport clean;
    std::vector<StageTime> stages;
    std::vector<std::string> warnings;  // of all stages, in order
};

// Throws Error with a sentence, or Cancelled.
Reconstruction reconstruct_file(const std::string& path, const ReconstructOptions& options,
                                Progress* progress = nullptr);

// Writes `tree` in the format that the extension of `path` names: .glb .gltf .obj (Godot's frame: metres, Y up, base at
// the origin; with leaves) or .ply .txt .csv (the skeleton in scan coordinates). Throws Error for another extension.
void export_tree(const std::string& path, const Tree& tree, const LeafRules& leaves, uint64_t seed);

// report.json: stage times, counts, measurements, warnings, options. Numbers only finite.
std::string report_json(const std::string& scan_path, const Reconstruction& result, uint64_t seed);

}  // namespace treerec
