// A cloud as the occupied cells of a grid, and how the cells lie around one another. Internal to scan/.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geometry/vec.h"
#include "progress.h"

namespace treerec {

// Scatter as xx xy xz yy yz zz.
void add_product(std::array<float, 6>& sum, const Vec3& d, float weight);

// The square roots of the eigenvalues of a covariance, falling (Smith 1961).
Vec3 deviations(const std::array<float, 6>& m);

// Cells in the order of their keys. Metres.
struct Cells {
    double size = 0.0;               // edge length
    std::vector<uint64_t> keys;      // as CellLayout's, rising
    std::vector<Vec3> centres;       // the mean of a cell's points
    std::vector<uint32_t> of_point;  // by point
    std::vector<uint32_t>
        near_begin;  // cells that touch cell i: near[near_begin[i]] .. near[near_begin[i + 1] - 1]
    std::vector<uint32_t> near;

    size_t count() const { return keys.size(); }
};

// The grid in which a cell holds three points on average, but none finer than 1/600 of the cloud: one cell is
// about as large as the gap between points, at which leaves and twigs differ most. points: finite, in
// canonical order (Samples), at least one.
Cells make_cells(const std::vector<Vec3>& points, const Progress& progress);

// How the cells within about 1.5 cells' width lie: around each cell, on the grids 1, 2, 4 and 8 times as
// coarse.
struct CellShape {
    float linearity =
        0.0F;  // (s1 - s2) / s1 of the standard deviations s1 >= s2 >= s3 (Demantke et al. 2011)
    float planarity = 0.0F;  // (s2 - s3) / s1
    float scatter = 0.0F;    // s3 / s1
    float occupied = 0.0F;   // of the 26 cells around
    float crowd = 0.0F;      // ln of the number of finest cells in those 27, per multiple of the grid
};
inline constexpr int kShapeScales = 4;
using CellShapes = std::vector<CellShape>;  // kShapeScales for each cell

// Fills in the scales first..last (0 to kShapeScales - 1).
void measure_shapes(const Cells& cells, int first, int last, CellShapes& shapes, const Progress& progress);

}  // namespace treerec
