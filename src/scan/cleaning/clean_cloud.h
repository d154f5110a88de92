// Turns a raw cloud upright and to metres, and removes what is not tree (Chen 2025, 3.2.1).
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "progress.h"
#include "scan/point_cloud.h"
#include "scan/stems/pick_tree.h"

namespace treerec {

// A length that the user measured: two places in the scan's coordinates and the metres between them.
struct KnownLength {
    DVec3 from{0.0};
    DVec3 to{0.0};
    double metres = 0.0;

    bool operator==(const KnownLength&) const = default;
};

// At most one of metres_per_unit, known_height and known_length sets the scale; where none does, the file's
// own unit does (PointCloud::unit), or it is guessed from the size (metres unless implausible), and said so.
struct OrientOptions {
    std::optional<UpAxis> up = std::nullopt;  // none: detect Z, Y or -Y; Z where the shape does not tell
    std::optional<double> metres_per_unit = std::nullopt;
    std::optional<double> known_height = std::nullopt;  // metres, of the whole tree
    std::optional<KnownLength> known_length = std::nullopt;
    DVec3 tilt{0.0};    // with `up`: ScanFrame::tilt
    size_t photos = 0;  // whose cameras told `up` and `tilt`; 0 where the user did

    bool operator==(const OrientOptions&) const = default;
};

struct OrientReport {
    UpAxis up = UpAxis::kZ;
    bool up_detected = false;
    size_t photos = 0;  // whose cameras told the way up
    double metres_per_unit = 1.0;
    bool scale_guessed = false;
    bool scale_unknown = false;  // guessed, and a cloud of this kind has no scale of its own
    std::vector<std::string> warnings;
};

// Changes the cloud to tree space: metres, Y up; positions, normals and frame agree afterwards. Leaves out
// points without a finite place or absurdly far away; normals that are not finite become zero. Throws Error
// for an empty cloud, for more than one scale and for a scale or length that is not positive.
OrientReport orient_cloud(PointCloud& cloud, const OrientOptions& options, Progress* progress = nullptr);

// After cleaning, when the cloud is the tree alone: makes it options.known_height high to the millimetre.
// Does nothing where no height is known.
void settle_height(PointCloud& cloud, const OrientOptions& options, OrientReport& report);

// Each step can be switched off. Units: metres.
struct CleanOptions {
    bool remove_extreme_colors = true;  // near white and near black, where the cloud has real colours
    int white_above = 250;              // every channel at or above this is near white
    int black_below = 5;                // every channel at or below this is near black
    bool remove_outliers = true;
    int neighbours = 10;              // k of the k-nearest-neighbour mean distance
    double outlier_deviations = 6.0;  // removed beyond median + this many robust standard deviations
    bool remove_fragments = true;     // small clusters far from the rest
    bool remove_ground = true;        // and walls
    PickOptions pick;                 // which tree, where the cloud holds several

    bool operator==(const CleanOptions&) const = default;
};

struct CleanStep {
    std::string name;    // "Extreme colours", "Outliers", "Ground", "Walls", "Other trees", "Beside the
                         // tree" (where there are any), "Fragments"
    size_t removed = 0;  // points
};

struct CleanReport {
    std::vector<CleanStep> steps;
    PickReport pick;
    std::vector<std::string> warnings;
};

// Cleans an oriented cloud. Never empties it: a step that would take more than 90 % of the points is left out
// with a warning; one tree of many is no such step. Throws Error for an empty cloud and for a tree that there
// is not, Cancelled on request.
CleanReport clean_cloud(PointCloud& cloud, const CleanOptions& options, Progress* progress = nullptr);

// Which of the trees each point of an oriented cloud is given to: an index into report.trees (0 where the
// cloud is taken for one tree), or kNoTree for what is left out before and for clutter. Colours are not
// looked at. Throws as clean_cloud().
inline constexpr uint32_t kNoTree = std::numeric_limits<uint32_t>::max();
std::vector<uint32_t> label_trees(PointCloud cloud, const CleanOptions& options, PickReport& report,
                                  Progress* progress = nullptr);

// The same of a part of a plot, most of which may be ground; that is kOnGround.
inline constexpr uint32_t kOnGround = kNoTree - 1;
std::vector<uint32_t> label_plot(PointCloud cloud, const CleanOptions& options, PickReport& report,
                                 Progress* progress = nullptr);

}  // namespace treerec
