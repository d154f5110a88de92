// The points of a plot, by tile: on disk, so that memory holds one tile at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "progress.h"
#include "scan/point_cloud.h"
#include "scan/robust.h"

namespace treerec {

// A tile's own ground: points and stems on its upper borders are the next tile's.
struct TileCore {
    Range x, z;  // metres, tree space

    // Metres from the border, inside; negative outside.
    double depth(double px, double pz) const {
        return std::min(std::min(px - x.low, x.high - px), std::min(pz - z.low, z.high - pz));
    }
    bool holds(double px, double pz) const {
        return px >= x.low && px < x.high && pz >= z.low && pz < z.high;
    }
};

// Equal tiles that cover the ground, each at most `edge` wide.
class TileGrid {
  public:
    TileGrid(const Range& x, const Range& z, double edge);

    size_t size() const { return columns_ * rows_; }
    size_t columns() const { return columns_; }
    TileCore core(size_t tile) const;
    // The nearest one for what lies outside.
    size_t at(double px, double pz) const;
    // Those that come within `reach` of the tile's core, itself among them.
    std::vector<size_t> around(size_t tile, double reach) const;

  private:
    Range x_, z_;
    size_t columns_, rows_;
};

// Takes points in any order and gives those around a tile. The files lie in a folder that must be there.
class TileStore {
  public:
    TileStore(const TileGrid& grid, std::string folder);

    // p: tree space. color: null where the cloud has none.
    void add(const Vec3& p, const Color8* color);
    // To be called once, before read().
    void finish();
    // The points within `reach` of the tile's core; colours where any point of the plot has one. frame: of
    // what comes out.
    PointCloud read(size_t tile, double reach, const ScanFrame& frame, const Progress* progress) const;

  private:
    void write(size_t tile);
    std::string file_of(size_t tile) const;

    const TileGrid& grid_;
    std::string folder_;
    std::vector<std::string> waiting_;  // bytes by tile
    size_t waiting_bytes_ = 0;
    bool has_colors_ = false;
};

}  // namespace treerec
