// The leaves that a scan saw: how many of its points and of which colour, by place.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/vec.h"
#include "progress.h"

namespace treerec {

// A cube of the crown's grid. x, y, z: counted from Foliage::origin in edges.
struct FoliageCell {
    uint16_t x = 0, y = 0, z = 0;
    uint16_t points = 0;             // of the scan, at least 1
    std::array<uint8_t, 3> color{};  // their mean; means nothing without Foliage::colored

    bool operator==(const FoliageCell&) const = default;
};

// cells: in order of x, then y, then z, each once, at most kMostFoliageCells. Tree space, metres.
struct Foliage {
    DVec3 origin{0.0};
    double edge = 0.0;
    double reach = 0.0;  // metres: leaves may stand that far from wood (fronds); 0: as the leaf rules have it
    bool colored = false;
    std::vector<FoliageCell> cells;

    bool empty() const { return cells.empty(); }
    DVec3 centre(const FoliageCell& cell) const {
        return origin + edge * (DVec3(cell.x, cell.y, cell.z) + 0.5);
    }
    bool operator==(const Foliage&) const = default;
};

inline constexpr size_t kMostFoliageCells = 20000;

// Gathers leaf points (metres, tree space, finite) into cells of 12 cm, or larger ones where those would be
// too many or too thinly filled to tell dense from sparse. colors: one per point, or empty. The order of the
// points is no matter.
Foliage gather_foliage(std::span<const Vec3> points, std::span<const std::array<uint8_t, 3>> colors,
                       const Progress* progress = nullptr);

// The indices of the points (metres, tree space) that lie in none of its cells: those of the wood, as far as
// the scan's leaves hide none.
std::vector<int32_t> points_outside(const Foliage& foliage, std::span<const Vec3> points);

// Throws Error unless the foliage is as described above: for what comes out of files.
void check_foliage(const Foliage& foliage);

// The usual number of points in a cell: the median. Precondition: not empty.
double usual_points(const Foliage& foliage);

}  // namespace treerec
