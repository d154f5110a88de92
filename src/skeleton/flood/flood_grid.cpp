#include "skeleton/flood/flood_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "geometry/bounds.h"
#include "skeleton/sampling/bridges.h"

namespace treerec {

namespace {

constexpr double kFirstVoxel = 1.5;      // spacings: the smallest size that is tried,
constexpr double kNextVoxel = 1.25;      // times the one before,
constexpr double kClosed = 1.5;          // times the size that hangs together: then bark has no holes
constexpr double kLargestVoxel = 0.003;  // and of the tree's extent: the largest, that twigs stay apart
constexpr double kStem = 0.004;    // of the extent of a stem without branches: bark hangs together at that
constexpr size_t kSpeck = 20;      // points: a smaller part is a speck
constexpr double kTogether = 0.6;  // of the points must lie in larger ones; gaps are bridged
constexpr double kFewestVoxels = 8.0;  // along the tree
constexpr size_t kGrain = 4096;        // voxels between two looks at the cancel flag

std::string in_metres(double value) {
    std::array<char, 32> text;
    std::snprintf(text.data(), text.size(), "%.4g m", value);
    return text.data();
}

Bounds bounds_of(const std::vector<Vec3>& points) {
    Bounds bounds;
    for (const Vec3& p : points)
        bounds.add(DVec3(p));
    return bounds;
}

double extent_of(const Bounds& bounds) {
    const DVec3 size = bounds.size();
    return std::max({size.x, size.y, size.z});
}

CellLayout layout_of(const std::vector<Vec3>& points, double voxel) {
    const Bounds bounds = bounds_of(points);
    const double extent = extent_of(bounds);
    if (voxel * kFewestVoxels > extent)
        throw Error("Voxels of " + in_metres(voxel) + " are too large for a tree of " + in_metres(extent) +
                    ": it would be a few boxes. Take at most " + in_metres(extent / kFewestVoxels) +
                    ", or leave the size to be found out.");
    const double least = extent / (CellLayout::kMostCells - 2.0);
    if (voxel < least)
        throw Error("Voxels of " + in_metres(voxel) + " are too small for a tree of " + in_metres(extent) +
                    ": memory holds none below " + in_metres(least) +
                    ". Take larger ones, or leave the size to be found out.");
    return {bounds.min, voxel};
}

}  // namespace

FloodGrid::FloodGrid(const std::vector<Vec3>& points, double voxel, Progress& progress)
    : FloodGrid(points, layout_of(points, voxel), progress) {}

FloodGrid FloodGrid::any_size(const std::vector<Vec3>& points, double voxel, Progress& progress) {
    const Bounds bounds = bounds_of(points);
    const double least = extent_of(bounds) / (CellLayout::kMostCells - 2.0);
    return {points, CellLayout{bounds.min, std::max(voxel, least)}, progress};
}

FloodGrid::FloodGrid(const std::vector<Vec3>& points, const CellLayout& layout, Progress& progress)
    : cells(points, layout, &progress), means(cells.size()) {
    for (size_t c = 0; c < size(); c++) {
        if (c % kGrain == 0) progress.check();
        DVec3 sum(0.0);
        for (const uint32_t i : cells.in_cell(c))
            sum += DVec3(points[i]);
        means[c] = Vec3(sum / static_cast<double>(cells.in_cell(c).size()));
    }
    std::vector<PointEdge> edges;
    Groups groups(size());
    size_t checks = 0;
    cells.for_neighbour_runs([&](size_t c, size_t first, size_t last) {
        if (++checks % kGrain == 0) progress.check();
        for (size_t n = std::max(first, c + 1); n < last; n++) {
            edges.emplace_back(static_cast<uint32_t>(c), static_cast<uint32_t>(n));
            groups.join(edges.back().first, edges.back().second);
        }
    });
    const size_t touching = edges.size();
    if (size() > 1) {
        const PointTree tree(means);
        bridge_parts(means, tree, std::move(groups), edges, progress);
    }

    // Rows, each in ascending order; a link over a gap is told by its place among the edges.
    std::vector<uint32_t> order(edges.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return edges[a] < edges[b]; });
    progress.check();
    graph.begin.assign(size() + 1, 0);
    for (const auto& [a, b] : edges) {
        graph.begin[a + 1]++;
        graph.begin[b + 1]++;
    }
    std::partial_sum(graph.begin.begin(), graph.begin.end(), graph.begin.begin());
    graph.neighbour.resize(2 * edges.size());
    graph.length.resize(2 * edges.size());
    bridge.assign(2 * edges.size(), 0);
    std::vector<uint32_t> next(graph.begin.begin(), graph.begin.end() - 1);
    const auto put = [&](uint32_t from, uint32_t to, uint32_t edge) {
        const uint32_t at = next[from]++;
        graph.neighbour[at] = to;
        graph.length[at] = glm::distance(means[from], means[to]);
        bridge[at] = edge >= touching;
    };
    // First what is before each voxel, then what is behind it.
    for (const uint32_t e : order)
        put(edges[e].second, edges[e].first, e);
    for (const uint32_t e : order)
        put(edges[e].first, edges[e].second, e);
}

DVec3 FloodGrid::centre(size_t voxel) const {
    const uint64_t key = cells.keys[voxel];
    constexpr uint64_t kMask = (uint64_t{1} << CellLayout::kBits) - 1;
    const DVec3 index(static_cast<double>(key >> 21 & kMask), static_cast<double>(key >> 42 & kMask),
                      static_cast<double>(key & kMask));
    return cells.layout.low + (index - 0.5) * cells.layout.cell;
}

double automatic_voxel(const std::vector<Vec3>& points, double spacing, bool one_stem,
                       const Progress& progress) {
    const Bounds bounds = bounds_of(points);
    if (one_stem) return kClosed * std::max(kFirstVoxel * spacing, kStem * extent_of(bounds));
    const double largest = kLargestVoxel * extent_of(bounds);
    double voxel = kFirstVoxel * spacing;
    for (; voxel * kNextVoxel <= largest; voxel *= kNextVoxel) {
        const CellGrid cells(points, {bounds.min, voxel}, &progress);
        Groups groups(cells.size());
        cells.for_neighbour_runs([&](size_t c, size_t first, size_t last) {
            for (size_t n = std::max(first, c + 1); n < last; n++)
                groups.join(static_cast<uint32_t>(c), static_cast<uint32_t>(n));
        });
        std::vector<size_t> held(cells.size(), 0);
        for (uint32_t c = 0; c < cells.size(); c++)
            held[groups.find(c)] += cells.in_cell(c).size();
        size_t together = 0;
        for (const size_t count : held)
            if (count >= kSpeck) together += count;
        if (static_cast<double>(together) >= kTogether * static_cast<double>(points.size())) break;
    }
    return kClosed * voxel;
}

}  // namespace treerec
