#include "scan/leaves/leaf_cells.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "geometry/bounds.h"
#include "geometry/cell_grid.h"
#include "geometry/parallel.h"
#include "geometry/portable_math.h"
#include "geometry/radix_sort.h"

namespace treerec {

namespace {

constexpr double kFinestShare = 1.0 / 600.0;  // of the cloud's extent
constexpr double kPointsPerCell = 3.0;
constexpr uint64_t kStepX = uint64_t{1} << 42;
constexpr uint64_t kStepY = uint64_t{1} << 21;
constexpr uint64_t kAxisMask = kStepY - 1;
constexpr size_t kGrain = 512;
constexpr int kMostTries = 12;

uint64_t coarse_key(uint64_t key, int shift) {
    return (((key / kStepX) >> shift) + 1) * kStepX + ((((key / kStepY) & kAxisMask) >> shift) + 1) * kStepY +
           ((key & kAxisMask) >> shift) + 1;
}

CellLayout choose_layout(const std::vector<Vec3>& points, const Progress& progress) {
    Bounds bounds;
    for (const Vec3& p : points)
        bounds.add(DVec3(p));
    const DVec3 extent = bounds.size();
    CellLayout layout{bounds.min, std::max({extent.x, extent.y, extent.z, 1e-6}) * kFinestShare};
    for (int i = 0; i < kMostTries; i++) {
        const auto count = static_cast<double>(guess_cells(points, layout, &progress));
        const double wanted = kPointsPerCell * count / static_cast<double>(points.size());
        if (wanted <= 1.03) break;
        // The number of cells falls with a power of their size between one and three.
        layout.cell *= std::clamp(std::sqrt(wanted), 1.04, 4.0);
    }
    return layout;
}

// Calls visit(neighbour) for the occupied cells around each cell of [begin, end), itself too, row by row of
// the grid. start(cell, row): rows of one cell come one after another only within one call of `rows`.
class Rows {
  public:
    Rows(const std::vector<uint64_t>& keys, size_t begin) : keys_(keys) {
        for (size_t row = 0; row < 9; row++)
            at_[row] = static_cast<size_t>(
                std::lower_bound(keys.begin(), keys.end(), keys[begin] + kFirst[row]) - keys.begin());
    }

    // Cells must come in rising order.
    template <typename Visit>
    void visit(size_t cell, Visit&& each) {
        for (size_t row = 0; row < 9; row++) {
            const uint64_t low = keys_[cell] + kFirst[row];
            size_t& at = at_[row];
            while (at < keys_.size() && keys_[at] < low)
                at++;
            for (size_t q = at; q < keys_.size() && keys_[q] <= low + 2; q++)
                each(q);
        }
    }

  private:
    // The first cell of each row, relative to the middle one; unsigned wrap-around does the subtraction.
    static constexpr std::array<uint64_t, 9> kFirst{
        0 - kStepX - kStepY - 1, 0 - kStepX - 1,  0 - kStepX + kStepY - 1,
        0 - kStepY - 1,          uint64_t{0} - 1, kStepY - 1,
        kStepX - kStepY - 1,     kStepX - 1,      kStepX + kStepY - 1};

    const std::vector<uint64_t>& keys_;
    std::array<size_t, 9> at_{};
};

void find_near(Cells& cells, const Progress& progress) {
    const size_t count = cells.count();
    std::vector<std::vector<uint32_t>> parts((count + kGrain - 1) / kGrain);
    cells.near_begin.assign(count + 1, 0);
    parallel_for(count, kGrain, [&](size_t begin, size_t end) {
        progress.check();
        std::vector<uint32_t>& part = parts[begin / kGrain];
        Rows rows(cells.keys, begin);
        for (size_t i = begin; i < end; i++) {
            const size_t before = part.size();
            rows.visit(i, [&](size_t q) {
                if (q != i) part.push_back(static_cast<uint32_t>(q));
            });
            cells.near_begin[i + 1] = static_cast<uint32_t>(part.size() - before);
        }
    });
    for (size_t i = 0; i < count; i++)
        cells.near_begin[i + 1] += cells.near_begin[i];
    cells.near.reserve(cells.near_begin[count]);
    for (const std::vector<uint32_t>& part : parts)
        cells.near.insert(cells.near.end(), part.begin(), part.end());
}

// Finest cells gathered in one coarse cell: their number, mean, and scatter about the mean (xx xy xz yy yz
// zz).
struct Gathered {
    float number = 0.0F;
    Vec3 mean{0.0F};
    std::array<float, 6> scatter{};
};

CellShape shape_of(const std::vector<Gathered>& cells, size_t own, Rows& rows, float coarseness) {
    float number = 0.0F;
    float occupied = -1.0F;
    Vec3 sum(0.0F);
    std::array<float, 6> product{};
    rows.visit(own, [&](size_t q) {
        const Gathered& other = cells[q];
        const Vec3 d = other.mean - cells[own].mean;
        number += other.number;
        occupied += 1.0F;
        sum += other.number * d;
        for (size_t i = 0; i < 6; i++)
            product[i] += other.scatter[i];
        add_product(product, d, other.number);
    });
    const Vec3 mean = sum / number;
    for (float& p : product)
        p /= number;
    add_product(product, mean, -1.0F);
    const Vec3 s = deviations(product);
    CellShape shape;
    if (s.x > 0.0F) {
        shape.linearity = (s.x - s.y) / s.x;
        shape.planarity = (s.y - s.z) / s.x;
        shape.scatter = s.z / s.x;
    }
    shape.occupied = occupied;
    shape.crowd = portable::log(number / coarseness);
    return shape;
}

void measure_scale(const Cells& cells, int scale, CellShapes& shapes, const Progress& progress) {
    const size_t count = cells.count();
    const float coarseness = static_cast<float>(1 << scale);
    // Keys of the finest grid are in order; those of a coarser one are not.
    std::vector<KeyedIndex> sorted(count);
    for (size_t i = 0; i < count; i++)
        sorted[i] = {coarse_key(cells.keys[i], scale), static_cast<uint32_t>(i)};
    if (scale > 0) radix_sort(sorted, &progress);
    std::vector<uint64_t> keys;
    std::vector<uint32_t> of_cell(count);
    std::vector<Gathered> gathered;
    for (size_t begin = 0, end = 0; begin < count; begin = end) {
        Gathered cell;
        const Vec3 start = cells.centres[sorted[begin].index];
        Vec3 sum(0.0F);
        for (end = begin; end < count && sorted[end].key == sorted[begin].key; end++) {
            const Vec3 d = cells.centres[sorted[end].index] - start;
            sum += d;
            add_product(cell.scatter, d, 1.0F);
            of_cell[sorted[end].index] = static_cast<uint32_t>(keys.size());
        }
        cell.number = static_cast<float>(end - begin);
        sum /= cell.number;
        add_product(cell.scatter, sum, -cell.number);
        cell.mean = start + sum;
        keys.push_back(sorted[begin].key);
        gathered.push_back(cell);
    }
    std::vector<CellShape> coarse(keys.size());
    parallel_for(keys.size(), kGrain, [&](size_t begin, size_t end) {
        progress.check();
        Rows rows(keys, begin);
        for (size_t i = begin; i < end; i++)
            coarse[i] = shape_of(gathered, i, rows, coarseness);
    });
    for (size_t i = 0; i < count; i++)
        shapes[i * kShapeScales + static_cast<size_t>(scale)] = coarse[of_cell[i]];
}

}  // namespace

void add_product(std::array<float, 6>& sum, const Vec3& d, float weight) {
    sum[0] += weight * d.x * d.x;
    sum[1] += weight * d.x * d.y;
    sum[2] += weight * d.x * d.z;
    sum[3] += weight * d.y * d.y;
    sum[4] += weight * d.y * d.z;
    sum[5] += weight * d.z * d.z;
}

Vec3 deviations(const std::array<float, 6>& m) {
    const double mean = (static_cast<double>(m[0]) + m[3] + m[5]) / 3.0;
    const double a = m[0] - mean, b = m[3] - mean, c = m[5] - mean;
    const double xy = m[1], xz = m[2], yz = m[4];
    const double p = std::sqrt((a * a + b * b + c * c + 2.0 * (xy * xy + xz * xz + yz * yz)) / 6.0);
    if (!(p > 1e-30)) return Vec3(static_cast<float>(std::sqrt(std::max(mean, 0.0))));
    const double det = a * (b * c - yz * yz) - xy * (xy * c - yz * xz) + xz * (xy * yz - b * xz);
    const double angle = portable::acos(std::clamp(det / (2.0 * p * p * p), -1.0, 1.0)) / 3.0;
    const double first = mean + 2.0 * p * portable::cos(angle);
    const double last = mean + 2.0 * p * portable::cos(angle + 2.0 * kPi / 3.0);
    const double middle = 3.0 * mean - first - last;
    return {static_cast<float>(std::sqrt(std::max(first, 0.0))),
            static_cast<float>(std::sqrt(std::max(middle, 0.0))),
            static_cast<float>(std::sqrt(std::max(last, 0.0)))};
}

Cells make_cells(const std::vector<Vec3>& points, const Progress& progress) {
    CellGrid grid(points, choose_layout(points, progress), &progress);
    Cells cells;
    cells.size = grid.layout.cell;
    cells.of_point.resize(points.size());
    cells.centres.resize(grid.size());
    parallel_for(grid.size(), kGrain, [&](size_t begin, size_t end) {
        progress.check();
        for (size_t c = begin; c < end; c++) {
            DVec3 sum(0.0);
            for (const uint32_t i : grid.in_cell(c)) {
                sum += DVec3(points[i]);
                cells.of_point[i] = static_cast<uint32_t>(c);
            }
            cells.centres[c] = Vec3(sum / static_cast<double>(grid.in_cell(c).size()));
        }
    });
    cells.keys = std::move(grid.keys);
    find_near(cells, progress);
    return cells;
}

void measure_shapes(const Cells& cells, int first, int last, CellShapes& shapes, const Progress& progress) {
    shapes.resize(cells.count() * kShapeScales);
    // The finest first: it takes the longest.
    parallel_for(static_cast<size_t>(last - first + 1), 1, [&](size_t scale, size_t) {
        measure_scale(cells, first + static_cast<int>(scale), shapes, progress);
    });
}

}  // namespace treerec
