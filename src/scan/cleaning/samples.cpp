#include "scan/cleaning/samples.h"

#include <algorithm>
#include <limits>

#include "geometry/cell_grid.h"
#include "geometry/groups.h"
#include "geometry/parallel.h"

namespace treerec {

namespace {

constexpr double kFinestCells = 16384.0;  // along the extent: next to no two points share one
constexpr size_t kCellsPerTask = 8192;
constexpr size_t kSamplesOfTree = 400000;
constexpr double kMostSamples = 3e6;
constexpr double kStepsOfCell = 4096.0;

DVec3 low_corner(const std::array<Range, 3>& ranges) {
    return {ranges[0].low, ranges[1].low, ranges[2].low};
}

bool comes_before(const Vec3& a, const Vec3& b) {
    if (a.x != b.x) return a.x < b.x;
    if (a.y != b.y) return a.y < b.y;
    return a.z < b.z;
}

Samples distinct_points(const std::vector<Vec3>& positions, CellGrid& grid) {
    Samples samples;
    samples.points.reserve(positions.size());
    samples.of_point.resize(positions.size());
    for (size_t c = 0; c < grid.size(); c++) {
        const auto first = grid.order.begin() + grid.begin[c];
        const auto last = grid.order.begin() + grid.begin[c + 1];
        if (last - first > 1)
            std::sort(first, last,
                      [&](uint32_t a, uint32_t b) { return comes_before(positions[a], positions[b]); });
        for (auto i = first; i != last; ++i) {
            if (i == first || samples.points.back() != positions[*i]) samples.points.push_back(positions[*i]);
            samples.of_point[*i] = static_cast<uint32_t>(samples.points.size() - 1);
        }
    }
    return samples;
}

}  // namespace

size_t samples_for(const std::vector<Vec3>& positions, const Progress* progress) {
    if (positions.size() <= kSamplesOfTree) return kSamplesOfTree;
    const std::array<Range, 3> ranges = robust_ranges(positions, progress);
    const double height = std::max(ranges[1].size(), 1e-6);
    const double squares = std::max(1.0, ranges[0].size() * ranges[2].size() / (height * height));
    return static_cast<size_t>(std::min(squares * kSamplesOfTree, kMostSamples));
}

Samples take_samples(const std::vector<Vec3>& positions, size_t limit, const Progress* progress) {
    const std::array<Range, 3> ranges = robust_ranges(positions, progress);
    const double extent = std::max({ranges[0].size(), ranges[1].size(), ranges[2].size(), 1e-6});
    CellLayout layout{low_corner(ranges), extent / kFinestCells};
    if (positions.size() <= limit) {
        CellGrid grid(positions, layout, progress);
        Samples samples = distinct_points(positions, grid);
        samples.ranges = ranges;
        return samples;
    }
    // A surface has cells by the square of the fineness.
    layout.cell = extent / 2000.0;
    const double wanted = 0.95 * static_cast<double>(limit);
    for (double cells = 2.0 * wanted; cells > wanted;) {
        cells = static_cast<double>(guess_cells(positions, layout, progress));
        if (cells > wanted) layout.cell *= std::max(1.05, std::sqrt(cells / wanted));
    }

    const CellGrid grid(positions, layout, progress);
    Samples samples;
    samples.ranges = ranges;
    samples.of_point.resize(positions.size());
    samples.points.resize(grid.size());
    // The first point in canonical order stands for its cell.
    parallel_for(grid.size(), kCellsPerTask, [&](size_t begin, size_t end) {
        if (progress) progress->check();
        for (size_t c = begin; c < end; c++) {
            uint32_t first = grid.in_cell(c).front();
            for (const uint32_t i : grid.in_cell(c)) {
                samples.of_point[i] = static_cast<uint32_t>(c);
                if (comes_before(positions[i], positions[first])) first = i;
            }
            samples.points[c] = positions[first];
        }
    });
    return samples;
}

Samples average_points(const std::vector<Vec3>& positions, const std::array<Range, 3>& ranges, double cell,
                       const Progress* progress) {
    const DVec3 low = low_corner(ranges);
    const CellGrid grid(positions, {low, cell}, progress);
    // Sums of whole steps, so that the order of the points is no matter.
    const double step = cell / kStepsOfCell;
    Samples means;
    means.ranges = ranges;
    means.points.resize(grid.size());
    means.of_point.resize(positions.size());
    parallel_for(grid.size(), kCellsPerTask, [&](size_t begin, size_t end) {
        if (progress) progress->check();
        for (size_t c = begin; c < end; c++) {
            std::array<int64_t, 3> sum{};
            for (const uint32_t i : grid.in_cell(c)) {
                for (int axis = 0; axis < 3; axis++)
                    sum[static_cast<size_t>(axis)] +=
                        static_cast<int64_t>((positions[i][axis] - low[axis]) / step);
                means.of_point[i] = static_cast<uint32_t>(c);
            }
            const auto count = static_cast<double>(grid.in_cell(c).size());
            for (int axis = 0; axis < 3; axis++)
                means.points[c][axis] = static_cast<float>(
                    low[axis] + step * static_cast<double>(sum[static_cast<size_t>(axis)]) / count);
        }
    });
    return means;
}

std::vector<uint32_t> connected_components(const std::vector<Vec3>& points,
                                           const std::array<Range, 3>& ranges, double cell,
                                           const Progress* progress) {
    const CellGrid grid(points, {low_corner(ranges), cell}, progress);
    Groups groups(grid.size());
    grid.for_neighbour_runs([&](size_t c, size_t first, size_t last) {
        for (size_t other = first; other < last && other < c; other++)
            groups.join(static_cast<uint32_t>(c), static_cast<uint32_t>(other));
    });
    std::vector<uint32_t> component(points.size());
    for (size_t c = 0; c < grid.size(); c++) {
        const uint32_t group = groups.find(static_cast<uint32_t>(c));
        for (const uint32_t i : grid.in_cell(c))
            component[i] = group;
    }
    constexpr uint32_t kUnlabelled = std::numeric_limits<uint32_t>::max();
    std::vector<uint32_t> label_of_group(grid.size(), kUnlabelled);
    uint32_t next = 0;
    for (uint32_t& c : component) {
        uint32_t& label = label_of_group[c];
        if (label == kUnlabelled) label = next++;
        c = label;
    }
    return component;
}

}  // namespace treerec
