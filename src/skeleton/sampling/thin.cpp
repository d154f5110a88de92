#include "skeleton/sampling/thin.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <utility>

#include "geometry/bounds.h"
#include "geometry/cell_grid.h"
#include "geometry/parallel.h"
#include "geometry/portable_math.h"
#include "geometry/radix_sort.h"
#include "geometry/random.h"

namespace treerec {

namespace {

constexpr size_t kCellsPerTask = 1024;
constexpr uint64_t kBlock = 4;          // cells along the edge of a block, a power of 2: wider than noise
constexpr size_t kSampled = 2;          // points that are sampled per cell, at most
constexpr uint64_t kSurroundings = 64;  // cells along the edge of the block a stray is compared with
constexpr double kStrayShare = 0.05;    // of the points about it that there are about most
// More of them are no stray: that side of a stem, perhaps, that only the farthest station saw.
constexpr double kMostAboutAStray = 12.0;
constexpr uint32_t kNowhere = std::numeric_limits<uint32_t>::max();
constexpr double kPlace = 1e-4;   // metres: points so close are one
constexpr double kCrowded = 1.1;  // points per cell in the mean: of fewer, one per cell tells the same

bool finite(const Vec3& p) {
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

bool before(const Vec3& a, const Vec3& b) {
    if (a.x != b.x) return a.x < b.x;
    if (a.y != b.y) return a.y < b.y;
    return a.z < b.z;
}

Bounds finite_bounds(const std::vector<Vec3>& points, size_t& count) {
    Bounds bounds;
    Vec3 low(std::numeric_limits<float>::max());
    Vec3 high(std::numeric_limits<float>::lowest());
    count = 0;
    for (const Vec3& p : points) {
        if (!finite(p)) continue;
        low = glm::min(low, p);
        high = glm::max(high, p);
        count++;
    }
    if (count == 0) return bounds;
    bounds.add(DVec3(low));
    bounds.add(DVec3(high));
    return bounds;
}

// Never so small that the cells of one axis would outgrow their bits.
CellLayout safe_layout(const Bounds& bounds, double spacing) {
    const DVec3 size = bounds.size();
    const double least = std::max({size.x, size.y, size.z}) / (CellLayout::kMostCells - 2.0);
    // A cloud that is one place has one cell of any size.
    return {bounds.min, std::max({spacing, least, std::numeric_limits<double>::min()})};
}

// Which of the members is nearest to their mean.
size_t middle_of(std::span<const Vec3> members) {
    if (members.size() == 1) return 0;
    DVec3 mean(0.0);
    for (const Vec3& p : members)
        mean += DVec3(p);
    mean /= static_cast<double>(members.size());
    size_t best = 0;
    double best_distance = std::numeric_limits<double>::max();
    for (size_t i = 0; i < members.size(); i++) {
        const DVec3 offset = DVec3(members[i]) - mean;
        const double distance = glm::dot(offset, offset);
        if (distance < best_distance) {
            best_distance = distance;
            best = i;
        }
    }
    return best;
}

// The distinct points of a cell, sorted, to the end of `out`.
void append_distinct(const std::vector<Vec3>& points, std::span<const uint32_t> cell,
                     std::vector<Vec3>& out) {
    const auto begin = static_cast<std::ptrdiff_t>(out.size());
    for (const uint32_t i : cell)
        out.push_back(points[i]);
    if (cell.size() == 1) return;
    std::sort(out.begin() + begin, out.end(), before);
    out.erase(std::unique(out.begin() + begin, out.end()), out.end());
}

// The grid's cells, by the blocks of so many (a power of 2) to each side that they are in: those are the
// keys.
std::vector<KeyedIndex> cells_by_block(const CellGrid& grid, uint64_t edge, const Progress& progress) {
    const uint64_t within = edge - 1;
    const uint64_t mask = ~(within | within << CellLayout::kBits | within << (2 * CellLayout::kBits));
    std::vector<KeyedIndex> cells(grid.size());
    for (uint32_t c = 0; c < grid.size(); c++)
        cells[c] = {grid.keys[c] & mask, c};
    radix_sort(cells, &progress);
    return cells;
}

// By cell: 1 where far fewer points lie about it than about most points near it, as those of beams do that an
// edge split between what is before and what is behind. held: by cell, distinct points.
std::vector<uint8_t> find_strays(const CellGrid& grid, const std::vector<uint32_t>& held,
                                 const Progress& progress) {
    std::vector<uint64_t> before(grid.size() + 1, 0);
    for (size_t c = 0; c < grid.size(); c++)
        before[c + 1] = before[c] + held[c];
    progress.check();
    std::vector<uint32_t> around(grid.size(), 0);
    grid.for_neighbour_runs([&](size_t c, size_t first, size_t last) {
        around[c] += static_cast<uint32_t>(before[last] - before[first]);
    });
    progress.check();
    const std::vector<KeyedIndex> cells = cells_by_block(grid, kSurroundings, progress);
    std::vector<uint8_t> stray(grid.size(), 0);
    for (size_t begin = 0, end = 0; begin < cells.size(); begin = end) {
        double points = 0.0, sum = 0.0;
        for (; end < cells.size() && cells[end].key == cells[begin].key; end++) {
            const uint32_t c = cells[end].index;
            points += held[c];
            sum += static_cast<double>(held[c]) * around[c];
        }
        const double limit = std::min(kStrayShare * sum / points, kMostAboutAStray);
        for (size_t i = begin; i < end; i++)
            stray[cells[i].index] = around[cells[i].index] <= limit ? 1 : 0;
    }
    return stray;
}

// Of each block a number of points that goes by its cells: one of each of so many runs along these.
// place: by cell, where its point lies in out.points, or kNowhere.
void take_sample(const std::vector<Vec3>& points, const CellGrid& grid, const std::vector<uint32_t>& place,
                 ThinnedCloud& out, Progress& progress) {
    std::vector<KeyedIndex> cells = cells_by_block(grid, kBlock, progress);
    std::erase_if(cells, [&](const KeyedIndex& cell) { return place[cell.index] == kNowhere; });
    std::vector<ThinnedCloud> parts((cells.size() + kCellsPerTask - 1) / kCellsPerTask);
    parallel_for(cells.size(), kCellsPerTask, [&](size_t begin, size_t end) {
        progress.check();
        ThinnedCloud& part = parts[begin / kCellsPerTask];
        std::vector<Vec3> members;
        std::vector<uint32_t> cell_of;
        // A task does the blocks that begin in it.
        while (begin > 0 && begin < end && cells[begin].key == cells[begin - 1].key)
            begin++;
        while (begin < end) {
            const uint64_t block = cells[begin].key;
            members.clear();
            cell_of.clear();
            size_t next = begin;
            for (; next < cells.size() && cells[next].key == block; next++) {
                append_distinct(points, grid.in_cell(cells[next].index), members);
                cell_of.resize(members.size(), place[cells[next].index]);
            }
            const size_t runs = std::min(members.size(), kSampled * (next - begin));
            uint64_t chance = block;
            for (size_t run = 0; run < runs; run++) {
                const size_t from = run * members.size() / runs;
                const size_t to = (run + 1) * members.size() / runs;
                chance = hash_seed(chance, run);
                const size_t chosen = from + chance % (to - from);
                part.sample.push_back(members[chosen]);
                part.cube.push_back(cell_of[chosen]);
            }
            begin = next;
        }
    });
    for (const ThinnedCloud& part : parts) {
        out.sample.insert(out.sample.end(), part.sample.begin(), part.sample.end());
        out.cube.insert(out.cube.end(), part.cube.begin(), part.cube.end());
    }
}

ThinnedCloud thin(const std::vector<Vec3>& points, double spacing, bool sampled, Progress& progress,
                  PassSet left_out = {}) {
    progress.check();
    ThinnedCloud out;
    size_t count = 0;
    const Bounds bounds = finite_bounds(points, count);
    if (count == 0) return out;
    if (count < points.size()) {
        std::vector<Vec3> good;
        good.reserve(count);
        std::copy_if(points.begin(), points.end(), std::back_inserter(good), finite);
        return thin(good, spacing, sampled, progress, left_out);
    }
    const CellGrid grid(points, safe_layout(bounds, spacing), &progress);
    out.points.resize(grid.size());
    std::vector<uint32_t> held(grid.size());
    parallel_for(grid.size(), kCellsPerTask, [&](size_t begin, size_t end) {
        progress.check();
        std::vector<Vec3> members;
        for (size_t c = begin; c < end; c++) {
            members.clear();
            append_distinct(points, grid.in_cell(c), members);
            out.points[c] = members[middle_of(members)];
            held[c] = static_cast<uint32_t>(members.size());
        }
    });
    const auto distinct = static_cast<double>(std::accumulate(held.begin(), held.end(), uint64_t{0}));
    if (!sampled || distinct < kCrowded * static_cast<double>(grid.size())) return out;
    const std::vector<uint8_t> stray = left_out.has(Pass::kStrays) ? std::vector<uint8_t>(grid.size(), 0)
                                                                   : find_strays(grid, held, progress);
    std::vector<uint32_t> place(grid.size(), kNowhere);
    uint32_t kept = 0;
    for (size_t c = 0; c < grid.size(); c++) {
        if (stray[c] != 0) continue;
        out.points[kept] = out.points[c];
        place[c] = kept++;
    }
    out.points.resize(kept);
    take_sample(points, grid, place, out, progress);
    return out;
}

}  // namespace

ThinnedCloud thin_with_sample(const std::vector<Vec3>& points, double spacing, Progress& progress,
                              PassSet left_out) {
    return thin(points, spacing, true, progress, left_out);
}

std::vector<Vec3> thin_points(const std::vector<Vec3>& points, double spacing, Progress& progress) {
    return thin(points, spacing, false, progress).points;
}

double automatic_spacing(const std::vector<Vec3>& points, const Progress* progress) {
    size_t finite_count = 0;
    const Bounds bounds = finite_bounds(points, finite_count);
    double spacing = std::max(std::clamp(bounds.diagonal() / 2000.0, 0.001, 0.02), bounds.diagonal() * 1e-5);
    if (finite_count <= kMostPoints) return spacing;
    std::vector<Vec3> good;
    if (finite_count < points.size())
        std::copy_if(points.begin(), points.end(), std::back_inserter(good), finite);
    const std::vector<Vec3>& counted = good.empty() ? points : good;
    size_t most = kMostPoints;
    if (finite_count > kOneOf * kMostPoints)
        most = std::max(most, guess_cells(counted, safe_layout(bounds, kPlace), progress) / kOneOf);
    // The count falls with some power of the spacing: 2 for a dense surface, next to 0 where the points are
    // far apart already. Two counts tell the power.
    const double wanted = 0.99 * static_cast<double>(most);
    double power = 2.0;
    double last_spacing = 0.0;
    double last_count = 0.0;
    for (;;) {
        const double count =
            static_cast<double>(guess_cells(counted, safe_layout(bounds, spacing), progress));
        if (count <= wanted) break;
        if (last_count > count)
            power = portable::log(last_count / count) / portable::log(spacing / last_spacing);
        last_spacing = spacing;
        last_count = count;
        const double excess = count / wanted;
        spacing *= std::clamp(portable::pow(excess, 1.0 / std::clamp(power, 0.2, 3.0)), 1.01,
                              excess > 4.0 ? 2.0 : 1.3);
    }
    while (count_cells(counted, safe_layout(bounds, spacing), most, progress) > most)
        spacing *= 1.02;
    return spacing;
}

}  // namespace treerec
