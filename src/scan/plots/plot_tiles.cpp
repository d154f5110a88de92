#include "scan/plots/plot_tiles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "error.h"
#include "file_bytes.h"

namespace treerec {

namespace {

// Three floats and three bytes of colour. The files are this program's own and live no longer than it.
constexpr size_t kRecord = 15;
constexpr size_t kMostWaiting = size_t{1} << 26;  // bytes, of all tiles
constexpr size_t kLookEvery = 1 << 20;

size_t tiles_along(const Range& range, double edge) {
    return static_cast<size_t>(std::max(1.0, std::ceil(range.size() / edge - 1e-9)));
}

size_t index_along(const Range& range, size_t count, double value) {
    const double at = (value - range.low) / std::max(range.size(), 1e-9) * static_cast<double>(count);
    return static_cast<size_t>(std::clamp(std::floor(at), 0.0, static_cast<double>(count - 1)));
}

Range part_of(const Range& range, size_t count, size_t index) {
    const auto border = [&](size_t i) {
        return range.low + range.size() * static_cast<double>(i) / static_cast<double>(count);
    };
    return {border(index), border(index + 1)};
}

}  // namespace

TileGrid::TileGrid(const Range& x, const Range& z, double edge)
    : x_(x), z_(z), columns_(tiles_along(x, edge)), rows_(tiles_along(z, edge)) {}

TileCore TileGrid::core(size_t tile) const {
    return {part_of(x_, columns_, tile % columns_), part_of(z_, rows_, tile / columns_)};
}

size_t TileGrid::at(double px, double pz) const {
    return index_along(z_, rows_, pz) * columns_ + index_along(x_, columns_, px);
}

std::vector<size_t> TileGrid::around(size_t tile, double reach) const {
    const TileCore own = core(tile);
    const size_t first = at(own.x.low - reach, own.z.low - reach),
                 last = at(own.x.high + reach, own.z.high + reach);
    std::vector<size_t> tiles;
    for (size_t row = first / columns_; row <= last / columns_; row++)
        for (size_t column = first % columns_; column <= last % columns_; column++)
            tiles.push_back(row * columns_ + column);
    return tiles;
}

TileStore::TileStore(const TileGrid& grid, std::string folder)
    : grid_(grid), folder_(std::move(folder)), waiting_(grid.size()) {}

std::string TileStore::file_of(size_t tile) const {
    return folder_ + "/tile_" + std::to_string(tile) + ".points";
}

void TileStore::add(const Vec3& p, const Color8* color) {
    std::array<char, kRecord> record{};
    std::memcpy(record.data(), &p, 12);
    if (color) {
        has_colors_ = true;
        std::memcpy(record.data() + 12, color->data(), 3);
    }
    waiting_[grid_.at(static_cast<double>(p.x), static_cast<double>(p.z))].append(record.data(), kRecord);
    waiting_bytes_ += kRecord;
    if (waiting_bytes_ >= kMostWaiting) finish();
}

void TileStore::write(size_t tile) {
    std::ofstream stream(path_of(file_of(tile)), std::ios::binary | std::ios::app);
    stream.write(waiting_[tile].data(), static_cast<std::streamsize>(waiting_[tile].size()));
    stream.close();
    if (!stream)
        throw Error("The points of a tile could not be kept in '" + folder_ +
                    "': is the disk full? A plot needs about 15 bytes a point there.");
    waiting_[tile] = {};
}

void TileStore::finish() {
    for (size_t tile = 0; tile < waiting_.size(); tile++)
        if (!waiting_[tile].empty()) write(tile);
    waiting_bytes_ = 0;
}

PointCloud TileStore::read(size_t tile, double reach, const ScanFrame& frame,
                           const Progress* progress) const {
    PointCloud cloud;
    cloud.frame = frame;
    const TileCore own = grid_.core(tile);
    for (const size_t near : grid_.around(tile, reach)) {
        std::error_code failure;
        if (!std::filesystem::exists(path_of(file_of(near)), failure)) continue;
        const FileBytes bytes = read_file(file_of(near));
        for (size_t i = 0; (i + 1) * kRecord <= bytes.size; i++) {
            if (progress && i % kLookEvery == 0) progress->check();
            const char* record = bytes.data.get() + i * kRecord;
            Vec3 p;
            std::memcpy(&p, record, 12);
            if (own.depth(static_cast<double>(p.x), static_cast<double>(p.z)) < -reach) continue;
            cloud.positions.push_back(p);
            if (!has_colors_) continue;
            Color8 color;
            std::memcpy(color.data(), record + 12, 3);
            cloud.colors.push_back(color);
        }
    }
    return cloud;
}

}  // namespace treerec
