#include "foliage/foliage.h"

#include <algorithm>
#include <cmath>

#include "error.h"
#include "geometry/bounds.h"

namespace treerec {

namespace {

constexpr double kEdge = 0.12;          // metres
constexpr double kFineShare = 0.03;     // of the crown, if that is less
constexpr double kExtentShare = 0.002;  // of the crown: no cell is smaller
constexpr double kPointsPerCell = 2.5;  // at least, on average
constexpr double kLeastGrowth = 1.03;
constexpr double kLargestEdge = 1e4;
constexpr size_t kMostPoints = UINT16_MAX;

struct Keyed {
    uint64_t key;
    uint32_t point;
};

uint64_t key_of(const Vec3& p, const DVec3& low, double inverse) {
    const DVec3 cell = glm::floor((DVec3(p) - low) * inverse);
    return (static_cast<uint64_t>(cell.x) << 32) | (static_cast<uint64_t>(cell.y) << 16) |
           static_cast<uint64_t>(cell.z);
}

std::vector<Keyed> sorted_keys(std::span<const Vec3> points, const DVec3& low, double edge) {
    std::vector<Keyed> keyed(points.size());
    for (size_t i = 0; i < points.size(); i++)
        keyed[i] = {key_of(points[i], low, 1.0 / edge), static_cast<uint32_t>(i)};
    std::sort(keyed.begin(), keyed.end(), [](const Keyed& a, const Keyed& b) { return a.key < b.key; });
    return keyed;
}

size_t count_cells(const std::vector<Keyed>& keyed) {
    size_t count = keyed.empty() ? 0 : 1;
    for (size_t i = 1; i < keyed.size(); i++)
        count += keyed[i].key != keyed[i - 1].key;
    return count;
}

}  // namespace

Foliage gather_foliage(std::span<const Vec3> points, std::span<const std::array<uint8_t, 3>> colors) {
    Foliage foliage;
    if (points.empty()) return foliage;
    Bounds bounds;
    for (const Vec3& p : points)
        bounds.add(DVec3(p));
    const DVec3 size = bounds.size();
    const double extent = std::max({size.x, size.y, size.z});
    foliage.edge = std::max(std::min(kEdge, kFineShare * extent), std::max(kExtentShare * extent, 1e-4));
    std::vector<Keyed> keyed = sorted_keys(points, bounds.min, foliage.edge);
    for (;;) {
        const auto count = static_cast<double>(count_cells(keyed));
        const double too_many = std::max(count / static_cast<double>(kMostFoliageCells),
                                         kPointsPerCell * count / static_cast<double>(points.size()));
        if (count <= 1.0 || too_many <= 1.0) break;
        // The number of cells falls with the square of their edge, or faster.
        foliage.edge *= std::max(std::sqrt(too_many), kLeastGrowth);
        keyed = sorted_keys(points, bounds.min, foliage.edge);
    }
    foliage.origin = bounds.min;
    foliage.colored = !colors.empty();
    for (size_t begin = 0, end = 0; begin < keyed.size(); begin = end) {
        std::array<uint64_t, 3> sum{};
        for (end = begin; end < keyed.size() && keyed[end].key == keyed[begin].key; end++)
            for (size_t c = 0; c < 3 && foliage.colored; c++)
                sum[c] += colors[keyed[end].point][c];
        FoliageCell cell;
        cell.x = static_cast<uint16_t>(keyed[begin].key >> 32);
        cell.y = static_cast<uint16_t>(keyed[begin].key >> 16);
        cell.z = static_cast<uint16_t>(keyed[begin].key);
        cell.points = static_cast<uint16_t>(std::min(end - begin, kMostPoints));
        for (size_t c = 0; c < 3; c++)
            cell.color[c] = static_cast<uint8_t>(sum[c] / (end - begin));
        foliage.cells.push_back(cell);
    }
    return foliage;
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
        if (before && std::array{before->x, before->y, before->z} >= std::array{cell.x, cell.y, cell.z})
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
