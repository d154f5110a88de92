// How a variant carries the leaves that the scan saw: each cell with the wood it is nearest to.
#include <algorithm>
#include <cmath>
#include <limits>

#include "edit/vary.h"
#include "edit/vary_parts.h"
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

}  // namespace

void VariantMaker::carry_foliage(const Foliage& foliage) {
    std::vector<DVec3> places(steps_.size());
    std::vector<int32_t> limb_of(steps_.size());
    for (size_t b = 0; b < limbs_.size(); b++) {
        const Limb& limb = limbs_[b];
        DVec3 at = tree_.node(tree_.root()).position;
        if (b > 0) {
            const Limb& parent = limbs_[limb.parent];
            if (limb.attach >= 0) at = places[parent.begin + limb.attach];
        }
        for (int32_t k = limb.begin; k < limb.end; k++) {
            at += steps_[k];
            places[k] = at;
            limb_of[k] = static_cast<int32_t>(b);
        }
    }
    const NodeGrid grid(places);
    std::vector<uint32_t> nearest(foliage.cells.size());
    carried_begin_.assign(limbs_.size() + 1, 0);
    for (size_t c = 0; c < nearest.size(); c++) {
        nearest[c] = grid.nearest(foliage.centre(foliage.cells[c]));
        carried_begin_[limb_of[nearest[c]] + 1]++;
    }
    for (size_t b = 0; b < limbs_.size(); b++)
        carried_begin_[b + 1] += carried_begin_[b];
    std::vector<int32_t> fill(carried_begin_.begin(), carried_begin_.end() - 1);
    carried_.resize(nearest.size());
    for (size_t c = 0; c < nearest.size(); c++) {
        const uint32_t node = nearest[c];
        carried_[fill[limb_of[node]]++] = {static_cast<int32_t>(node) - limbs_[limb_of[node]].begin,
                                           static_cast<uint32_t>(c),
                                           foliage.centre(foliage.cells[c]) - places[node]};
    }
}

// Moved cells fall into the grid again; those that meet become one.
Foliage VariantMaker::settle(std::vector<FoliageCell>& cells, const std::vector<DVec3>& places) const {
    Foliage settled;
    settled.edge = foliage_.edge;
    settled.reach = foliage_.reach;
    settled.colored = foliage_.colored;
    settled.origin = foliage_.origin;
    if (cells.empty()) return settled;
    DVec3 low = places[0];
    for (const DVec3& p : places)
        low = glm::min(low, p);
    // Whole cells, so that what did not move stays in its own.
    settled.origin += glm::floor((low - settled.origin) / settled.edge) * settled.edge;
    std::vector<KeyedIndex> order;
    order.reserve(cells.size());
    for (size_t i = 0; i < cells.size(); i++) {
        const DVec3 at = glm::floor((places[i] - settled.origin) / settled.edge);
        if (!(at.x >= 0.0 && at.y >= 0.0 && at.z >= 0.0) ||
            !(at.x <= UINT16_MAX && at.y <= UINT16_MAX && at.z <= UINT16_MAX))
            continue;
        const uint64_t key = static_cast<uint64_t>(at.x) << 32 | static_cast<uint64_t>(at.y) << 16 |
                             static_cast<uint64_t>(at.z);
        order.push_back({key, static_cast<uint32_t>(i)});
    }
    radix_sort(order);
    for (size_t i = 0; i < order.size();) {
        uint64_t points = 0;
        std::array<uint64_t, 3> color{};
        FoliageCell cell;
        cell.x = static_cast<uint16_t>(order[i].key >> 32);
        cell.y = static_cast<uint16_t>(order[i].key >> 16);
        cell.z = static_cast<uint16_t>(order[i].key);
        const uint64_t key = order[i].key;
        for (; i < order.size() && order[i].key == key; i++) {
            const FoliageCell& part = cells[order[i].index];
            points += part.points;
            for (size_t channel = 0; channel < 3; channel++)
                color[channel] += uint64_t{part.color[channel]} * part.points;
        }
        for (size_t channel = 0; channel < 3; channel++)
            cell.color[channel] = static_cast<uint8_t>((color[channel] + points / 2) / points);
        cell.points = static_cast<uint16_t>(std::min<uint64_t>(points, UINT16_MAX));
        settled.cells.push_back(cell);
    }
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
