// From a clean cloud to a Tree: along shortest paths, as AdTree does it (Chen 2025, 2.2.2 and 3.2.2), or by
// a voxel flood (Zhang 2013, chapter 5).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "progress.h"
#include "scan/point_cloud.h"
#include "skeleton/flood/flood_steps.h"
#include "skeleton/passes.h"
#include "stage_clock.h"
#include "tree/tree.h"

namespace treerec {

// Shortest paths through neighbouring points and slices across them; AdTree's own way, a tree over the edges
// of the Delaunay triangulation (skeleton/delaunay/); or a flood through voxels.
enum class SkeletonMethod : uint8_t { kGeodesic, kDelaunay, kFlood };

// Of AdTree's way: which tree over the triangulation's edges. Both papers say minimum spanning tree and
// Dijkstra's shortest paths in one sentence; they are two trees.
enum class SpanningTreeKind : uint8_t { kShortestPaths, kMinimum };

// The flood as we do it, or as Zhang 2013 prints it (skeleton/flood/flood_paper.h), to be compared.
enum class FloodKind : uint8_t { kOurs, kPaper };

// "geodesic", "delaunay", "flood". Throws Error for any other word, naming all.
SkeletonMethod parse_skeleton_method(const std::string& word);
const char* skeleton_method_name(SkeletonMethod method);

// "paths", "minimum". Throws Error for any other word, naming both.
SpanningTreeKind parse_spanning_tree_kind(const std::string& word);
const char* spanning_tree_kind_name(SpanningTreeKind kind);

// "ours", "paper". Throws Error for any other word, naming both.
FloodKind parse_flood_kind(const std::string& word);
const char* flood_kind_name(FloodKind kind);

// Lengths in metres; 0 where a length is "automatic" (from the cloud's own spacing and size).
struct SkeletonOptions {
    SkeletonMethod method = SkeletonMethod::kGeodesic;
    SpanningTreeKind spanning_tree = SpanningTreeKind::kShortestPaths;
    FloodKind flood = FloodKind::kOurs;
    double voxel = 0.0;              // edge of the flood's voxels; 0 automatic
    bool keep_steps = false;         // fill SkeletonResult::steps
    double spacing = 0.0;            // thinning: at most one point per cell of this size; 0 automatic
    double minimum_branch = 0.0;     // shorter end branches are noise; 0 automatic
    double simplify_distance = 0.0;  // Douglas-Peucker tolerance; 0 automatic
    bool one_stem = false;           // a palm: what branches off its stem is left out
    bool trunk_alone = false;        // known to be a trunk without a crown: its sections are the tree
    std::optional<DVec3> stem_base;  // where the stem stands, where that is known; metres, as the cloud
    double noise = 0.0;              // of the points, at least, where it is known (standard deviation)
    bool fit_radii = true;           // measure radii where the points allow it
    uint64_t seed = 1;               // of the robust fits
    bool keep_raw = true;            // fill SkeletonResult::raw
    PassSet left_out;                // of the geodesic method, to measure what a pass is worth
};

struct SkeletonResult {
    Tree raw;   // the shortest-path tree before pruning and simplification, for pictures; thin constant radii
    Tree tree;  // the skeleton: trunk marked, radii measured or inferred, root at (0,0,0), frame set
    double spacing = 0.0;  // that was used
    // Of the flood alone; of the steps, positions are those of `tree`.
    double voxel = 0.0;  // that was used
    CloudKind kind = CloudKind::kSurface;
    bool kind_told = false;  // false where no wood is thick enough in voxels to tell: a surface is assumed
    std::vector<FloodStep> steps;
    std::vector<StageTime> stages;
    std::vector<std::string> warnings;
};

// cloud: oriented (metres, Y up) and clean. Throws Error if it cannot be a tree (fewer than 10 distinct
// points, all on a plane or a line, …) or for a voxel larger than the tree or too small to be numbered,
// Cancelled on request.
SkeletonResult skeletonize(const PointCloud& cloud, const SkeletonOptions& options,
                           Progress* progress = nullptr);

}  // namespace treerec
