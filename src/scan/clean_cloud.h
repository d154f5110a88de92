// Turns a raw cloud upright and to metres, and removes what is not tree (papers/000, 3.2.1).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "progress.h"
#include "scan/point_cloud.h"

namespace treerec {

struct OrientOptions {
    std::optional<UpAxis> up;  // none: detect Z, Y or -Y; Z where the shape does not tell
    std::optional<double>
        metres_per_unit;  // none: guess from the size (metres unless implausible), and say so
};

struct OrientReport {
    UpAxis up = UpAxis::kZ;
    bool up_detected = false;
    double metres_per_unit = 1.0;
    bool scale_guessed = false;
    std::vector<std::string> warnings;
};

// Changes the cloud to tree space: metres, Y up; positions, normals and frame agree afterwards.
OrientReport orient_cloud(PointCloud& cloud, const OrientOptions& options);

// Each step can be switched off. Units: metres.
struct CleanOptions {
    bool remove_extreme_colors = true;  // near white and near black, where the cloud has real colours
    int white_above = 250;              // every channel at or above this is near white
    int black_below = 5;                // every channel at or below this is near black
    bool remove_outliers = true;
    int neighbours = 10;              // k of the k-nearest-neighbour mean distance
    double outlier_deviations = 6.0;  // removed beyond median + this many robust standard deviations
    bool remove_fragments = true;     // small clusters far from the rest
    bool remove_ground = true;
};

struct CleanStep {
    std::string name;    // "Extreme colours", "Outliers", "Fragments", "Ground"
    size_t removed = 0;  // points
};

struct CleanReport {
    std::vector<CleanStep> steps;
    std::vector<std::string> warnings;
};

// Cleans an oriented cloud. Never empties it: a step that would take more than 90 % of the points is left out
// with a warning.
CleanReport clean_cloud(PointCloud& cloud, const CleanOptions& options, Progress* progress = nullptr);

}  // namespace treerec
