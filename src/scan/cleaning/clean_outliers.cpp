#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/cell_grid.h"
#include "geometry/parallel.h"
#include "geometry/point_tree.h"
#include "scan/cleaning/clean_steps.h"
#include "scan/robust.h"

namespace treerec {

namespace {

constexpr int kMostNeighbours = 64;
// A point's neighbour distance must be this many times that of its neighbours.
constexpr double kLocalContrast = 2.5;
// Of a scan that has so many points, what lies so many times the typical distance apart is dust, however
// sparse all around it is: a thousandth of a large scan's points are many, and lie near enough to each other
// to look like sparse twigs. (Of a small scan, twigs may be as sparse.)
constexpr size_t kManyPoints = 200000;
constexpr double kDust = 25.0;
constexpr size_t kTypical = 512;  // points that tell the typical distance
constexpr double kReach = 0.75;   // of the limit: the cells in which a point is looked for company
constexpr size_t kPointsPerTask = 512;

// Mean distances to the nearest neighbours, found when they are asked for.
class Neighbours {
  public:
    // points: distinct, more than `count`.
    Neighbours(const std::vector<Vec3>& points, size_t count, const Progress* progress)
        : points_(points),
          count_(count),
          progress_(progress),
          tree_(points, progress),
          distance_(points.size(), -1.0F) {}

    // which: distinct indices.
    void find(const std::vector<uint32_t>& which) { search(which, nullptr); }

    // Also the neighbours of each, `count` indices after one another.
    std::vector<uint32_t> find_nearest(const std::vector<uint32_t>& which) {
        std::vector<uint32_t> nearest(which.size() * count_);
        search(which, &nearest);
        return nearest;
    }
    double distance(uint32_t i) const { return distance_[i]; }

  private:
    void search(const std::vector<uint32_t>& which, std::vector<uint32_t>* nearest) {
        parallel_for(which.size(), kPointsPerTask, [&](size_t begin, size_t end) {
            if (progress_) progress_->check();
            std::array<uint32_t, kMostNeighbours + 1> found{};
            std::array<float, kMostNeighbours + 1> squares{};
            for (size_t w = begin; w < end; w++) {
                const uint32_t i = which[w];
                if (!nearest && distance_[i] >= 0.0F) continue;
                // The first one found is the point itself, as all points are distinct.
                tree_.nearest(points_[i], count_ + 1, found.data(), squares.data());
                double sum = 0.0;
                for (size_t n = 0; n < count_; n++) {
                    sum += std::sqrt(static_cast<double>(squares[n + 1]));
                    if (nearest) (*nearest)[w * count_ + n] = found[n + 1];
                }
                distance_[i] = static_cast<float>(sum / static_cast<double>(count_));
            }
        });
    }

    const std::vector<Vec3>& points_;
    size_t count_;
    const Progress* progress_;
    PointTree tree_;
    std::vector<float> distance_;
};

// The points with fewer than `least` others in the block of 3 x 3 x 3 cells around them.
std::vector<uint32_t> thinly_surrounded(const std::vector<Vec3>& points, const CellLayout& layout,
                                        size_t least, const Progress* progress) {
    const CellGrid grid(points, layout, progress);
    std::vector<uint32_t> around(grid.size());
    grid.for_neighbour_runs(
        [&](size_t c, size_t first, size_t last) { around[c] += grid.begin[last] - grid.begin[first]; });
    std::vector<uint32_t> thin;
    for (size_t c = 0; c < grid.size(); c++)
        if (around[c] <= least) thin.insert(thin.end(), grid.in_cell(c).begin(), grid.in_cell(c).end());
    return thin;
}

}  // namespace

std::vector<uint8_t> find_outliers(const std::vector<Vec3>& points, const std::array<Range, 3>& ranges, int k,
                                   double deviations, double& spacing, const Progress* progress) {
    std::vector<uint8_t> goes(points.size());
    spacing = 0.0;
    const size_t count = static_cast<size_t>(std::clamp(k, 1, kMostNeighbours));
    if (points.size() <= count + 1) return goes;
    if (progress) progress->check();
    Neighbours neighbours(points, count, progress);

    std::vector<uint32_t> which;
    const size_t stride = std::max<size_t>(1, points.size() / kTypical);
    for (size_t i = stride / 2; i < points.size(); i += stride)
        which.push_back(static_cast<uint32_t>(i));
    neighbours.find(which);
    std::vector<double> values;
    for (const uint32_t i : which)
        values.push_back(neighbours.distance(i));
    spacing = quantile(values, 0.95);
    const double median = quantile(values, 0.5);
    for (double& v : values)
        v = std::abs(v - median);
    const double limit = median + deviations * 1.4826 * quantile(values, 0.5);

    // Whoever has enough points within reach is near them; the others are looked at closely.
    const double extent = std::max({ranges[0].size(), ranges[1].size(), ranges[2].size()});
    which = thinly_surrounded(
        points,
        {{ranges[0].low, ranges[1].low, ranges[2].low}, std::max({kReach * limit, 1e-6 * extent, 1e-12})},
        count, progress);
    neighbours.find(which);
    std::erase_if(which, [&](uint32_t i) { return neighbours.distance(i) <= limit; });
    const std::vector<uint32_t> nearest = neighbours.find_nearest(which);
    std::vector<uint32_t> around = nearest;
    std::sort(around.begin(), around.end());
    around.erase(std::unique(around.begin(), around.end()), around.end());
    neighbours.find(around);
    for (size_t w = 0; w < which.size(); w++) {
        values.clear();
        for (size_t n = 0; n < count; n++)
            values.push_back(neighbours.distance(nearest[w * count + n]));
        const double distance = neighbours.distance(which[w]);
        goes[which[w]] = distance > kLocalContrast * quantile(values, 0.5) ||
                         (points.size() >= kManyPoints && distance > kDust * median);
    }
    return goes;
}

}  // namespace treerec
