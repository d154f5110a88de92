// How faithfully a tree shows its scan: the paper's measure (Zhang 2013, chapter 7) and the field's own, as a
// whole, by order, by branch, and for every point and node; kept up to date while the tree is edited.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "fidelity/photo_fidelity.h"
#include "progress.h"
#include "scan/point_cloud.h"
#include "tree/tree.h"

namespace treerec {

struct FidelityOptions {
    // Metres. A point within it of the bark is explained; one within it of the paper's solid counts as in it.
    double tolerance = 0.02;
    double patch = 0.05;  // metres: edge of the pieces of bark that a point covers
};

// A part of the tree and the points that lie nearest to its bark. Distances are from a point to the nearest
// bark (ScanScore's: each segment a cylinder of its child's radius), whichever side of it, in metres; zero
// where there are no points.
struct FidelityPart {
    size_t points = 0;
    double explained = 0.0;  // share of the points within the tolerance of the bark
    double median = 0.0;
    double p95 = 0.0;
    double mean = 0.0;
    double length = 0.0;    // of the wood
    double bark = 0.0;      // square metres that can be seen: not what lies inside the parent branch
    double coverage = 0.0;  // share of that with an explained point on it, piece by piece
};

struct Fidelity {
    size_t points = 0;
    double tolerance = 0.0;
    // R_s (definition 7.4): the share of the points within the balls around the nodes and the frusta between
    // them; with the tolerance, and with none.
    double skeleton = 0.0;
    double skeleton_strict = 0.0;
    FidelityPart all;
    std::vector<FidelityPart> by_order;  // 0: the trunk; as list_branches() counts
    std::vector<FidelityPart> branches;  // as list_branches() lists them

    // For a heat map. By point of the cloud: metres to the nearest bark, negative inside, and the node at the
    // upper end of that wood.
    std::vector<float> point_error;
    std::vector<NodeId> point_node;
    // By node id, of the points nearest to the node's own wood: their number and mean distance (metres; 0
    // without points).
    std::vector<uint32_t> node_points;
    std::vector<float> node_error;

    bool explains(size_t point) const;
};

// Q = I . R_3d . R_s (definition 7.1).
double modelling_fidelity(const PhotoFidelity& photos, const Fidelity& fidelity);

// Measures again after every edit, looking only at points near what changed; the figures are those of a new
// measurement, to the bit. Not for several threads at once.
class FidelityTracker {
  public:
    // The cloud is copied. Throws Error if it is empty or the options are out of range.
    explicit FidelityTracker(const PointCloud& cloud, const FidelityOptions& options = {});
    ~FidelityTracker();
    FidelityTracker(FidelityTracker&&) noexcept;
    FidelityTracker& operator=(FidelityTracker&&) noexcept;

    // The first call looks at all points, O(points log segments); the next ones at those that lie nearest to
    // wood that went or moved, and at those that new wood is nearer to. Cloud and tree may lie in different
    // frames. Throws Error for a tree without wood, or Cancelled; the figures are then as they were.
    const Fidelity& update(const Tree& tree, const Progress* progress = nullptr);

    // Of the last update, and of the one before it (nothing before the second).
    const Fidelity& current() const;
    const std::optional<Fidelity>& previous() const;
    // How many points the last update measured anew.
    size_t points_measured() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

// Once: a tracker's first update.
Fidelity measure_fidelity(const Tree& tree, const PointCloud& cloud, const FidelityOptions& options = {},
                          const Progress* progress = nullptr);

// A lighter tree (edit/lighten/lighten.h) and how faithful it is.
struct LevelFidelity {
    size_t nodes = 0;
    double skeleton = 0.0;  // R_s
    FidelityPart all;
};

// The tree itself and lightened to a half, a quarter and so on of its nodes: `levels` of them, fewer where it
// cannot be lightened further. Throws as measure_fidelity().
std::vector<LevelFidelity> measure_levels(const Tree& tree, const PointCloud& cloud, int levels = 4,
                                          const FidelityOptions& options = {},
                                          const Progress* progress = nullptr);

}  // namespace treerec
