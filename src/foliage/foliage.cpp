#include "foliage/foliage.h"

#include <algorithm>
#include <cmath>

#include "error.h"
#include "geometry/bounds.h"
#include "geometry/cell_grid.h"

namespace treerec {

namespace {

constexpr double kEdge = 0.12;          // metres
constexpr double kFineShare = 0.03;     // of the crown, if that is less
constexpr double kExtentShare = 0.002;  // of the crown: no cell is smaller
constexpr double kPointsPerCell = 2.5;  // at least, on average
constexpr double kLeastGrowth = 1.03;
constexpr double kLargestEdge = 1e4;
constexpr size_t kMostPoints = UINT16_MAX;

std::array<uint16_t, 3> place_of(const FoliageCell& cell) {
    return {cell.x, cell.y, cell.z};
}

CellLayout choose_layout(std::span<const Vec3> points, const Bounds& bounds, const Progress* progress) {
    const DVec3 size = bounds.size();
    const double extent = std::max({size.x, size.y, size.z});
    CellLayout layout{bounds.min,
                      std::max(std::min(kEdge, kFineShare * extent), std::max(kExtentShare * extent, 1e-4))};
    const size_t most = std::clamp<size_t>(
        static_cast<size_t>(static_cast<double>(points.size()) / kPointsPerCell), 1, kMostFoliageCells);
    for (;;) {
        const size_t count = count_cells(points, layout, 4 * most, progress);
        if (count <= most) return layout;
        // The number of cells falls with the square of their edge, or faster.
        layout.cell *=
            std::max(std::sqrt(static_cast<double>(count) / static_cast<double>(most)), kLeastGrowth);
    }
}

}  // namespace

Foliage gather_foliage(std::span<const Vec3> points, std::span<const std::array<uint8_t, 3>> colors,
                       const Progress* progress) {
    Foliage foliage;
    if (points.empty()) return foliage;
    Bounds bounds;
    for (const Vec3& p : points)
        bounds.add(DVec3(p));
    const CellGrid grid(points, choose_layout(points, bounds, progress), progress);
    foliage.origin = grid.layout.low;
    foliage.edge = grid.layout.cell;
    foliage.colored = !colors.empty();
    for (size_t c = 0; c < grid.size(); c++) {
        const std::span<const uint32_t> in_cell = grid.in_cell(c);
        const Vec3& p = points[in_cell.front()];
        FoliageCell cell;
        // The layout counts from 1.
        cell.x = static_cast<uint16_t>(grid.layout.index(p.x, 0) - 1);
        cell.y = static_cast<uint16_t>(grid.layout.index(p.y, 1) - 1);
        cell.z = static_cast<uint16_t>(grid.layout.index(p.z, 2) - 1);
        cell.points = static_cast<uint16_t>(std::min(in_cell.size(), kMostPoints));
        if (foliage.colored) {
            std::array<uint64_t, 3> sum{};
            for (const uint32_t i : in_cell)
                for (size_t k = 0; k < 3; k++)
                    sum[k] += colors[i][k];
            for (size_t k = 0; k < 3; k++)
                cell.color[k] = static_cast<uint8_t>(sum[k] / in_cell.size());
        }
        foliage.cells.push_back(cell);
    }
    std::sort(foliage.cells.begin(), foliage.cells.end(),
              [](const FoliageCell& a, const FoliageCell& b) { return place_of(a) < place_of(b); });
    return foliage;
}

std::vector<int32_t> points_outside(const Foliage& foliage, std::span<const Vec3> points) {
    std::vector<int32_t> outside;
    const auto before = [](const FoliageCell& cell, const std::array<int64_t, 3>& place) {
        return std::array<int64_t, 3>{cell.x, cell.y, cell.z} < place;
    };
    for (size_t i = 0; i < points.size(); i++) {
        if (!foliage.empty()) {
            const DVec3 at = glm::floor((DVec3(points[i]) - foliage.origin) / foliage.edge);
            // Far away or not a number: no cell is there.
            if (at.x >= 0.0 && at.x < 65536.0 && at.y >= 0.0 && at.y < 65536.0 && at.z >= 0.0 &&
                at.z < 65536.0) {
                const std::array<int64_t, 3> place{int64_t(at.x), int64_t(at.y), int64_t(at.z)};
                const auto cell = std::lower_bound(foliage.cells.begin(), foliage.cells.end(), place, before);
                if (cell != foliage.cells.end() &&
                    std::array<int64_t, 3>{cell->x, cell->y, cell->z} == place) {
                    continue;
                }
            }
        }
        outside.push_back(int32_t(i));
    }
    return outside;
}

void check_foliage(const Foliage& foliage) {
    const std::string damaged = "The saved foliage is damaged: ";
    const std::string advice = ". Reconstruct the tree again.";
    if (foliage.cells.size() > kMostFoliageCells) throw Error(damaged + "it has too many cells" + advice);
    if (foliage.empty()) return;
    if (!is_finite(foliage.origin) || !(foliage.edge > 0.0) || !(foliage.edge < kLargestEdge) ||
        !(foliage.reach >= 0.0) || !(foliage.reach < kLargestEdge))
        throw Error(damaged + "its place or its sizes can't be" + advice);
    const FoliageCell* before = nullptr;
    for (const FoliageCell& cell : foliage.cells) {
        if (cell.points == 0) throw Error(damaged + "a cell is without points" + advice);
        if (before && place_of(*before) >= place_of(cell))
            throw Error(damaged + "its cells are out of order" + advice);
        before = &cell;
    }
}

double usual_points(const Foliage& foliage) {
    std::vector<uint16_t> points;
    points.reserve(foliage.cells.size());
    for (const FoliageCell& cell : foliage.cells)
        points.push_back(cell.points);
    const auto middle = points.begin() + static_cast<std::ptrdiff_t>(points.size() / 2);
    std::nth_element(points.begin(), middle, points.end());
    return *middle;
}

}  // namespace treerec
