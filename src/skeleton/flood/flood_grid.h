// The voxels of a cloud, and which of them touch.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/cell_grid.h"
#include "skeleton/sampling/point_graph.h"

namespace treerec {

// Occupied voxels only, so that memory grows with the points and not with the space between them (Zhang 2013,
// 5.1, keeps an array of d^3).
struct FloodGrid {
    // points: tree space, metres, finite, at least two. voxel: edge in metres. Throws Error where the voxel
    // is as large as the tree or too small to be numbered, Cancelled on request.
    FloodGrid(const std::vector<Vec3>& points, double voxel, Progress& progress);
    // Of a part of a tree, however small; larger voxels where these could not be numbered.
    static FloodGrid any_size(const std::vector<Vec3>& points, double voxel, Progress& progress);

    size_t size() const { return cells.size(); }
    // The middle of a voxel.
    DVec3 centre(size_t voxel) const;

    CellGrid cells;
    std::vector<Vec3> means;  // of each voxel's points
    // Voxels that touch (26 neighbours), and the links over the gaps between parts that do not.
    PointGraph graph;
    std::vector<uint8_t> bridge;  // by the graph's edges: 1 for such a link

  private:
    FloodGrid(const std::vector<Vec3>& points, const CellLayout& layout, Progress& progress);
};

// The smallest of a row of sizes at which the voxels that hold points hang together (Zhang 2013, 5.1: as
// small as continuity allows): most points lie in parts that are no specks, and links over the gaps do the
// rest. points: thinned to `spacing` metres. one_stem: there are no twigs to be kept apart.
double automatic_voxel(const std::vector<Vec3>& points, double spacing, bool one_stem,
                       const Progress& progress);

}  // namespace treerec
