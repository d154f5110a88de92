// How a variant carries the leaves that the scan saw: each cell with the wood it is nearest to.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "edit/vary/vary.h"
#include "edit/vary/vary_parts.h"
#include "geometry/radix_sort.h"

namespace treerec {

namespace {

constexpr int64_t kMostCellsPerAxis = 24;

// The nodes of a tree in a grid over it.
class NodeGrid {
  public:
    explicit NodeGrid(const std::vector<DVec3>& places) : places_(places) {
        Bounds bounds;
        for (const DVec3& p : places)
            bounds.add(p);
        low_ = bounds.min;
        const DVec3 size = bounds.size();
        cell_ = std::max({size.x, size.y, size.z, 1e-9}) / static_cast<double>(kMostCellsPerAxis);
        for (int axis = 0; axis < 3; axis++)
            count_[axis] = std::min(static_cast<int64_t>(size[axis] / cell_), kMostCellsPerAxis) + 1;
        begin_.assign(static_cast<size_t>(count_[0] * count_[1] * count_[2]) + 1, 0);
        for (const DVec3& p : places)
            begin_[cell_of(p) + 1]++;
        for (size_t c = 0; c + 1 < begin_.size(); c++)
            begin_[c + 1] += begin_[c];
        std::vector<uint32_t> fill(begin_.begin(), begin_.end() - 1);
        nodes_.resize(places.size());
        for (size_t i = 0; i < places.size(); i++)
            nodes_[fill[cell_of(places[i])]++] = static_cast<uint32_t>(i);
    }

    // Of several as near the first.
    uint32_t nearest(const DVec3& p) const {
        int64_t middle[3];
        for (int axis = 0; axis < 3; axis++)
            middle[axis] = index(p, axis);
        uint32_t found = 0;
        double least = std::numeric_limits<double>::infinity();
        // p may lie outside of the grid: that far nothing can be.
        DVec3 inside;
        for (int axis = 0; axis < 3; axis++)
            inside[axis] =
                std::clamp(p[axis], low_[axis], low_[axis] + cell_ * static_cast<double>(count_[axis]));
        const double outside = glm::distance(p, inside);
        const int64_t rings = std::max({count_[0], count_[1], count_[2]});
        for (int64_t ring = 0; ring <= rings; ring++) {
            if (least <= std::max(outside, static_cast<double>(ring - 1) * cell_)) break;
            for (int64_t x = middle[0] - ring; x <= middle[0] + ring; x++)
                for (int64_t y = middle[1] - ring; y <= middle[1] + ring; y++) {
                    const bool edge = std::abs(x - middle[0]) == ring || std::abs(y - middle[1]) == ring;
                    for (int64_t z = middle[2] - ring; z <= middle[2] + ring;
                         z += edge || ring == 0 ? 1 : 2 * ring)
                        look(x, y, z, p, found, least);
                }
        }
        return found;
    }

  private:
    int64_t index(const DVec3& p, int axis) const {
        const double at = (p[axis] - low_[axis]) / cell_;
        return std::clamp(static_cast<int64_t>(std::clamp(at, 0.0, 1e6)), int64_t{0}, count_[axis] - 1);
    }
    size_t cell_of(const DVec3& p) const {
        return static_cast<size_t>((index(p, 0) * count_[1] + index(p, 1)) * count_[2] + index(p, 2));
    }
    void look(int64_t x, int64_t y, int64_t z, const DVec3& p, uint32_t& found, double& least) const {
        if (x < 0 || y < 0 || z < 0 || x >= count_[0] || y >= count_[1] || z >= count_[2]) return;
        const auto cell = static_cast<size_t>((x * count_[1] + y) * count_[2] + z);
        for (uint32_t i = begin_[cell]; i < begin_[cell + 1]; i++) {
            const double distance = glm::distance(p, places_[nodes_[i]]);
            if (distance > least || (distance == least && nodes_[i] > found)) continue;
            least = distance;
            found = nodes_[i];
        }
    }

    const std::vector<DVec3>& places_;
    DVec3 low_{0.0};
    double cell_ = 1.0;
    int64_t count_[3] = {1, 1, 1};
    std::vector<uint32_t> begin_, nodes_;
};

// A cell that has left the crowd would get a leaf on a long bare twig.
constexpr int kCrowd = 3;
// The 27 places about a cell, numbered by x, y, z: those at its sides, at its edges, at its corners, its own.
constexpr std::array<int32_t, 27> kAround = {4,  10, 12, 14, 16, 22, 1, 3, 5,  7,  9,  11, 15, 17,
                                             19, 21, 23, 25, 0,  2,  6, 8, 18, 20, 24, 26, 13};

// Cells by their place in the grid.
class CellTable {
  public:
    explicit CellTable(size_t most) {
        while (size_t{1} << bits_ < 2 * most)
            bits_++;
        slots_.resize(size_t{1} << bits_, 0);
        cells_.reserve(most);
    }

    // Puts the cell there, unless one is there. in_crowd: it goes where too few touch it in the end.
    bool take(const std::array<int32_t, 3>& place, const FoliageCell& cell, bool in_crowd) {
        uint32_t& slot = slots_[find(place)];
        if (slot != 0) return false;
        FoliageCell& here = cells_.emplace_back(cell);
        here.x = static_cast<uint16_t>(place[0]);
        here.y = static_cast<uint16_t>(place[1]);
        here.z = static_cast<uint16_t>(place[2]);
        slot = static_cast<uint32_t>(cells_.size());
        in_crowd_.push_back(in_crowd);
        return true;
    }
    // Adds the cell to the one that is there.
    void join(const std::array<int32_t, 3>& place, const FoliageCell& cell) {
        FoliageCell& here = cells_[slots_[find(place)] - 1];
        const uint32_t points = uint32_t{here.points} + cell.points;
        for (size_t c = 0; c < 3; c++) {
            const uint32_t sum =
                uint32_t{here.color[c]} * here.points + uint32_t{cell.color[c]} * cell.points;
            here.color[c] = static_cast<uint8_t>((sum + points / 2) / points);
        }
        here.points = static_cast<uint16_t>(std::min<uint32_t>(points, UINT16_MAX));
    }

    // Whether at least kCrowd others touch it.
    bool is_in_crowd(const FoliageCell& cell) const {
        int touching = 0;
        for (int32_t n = 0; n < 27; n++) {
            // The sides first, for most have enough there.
            const int32_t k = kAround[static_cast<size_t>(n)];
            const std::array<int32_t, 3> place{cell.x + k / 9 - 1, cell.y + k / 3 % 3 - 1,
                                               cell.z + k % 3 - 1};
            if (k == 13 || place[0] < 0 || place[1] < 0 || place[2] < 0) continue;
            touching += slots_[find(place)] != 0;
            if (touching == kCrowd) return true;
        }
        return false;
    }

    // By x, then y, then z.
    std::vector<FoliageCell> sorted() const {
        std::vector<KeyedIndex> order;
        order.reserve(cells_.size());
        for (size_t i = 0; i < cells_.size(); i++)
            if (!in_crowd_[i] || is_in_crowd(cells_[i]))
                order.push_back({key_of({cells_[i].x, cells_[i].y, cells_[i].z}), static_cast<uint32_t>(i)});
        radix_sort(order);
        std::vector<FoliageCell> result;
        result.reserve(order.size());
        for (const KeyedIndex& one : order)
            result.push_back(cells_[one.index]);
        return result;
    }

  private:
    static uint64_t key_of(const std::array<int32_t, 3>& place) {
        return static_cast<uint64_t>(place[0]) << 32 | static_cast<uint64_t>(place[1]) << 16 |
               static_cast<uint64_t>(place[2]);
    }
    // The slot in which the cell of that place is, or belongs: 0 stands there, or its index + 1.
    size_t find(const std::array<int32_t, 3>& place) const {
        const uint64_t key = key_of(place);
        const size_t mask = slots_.size() - 1;
        for (size_t at = (key * 0x9E3779B97F4A7C15ULL) >> (64 - bits_);; at = (at + 1) & mask) {
            if (slots_[at] == 0) return at;
            const FoliageCell& cell = cells_[slots_[at] - 1];
            if (cell.x == place[0] && cell.y == place[1] && cell.z == place[2]) return at;
        }
    }

    int bits_ = 4;
    std::vector<uint32_t> slots_;
    std::vector<FoliageCell> cells_;
    std::vector<uint8_t> in_crowd_;
};

}  // namespace

void VariantMaker::carry_foliage(const Foliage& foliage) {
    std::vector<DVec3> places(steps_.size());
    std::vector<int32_t> branch_of(steps_.size());
    for (size_t b = 0; b < branches_.size(); b++) {
        const VariedBranch& branch = branches_[b];
        DVec3 at = tree_.node(tree_.root()).position;
        if (b > 0) {
            const VariedBranch& parent = branches_[branch.parent];
            if (branch.attach >= 0) at = places[parent.begin + branch.attach];
        }
        for (int32_t k = branch.begin; k < branch.end; k++) {
            at += steps_[k];
            places[k] = at;
            branch_of[k] = static_cast<int32_t>(b);
        }
    }
    CellTable table(foliage.cells.size());
    for (const FoliageCell& cell : foliage.cells)
        table.take({cell.x, cell.y, cell.z}, cell, false);
    for (const FoliageCell& cell : foliage.cells)
        in_crowd_.push_back(table.is_in_crowd(cell));
    const NodeGrid grid(places);
    std::vector<uint32_t> nearest(foliage.cells.size());
    carried_begin_.assign(branches_.size() + 1, 0);
    for (size_t c = 0; c < nearest.size(); c++) {
        nearest[c] = grid.nearest(foliage.centre(foliage.cells[c]));
        carried_begin_[branch_of[nearest[c]] + 1]++;
    }
    for (size_t b = 0; b < branches_.size(); b++)
        carried_begin_[b + 1] += carried_begin_[b];
    std::vector<int32_t> fill(carried_begin_.begin(), carried_begin_.end() - 1);
    carried_.resize(nearest.size());
    for (size_t c = 0; c < nearest.size(); c++) {
        const uint32_t node = nearest[c];
        carried_[fill[branch_of[node]]++] = {static_cast<int32_t>(node) - branches_[branch_of[node]].begin,
                                             static_cast<uint32_t>(c),
                                             foliage.centre(foliage.cells[c]) - places[node]};
    }
}

// Moved cells fall into the grid again. Where two meet, the later one makes do with a free place beside, so
// that a crown does not thin out; where there is none, they become one.
Foliage VariantMaker::settle(const std::vector<uint32_t>& cells, const std::vector<DVec3>& places) const {
    Foliage settled;
    settled.edge = foliage_.edge;
    settled.reach = foliage_.reach;
    settled.colored = foliage_.colored;
    settled.origin = foliage_.origin;
    if (cells.empty()) return settled;
    DVec3 low = places[0];
    for (const DVec3& p : places)
        low = glm::min(low, p);
    // Whole cells, so that what did not move stays in its own; one more, for places beside.
    settled.origin += (glm::floor((low - settled.origin) / settled.edge) - 1.0) * settled.edge;
    CellTable table(cells.size());
    for (size_t i = 0; i < cells.size(); i++) {
        const DVec3 at = (places[i] - settled.origin) / settled.edge;
        if (!(at.x >= 1.0 && at.y >= 1.0 && at.z >= 1.0) ||
            !(at.x < UINT16_MAX && at.y < UINT16_MAX && at.z < UINT16_MAX))
            continue;
        const std::array<int32_t, 3> own{static_cast<int32_t>(at.x), static_cast<int32_t>(at.y),
                                         static_cast<int32_t>(at.z)};
        const DVec3 off = at - DVec3(own[0], own[1], own[2]) - 0.5;
        const FoliageCell& cell = foliage_.cells[cells[i]];
        if (table.take(own, cell, in_crowd_[cells[i]])) continue;
        // The side that it is nearest to first.
        std::array<int, 3> axes{0, 1, 2};
        std::stable_sort(axes.begin(), axes.end(),
                         [&](int a, int b) { return std::abs(off[a]) > std::abs(off[b]); });
        bool placed = false;
        for (const int way : {1, -1}) {
            for (size_t k = 0; k < 3 && !placed; k++) {
                const int axis = axes[way > 0 ? k : 2 - k];
                std::array<int32_t, 3> beside = own;
                beside[static_cast<size_t>(axis)] += off[axis] < 0.0 ? -way : way;
                placed = table.take(beside, cell, in_crowd_[cells[i]]);
            }
        }
        if (!placed) table.join(own, cell);
    }
    settled.cells = table.sorted();
    if (settled.cells.size() <= kMostFoliageCells) return settled;
    // Evenly fewer.
    const size_t all = settled.cells.size();
    size_t kept = 0;
    for (size_t i = 0; i < all; i++)
        if ((i + 1) * kMostFoliageCells / all > i * kMostFoliageCells / all)
            settled.cells[kept++] = settled.cells[i];
    settled.cells.resize(kept);
    return settled;
}

}  // namespace treerec
