// Points sorted into cubic cells: neighbours, components and one point per cell, in linear time.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/vec.h"
#include "progress.h"

namespace treerec {

// A grid of cubes over a box. Points outside the box count to its outermost cells.
struct CellLayout {
    static constexpr int kBits = 21;  // per axis in one key
    static constexpr double kMostCells = 2097150.0;

    DVec3 low{0.0};
    double cell = 1.0;

    // (y, x, z), so that a key's neighbours along z are one apart. Index 0 is left free, so that every
    // neighbour has a key. p: finite.
    uint64_t key(const Vec3& p) const { return index(p.y, 1) << 42 | index(p.x, 0) << 21 | index(p.z, 2); }
    uint64_t index(float at, int axis) const {
        // What is below 1 needs no floor, and what is no number goes there.
        const double i = (at - low[axis]) / cell + 1.0;
        return !(i >= 1.0) ? 1 : static_cast<uint64_t>(i > kMostCells ? kMostCells : i);
    }
};

struct CellGrid {
    // points: finite. Throws Cancelled.
    CellGrid(std::span<const Vec3> points, const CellLayout& layout, const Progress* progress = nullptr);

    size_t size() const { return keys.size(); }
    std::span<const uint32_t> in_cell(size_t c) const {
        return std::span(order).subspan(begin[c], begin[c + 1] - begin[c]);
    }
    // The range of cells (indices) whose keys lie in low..high.
    std::pair<size_t, size_t> cells_between(uint64_t low, uint64_t high) const;

    // Calls body(c, first, last) for every cell c and each of the nine runs of cells around it, which are the
    // cells first..last-1; c itself is in one of them. Linear.
    template <typename Body>
    void for_neighbour_runs(const Body& body) const;

    CellLayout layout;
    std::vector<uint64_t> keys;   // of the occupied cells, ascending
    std::vector<uint32_t> begin;  // where each cell's points begin in `order`; one more at the end
    std::vector<uint32_t> order;  // indices of points, by cell, ascending within a cell
};

// How many cells hold a point, as far as `most`; more are told as most + 1. Any order of the points gives the
// same.
size_t count_cells(std::span<const Vec3> points, const CellLayout& layout, size_t most,
                   const Progress* progress = nullptr);

// The same, guessed to about 1 % from every sixteenth cell, which is quicker where there are many.
size_t guess_cells(std::span<const Vec3> points, const CellLayout& layout,
                   const Progress* progress = nullptr);

template <typename Body>
void CellGrid::for_neighbour_runs(const Body& body) const {
    for (int dy = -1; dy <= 1; dy++) {
        for (int dx = -1; dx <= 1; dx++) {
            const uint64_t shift = (static_cast<uint64_t>(static_cast<int64_t>(dy)) << 42) +
                                   (static_cast<uint64_t>(static_cast<int64_t>(dx)) << 21);
            // Both ends move forward only.
            size_t first = 0;
            size_t last = 0;
            for (size_t c = 0; c < keys.size(); c++) {
                const uint64_t middle = keys[c] + shift;
                while (first < keys.size() && keys[first] < middle - 1)
                    first++;
                last = std::max(last, first);
                while (last < keys.size() && keys[last] <= middle + 1)
                    last++;
                if (first < last) body(c, first, last);
            }
        }
    }
}

}  // namespace treerec
