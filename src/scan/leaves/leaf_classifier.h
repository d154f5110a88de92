// Tells leaf points from wood. Internal to scan/.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "geometry/point_tree.h"
#include "progress.h"
#include "scan/leaves/leaf_cells.h"
#include "scan/leaves/leaf_network.h"
#include "scan/leaves/leaf_paths.h"

namespace treerec {

// What is known of a cell: by scale linearity, planarity, scatter, occupied, crowd (the coarsest without the
// first two), then the members of CellPath.
inline constexpr size_t kCellInputs = 28;
// And of a point: its cell's; how its 8, 16, 32 and 64 nearest lie, and the straightest line through it among
// them. Nothing here is the same for a whole scan: there are too few scans to fit anything to that.
inline constexpr size_t kNearScales = 4, kShapeInputs = 6, kLineInputs = 6;
inline constexpr size_t kPointInputs = kCellInputs + kNearScales * (kShapeInputs + kLineInputs) + kLineInputs;
// Of the logits that come of these: its own, its neighbours', those along its line and its path.
inline constexpr size_t kContextInputs = 21;

// Fills in kCellInputs. shapes: kShapeScales of them.
void cell_inputs(const CellShape* shapes, const CellPath& path, float* inputs);

// Twigs and leaves differ less in how a point's neighbours lie than in what those are themselves: one network
// looks at each point, another at what the first said of all around it (auto-context, Tu 2008).
class LeafClassifier {
  public:
    // points: metres, distinct, in canonical order, those that the cells were made of; all must outlive it.
    // Throws Cancelled.
    LeafClassifier(const std::vector<Vec3>& points, const Cells& cells, const CellShapes& shapes,
                   const CellPaths& paths, const Progress& progress);

    // kPointInputs for each point.
    std::vector<float> point_inputs() const;
    // kContextInputs for each point. logits: of the first network, by point.
    std::vector<float> context_inputs(const std::vector<float>& logits) const;

    // By point the logit of being leaf, at even odds. Throws Error for weights that do not fit.
    std::vector<float> logits(const LeafWeights& weights = LeafWeights::fitted()) const;

  private:
    static constexpr size_t kLooked = 32;  // nearest points that the context is asked from

    std::vector<float> run(const LeafNetwork& network, const std::vector<float>& inputs) const;

    const std::vector<Vec3>& points_;
    const Cells& cells_;
    const CellPaths& paths_;
    const CellShapes& shapes_;
    const Progress& progress_;
    const PointTree tree_;  // of the points
};

}  // namespace treerec
