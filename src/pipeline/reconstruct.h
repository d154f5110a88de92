// The whole way from a scan file to a tree: what the program, the demo and the editor all run.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "edit/prune/prune.h"
#include "fidelity/score.h"
#include "foliage/foliage.h"
#include "pipeline/export.h"
#include "pipeline/reconstruct_cache.h"
#include "progress.h"
#include "scan/cleaning/clean_cloud.h"
#include "scan/formats/read_cloud.h"
#include "scan/point_cloud.h"
#include "skeleton/cylinders/radius_rules.h"
#include "skeleton/skeleton.h"
#include "stage_clock.h"
#include "tree/measure.h"
#include "tree/tree.h"

namespace treerec {

struct ReconstructOptions {
    ReadCloudOptions read;
    OrientOptions orient;
    CleanOptions clean;
    // Walk over what the tree does not explain and add what is found (completion/complete_all.h); not for
    // palms.
    bool complete = false;
    // Cut twigs that are longer than the mean at last (Chen 2025, algorithm 3).
    std::optional<PruneOptions> prune;
    bool tell_leaves = true;  // tell leaves from wood; without it everything is taken for wood
    SkeletonOptions skeleton;
    RadiusRule radii = RadiusRule::kMeasured;  // of the whole tree, whichever way it was found
    size_t score_points = 200000;              // about how many points the fit is measured on
};

struct Reconstruction {
    PointCloud cloud;   // cleaned, in the tree's frame: its points lie on the tree
    Tree raw;           // before pruning and simplification; same frame
    Tree tree;          // root at (0,0,0), metres, Y up
    Foliage foliage;    // what the scan saw of leaves, in the tree's frame; empty for a bare tree
    bool palm = false;  // its leaves are fronds
    size_t points_read = 0;
    size_t leaf_points = 0;   // of the cloud
    std::string leaf_column;  // of the scan's file, where that told them; else empty
    // By point of the cloud, 0 for leaves and for what grows around the base; empty where all is wood.
    std::vector<uint8_t> wood;
    double spacing = 0.0;  // metres: what the skeletonizer thinned to
    // Of the voxel flood alone (skeleton/skeleton.h).
    double voxel = 0.0;  // metres; 0 with the other method
    CloudKind kind = CloudKind::kSurface;
    bool kind_told = false;
    std::vector<FloodStep> steps;  // in the tree's frame
    double noise = 0.0;            // metres, where the scan is noisy all over; else 0
    size_t completed = 0;          // branches that were added afterwards
    double completed_length = 0.0;
    size_t pruned = 0;  // nodes that were cut away at last
    ReadCloudReport read;
    OrientReport orient;
    CleanReport clean;
    Measurements measured;          // of the tree
    ScanScore fit;                  // of the tree to the cleaned cloud's wood
    std::vector<StageTime> stages;  // "Read", "Orient", "Clean", "Leaves", the skeletonizer's own, "Score"
    std::vector<std::string> warnings;  // of all stages, in order
};

// The cleaned points that fidelity is measured with: those of the wood, or all where all are leaves. Places
// alone.
PointCloud wood_of(const Reconstruction& result);

// The leaf preset that the user asked for, or, for "auto", one that suits what was found: "palm" or
// "generic".
std::string chosen_leaves(const std::string& asked, const Reconstruction& result);

// The rules of a preset, with fronds as long as the scan's where the tree is a palm. Throws Error for a name
// that is none.
LeafRules suited_leaves(const std::string& preset, const Reconstruction& result);

// The two halves of reconstruct_file(): everything but `measured`, `fit` and the warnings that stand on them;
// and those. The second one reads nothing but the options and what the first one made, and the first half's
// tree, cloud and foliage may be read meanwhile. A tree that was measured since then is not measured again.
Reconstruction reconstruct_tree(const std::string& path, const ReconstructOptions& options,
                                Progress* progress = nullptr, ReconstructCache* cache = nullptr);
void score_reconstruction(Reconstruction& result, const ReconstructOptions& options,
                          Progress* progress = nullptr);

// reconstruct_tree() of a cloud that was read before. path: of its file, beside which its photos may lie;
// empty for one that is in none.
Reconstruction reconstruct_cloud(const PointCloud& cloud, const ReadCloudReport& read,
                                 const std::string& path, const ReconstructOptions& options,
                                 Progress* progress = nullptr);

// Throws Error with a sentence, or Cancelled.
// cache: if given, stages that it has with the same options of the same file are taken from it
// (StageTime::kept says which), and it gets those that were done; it changes nothing else.
Reconstruction reconstruct_file(const std::string& path, const ReconstructOptions& options,
                                Progress* progress = nullptr, ReconstructCache* cache = nullptr);

// The scan that a tree was made from, as points in the tree's own frame (metres, so that they lie on its
// bark): read again, cleaned as `options` say with the frame's way up and unit, of several trees the one that
// stands at its origin, and thinned to at most
// `most` points (scan/cleaning/thin_cloud.h). options: those of read and clean count. cache: may have the
// file read. Throws Error with a sentence, or Cancelled.
PointCloud load_scan(const std::string& path, const ReconstructOptions& options, const ScanFrame& frame,
                     size_t most, Progress* progress = nullptr, ReconstructCache* cache = nullptr);

}  // namespace treerec
