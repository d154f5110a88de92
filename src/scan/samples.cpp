#include "scan/samples.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace treerec {

namespace {

constexpr uint64_t kMostCells = (uint64_t{1} << 21) - 2;  // along an axis, so that a key fits 63 bits

struct Grid {
    DVec3 origin{0.0};
    double cell = 1.0;

    // Far-off points fall into the outermost cells. Index 0 is left free, so that a neighbour's key exists.
    uint64_t key(const Vec3& p) const {
        uint64_t key = 0;
        for (int axis = 0; axis < 3; axis++) {
            const double index = std::floor((p[axis] - origin[axis]) / cell) + 1.0;
            key = key << 21 | static_cast<uint64_t>(std::clamp(index, 1.0, static_cast<double>(kMostCells)));
        }
        return key;
    }
};

DVec3 low_corner(const std::array<Range, 3>& ranges) {
    return {ranges[0].low, ranges[1].low, ranges[2].low};
}

bool comes_before(const Vec3& a, const Vec3& b) {
    if (a.x != b.x) return a.x < b.x;
    if (a.y != b.y) return a.y < b.y;
    return a.z < b.z;
}

struct Keyed {
    uint64_t key;
    uint32_t index;
};

std::vector<Keyed> keyed_by_cell(const std::vector<Vec3>& points, const Grid& grid) {
    std::vector<Keyed> keyed(points.size());
    for (size_t i = 0; i < points.size(); i++)
        keyed[i] = {grid.key(points[i]), static_cast<uint32_t>(i)};
    std::sort(keyed.begin(), keyed.end(), [](const Keyed& a, const Keyed& b) {
        return a.key != b.key ? a.key < b.key : a.index < b.index;
    });
    return keyed;
}

size_t count_cells(const std::vector<Keyed>& keyed) {
    size_t count = 0;
    for (size_t i = 0; i < keyed.size(); i++)
        count += i == 0 || keyed[i].key != keyed[i - 1].key;
    return count;
}

uint32_t find_root(std::vector<uint32_t>& parents, uint32_t i) {
    while (parents[i] != i) {
        parents[i] = parents[parents[i]];
        i = parents[i];
    }
    return i;
}

}  // namespace

Samples take_samples(const std::vector<Vec3>& positions, size_t limit, const Progress* progress) {
    Samples samples;
    samples.of_point.resize(positions.size());
    std::vector<uint32_t> chosen;  // a point of the cloud per sample
    if (positions.size() <= limit) {
        std::vector<uint32_t> order(positions.size());
        std::iota(order.begin(), order.end(), 0U);
        std::sort(order.begin(), order.end(),
                  [&](uint32_t a, uint32_t b) { return comes_before(positions[a], positions[b]); });
        for (const uint32_t i : order) {
            if (samples.points.empty() || samples.points.back() != positions[i])
                samples.points.push_back(positions[i]);
            samples.of_point[i] = static_cast<uint32_t>(samples.points.size() - 1);
        }
        return samples;
    }

    const std::array<Range, 3> ranges = robust_ranges(positions);
    const double extent = std::max({ranges[0].size(), ranges[1].size(), ranges[2].size(), 1e-6});
    std::vector<Keyed> keyed;
    for (double cell = extent / 2000.0;;) {
        if (progress) progress->check();
        keyed = keyed_by_cell(positions, {low_corner(ranges), cell});
        const size_t cells = count_cells(keyed);
        if (cells <= limit) break;
        // A surface has cells by the square of the fineness.
        cell *= std::max(1.2, std::sqrt(static_cast<double>(cells) / static_cast<double>(limit)));
    }
    // The first point in canonical order stands for its cell.
    std::vector<uint32_t> cell_of_point(positions.size());
    uint32_t cells = 0;
    for (size_t i = 0; i < keyed.size(); i++) {
        const uint32_t index = keyed[i].index;
        if (i == 0 || keyed[i].key != keyed[i - 1].key) {
            chosen.push_back(index);
            cells++;
        } else if (comes_before(positions[index], positions[chosen.back()])) {
            chosen.back() = index;
        }
        cell_of_point[index] = cells - 1;
    }
    std::vector<uint32_t> order(cells);
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
        return comes_before(positions[chosen[a]], positions[chosen[b]]);
    });
    std::vector<uint32_t> rank(cells);
    samples.points.resize(cells);
    for (uint32_t i = 0; i < cells; i++) {
        rank[order[i]] = i;
        samples.points[i] = positions[chosen[order[i]]];
    }
    for (size_t i = 0; i < positions.size(); i++)
        samples.of_point[i] = rank[cell_of_point[i]];
    return samples;
}

std::vector<uint32_t> connected_components(const std::vector<Vec3>& points, double cell) {
    const std::vector<Keyed> keyed = keyed_by_cell(points, {low_corner(robust_ranges(points)), cell});
    std::vector<uint64_t> cells;
    std::vector<uint32_t> cell_of_point(points.size());
    for (const Keyed& k : keyed) {
        if (cells.empty() || cells.back() != k.key) cells.push_back(k.key);
        cell_of_point[k.index] = static_cast<uint32_t>(cells.size() - 1);
    }
    std::vector<uint32_t> parents(cells.size());
    std::iota(parents.begin(), parents.end(), 0U);
    auto unite = [&](uint32_t a, uint32_t b) {
        a = find_root(parents, a);
        b = find_root(parents, b);
        if (a != b) parents[std::max(a, b)] = std::min(a, b);
    };
    // The half of the neighbours with larger keys, as runs of three along the last axis. One walker per run
    // moves forward only.
    for (int dx = 0; dx <= 1; dx++) {
        for (int dy = dx == 0 ? 0 : -1; dy <= 1; dy++) {
            const uint64_t shift =
                (static_cast<uint64_t>(dx) << 42) + (static_cast<uint64_t>(static_cast<int64_t>(dy)) << 21);
            size_t walker = 0;
            for (uint32_t c = 0; c < cells.size(); c++) {
                const uint64_t middle = cells[c] + shift;
                while (walker < cells.size() && cells[walker] < middle - 1)
                    walker++;
                for (size_t w = walker; w < cells.size() && cells[w] <= middle + 1; w++)
                    unite(c, static_cast<uint32_t>(w));
            }
        }
    }
    constexpr uint32_t kUnlabelled = std::numeric_limits<uint32_t>::max();
    std::vector<uint32_t> label_of_root(cells.size(), kUnlabelled);
    std::vector<uint32_t> labels(points.size());
    uint32_t next = 0;
    for (size_t i = 0; i < points.size(); i++) {
        uint32_t& label = label_of_root[find_root(parents, cell_of_point[i])];
        if (label == kUnlabelled) label = next++;
        labels[i] = label;
    }
    return labels;
}

}  // namespace treerec
