// The rules that tell a leafy cloud from a bare one, and leaf points from wood. Internal to scan/.
#pragma once

#include <array>
#include <vector>

#include "geometry/vec.h"
#include "progress.h"
#include "scan/leaves/leaf_cells.h"
#include "scan/leaves/leaf_paths.h"

namespace treerec {

// What the rules know of a cell: by scale linearity, planarity, scatter, occupied, crowd (the coarsest
// without the first two), then the members of CellPath.
inline constexpr size_t kCellInputs = 28;
using CellInputs = std::array<float, kCellInputs>;
// shapes: kShapeScales of them.
CellInputs inputs_of(const CellShape* shapes, const CellPath& path);

// The direction in which the path from the ground reaches a cell.
Vec3 heading_of(uint32_t cell, const Cells& cells, const CellPaths& paths);

// Linearity, planarity and scatter of the nearest points; the share of their variance along the path to the
// ground; ln of how far they reach, in cells; how far their mean lies from the point, of their reach.
inline constexpr size_t kNearInputs = 6;
void measure_near(const std::vector<Vec3>& points, const Vec3& p, const uint32_t* nearest, size_t count,
                  float reach, float cell, const Vec3& heading, float* inputs);

// Above 0 for a tree in leaf. means: of all points' cells.
double leafiness(const CellInputs& means);

// Where to look: at the first `points` of a cell (one or two) of every step-th cell.
struct LeafLooks {
    size_t points = 2;
    size_t step = 1;
};

// For each cell the logit of being leaf, at even odds: the mean of its first points', by a perceptron with
// one hidden layer on what the cell is and on how the 8 and 24 nearest points (itself too) lie; NaN for cells
// that are not looked at. points: metres, distinct, in canonical order, those that the cells were made of.
// inputs: by cell.
std::vector<float> leaf_logits(const std::vector<Vec3>& points, const Cells& cells, const CellPaths& paths,
                               const std::vector<CellInputs>& inputs, const LeafLooks& looks,
                               const Progress& progress);

}  // namespace treerec
