#include "scan/plots/plot_guide.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <queue>

#include "geometry/quantile.h"
#include "geometry/random.h"

namespace treerec {

namespace {

constexpr size_t kGuides = 400000;  // points
constexpr double kColumn = 4.0;     // metres

// Some of the points, chosen by their own places, so that their order is no matter.
class Chosen {
  public:
    void add(const DVec3& p) {
        const uint64_t hash = hash_seed(std::bit_cast<uint64_t>(p.x) ^ std::bit_cast<uint64_t>(p.y),
                                        std::bit_cast<uint64_t>(p.z));
        if (points_.size() < kGuides) return points_.emplace(hash, p);
        if (hash >= points_.top().first) return;
        points_.pop();
        points_.emplace(hash, p);
    }
    std::vector<DVec3> take() {
        std::vector<DVec3> all;
        for (; !points_.empty(); points_.pop())
            all.push_back(points_.top().second);
        return all;
    }

  private:
    using Entry = std::pair<uint64_t, DVec3>;
    struct Less {
        bool operator()(const Entry& a, const Entry& b) const {
            if (a.first != b.first) return a.first < b.first;
            if (a.second.x != b.second.x) return a.second.x < b.second.x;
            return a.second.y != b.second.y ? a.second.y < b.second.y : a.second.z < b.second.z;
        }
    };
    std::priority_queue<Entry, std::vector<Entry>, Less> points_;
};

DVec3 middle_of(const std::vector<DVec3>& points) {
    DVec3 middle(0.0);
    std::vector<double> values(points.size());
    for (int axis = 0; axis < 3; axis++) {
        for (size_t i = 0; i < points.size(); i++)
            values[i] = points[i][axis];
        middle[axis] = std::round(quantile(values, 0.5)) + 0.0;
    }
    return middle;
}

// How high the highest of the columns are, from their own ground: a plot may lie on a slope.
double height_of(const std::vector<Vec3>& points) {
    std::map<std::pair<long, long>, std::vector<float>> columns;
    for (const Vec3& p : points)
        columns[{std::lround(static_cast<double>(p.x) / kColumn),
                 std::lround(static_cast<double>(p.z) / kColumn)}]
            .push_back(p.y);
    std::vector<float> heights{0.0F};
    for (auto& [place, levels] : columns)
        if (levels.size() >= 10) heights.push_back(quantile(levels, 0.99) - quantile(levels, 0.01));
    return static_cast<double>(quantile(heights, 0.95));
}

// As far out as points are, but no further beyond the usual than dust may be.
Range extent_of(const Range& usual, double low, double high) {
    const double room = std::max(1.0, 0.02 * usual.size());
    return {std::max(low, usual.low - room), std::min(high, usual.high + room)};
}

}  // namespace

PlotGuide guide_to(CloudPieces& pieces, const OrientOptions& options, Progress* progress) {
    PlotGuide guide;
    Chosen chosen;
    Bounds bounds;
    PointCloud some;
    pieces.each(
        [&](const PointCloud& piece) {
            if (guide.points == 0) some.unit = piece.unit;
            guide.points += piece.size();
            guide.has_colors = guide.has_colors || piece.has_colors();
            for (const Vec3& p : piece.positions) {
                const DVec3 place = piece.frame.to_scan(DVec3(p));
                bounds.add(place);
                chosen.add(place);
            }
        },
        progress);
    const std::vector<DVec3> points = chosen.take();
    some.frame.origin = middle_of(points);
    for (const DVec3& p : points)
        some.positions.emplace_back(p - some.frame.origin);
    // Only whether there are any tells something.
    if (guide.has_colors) some.colors.assign(points.size(), Color8{});
    OrientReport report = orient_cloud(some, options, progress);
    guide.warnings = std::move(report.warnings);
    guide.frame = some.frame;
    Bounds turned;
    for (const DVec3& corner : {bounds.min, bounds.max})
        turned.add(guide.frame.to_tree(corner));
    const std::array<Range, 3> usual = robust_ranges(some.positions, progress);
    guide.x = extent_of(usual[0], turned.min.x, turned.max.x);
    guide.y = extent_of(usual[1], turned.min.y, turned.max.y);
    guide.z = extent_of(usual[2], turned.min.z, turned.max.z);
    guide.height = height_of(some.positions);
    return guide;
}

}  // namespace treerec
