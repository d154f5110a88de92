#include "growth/bark_map.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "error.h"
#include "fidelity/score.h"
#include "geometry/parallel.h"
#include "geometry/quantile.h"
#include "geometry/segment.h"
#include "tree/wood_segments.h"

namespace treerec::growth {

namespace {

constexpr double kFarthest = 2.0;            // radii from the axis beyond which a point is of something else,
constexpr double kAir = 0.05;                // and metres more
constexpr double kSpread = 0.6;              // of a cell's height: how much points of one sheet vary at most,
constexpr double kNoisy = 4.0;               // or so many times as usual
constexpr double kNormalDeviation = 1.4826;  // of a median absolute deviation
constexpr size_t kFewPoints = 4;             // of which a spread can be told
constexpr size_t kMostPoints = 1'000'000;
constexpr size_t kPointsPerCheck = 2048;

std::vector<WoodSegment> segments_of(const GrowthBranch& branch) {
    std::vector<WoodSegment> segments;
    for (size_t i = 1; i < branch.axis.size(); i++) {
        const AxisPlace &a = branch.axis[i - 1], &b = branch.axis[i];
        segments.push_back(
            {a.position, b.position, 0.5 * (a.radius + b.radius), static_cast<NodeId>(i), a.radius});
    }
    return segments;
}

}  // namespace

BarkAxes::BarkAxes(const Tree& tree, const BranchList& list, const TreePlan& planned)
    : planned_(planned), wood_({}) {
    std::vector<WoodSegment> wood;
    const auto add = [&](WoodSegment segment, int32_t branch) {
        segment.child = static_cast<NodeId>(branch_.size());
        wood.push_back(segment);
        branch_.push_back(branch);
    };
    std::vector<uint8_t> covered(list.branches.size(), 0);
    for (size_t b = 0; b < planned.plan.branches.size(); b++) {
        const GrowthBranch& branch = planned.plan.branches[b];
        covered[static_cast<size_t>(planned.branch_of[b])] = 1;
        coordinates_.emplace_back(branch);
        axes_.emplace_back(segments_of(branch));
        for (const WoodSegment& segment : segments_of(branch))
            add(segment, static_cast<int32_t>(b));
    }
    for (const WoodSegment& segment : wood_segments(tree))
        if (!covered[static_cast<size_t>(list.branch_of[static_cast<size_t>(segment.child)])])
            add(segment, -1);
    wood_ = CapsuleTree(std::move(wood));
}

std::pair<AxisPlace, double> BarkAxes::nearest(int32_t branch, const DVec3& p) const {
    const CapsuleTree::Hit hit = axes_[static_cast<size_t>(branch)].nearest_axis(p);
    const WoodSegment& segment = axes_[static_cast<size_t>(branch)].segment(hit.segment);
    const std::vector<AxisPlace>& axis = planned_.plan.branches[static_cast<size_t>(branch)].axis;
    const AxisPlace &a = axis[static_cast<size_t>(segment.child) - 1],
                    &b = axis[static_cast<size_t>(segment.child)];
    double t = 0.0;
    distance_to_segment(p, a.position, b.position, &t);
    return {place_at(planned_.plan.branches[static_cast<size_t>(branch)], glm::mix(a.along, b.along, t)),
            hit.distance};
}

// What lies within thick wood may be as near to the round ends of segments farther along: so the place is
// that of the nearest axis.
std::optional<BarkSpot> BarkAxes::find(const DVec3& p) const {
    BarkHit hit;
    wood_.find_bark(p, hit);
    if (hit.child == kNoNode) return std::nullopt;
    const int32_t branch = branch_[static_cast<size_t>(hit.child)];
    if (branch < 0) return std::nullopt;
    const auto [axis, out] = nearest(branch, p);
    if (out > kFarthest * axis.radius + kAir) return std::nullopt;
    return BarkSpot{branch, 0, axis.along, coordinates(branch).around(p, axis.along), out};
}

std::vector<BarkSpot> BarkAxes::find_all(std::span<const DVec3> points, const Progress* progress) const {
    std::vector<std::optional<BarkSpot>> all(points.size());
    parallel_for(points.size(), kPointsPerCheck, [&](size_t begin, size_t end) {
        if (progress) progress->check();
        for (size_t i = begin; i < end; i++)
            all[i] = find(points[i]);
    });
    std::vector<BarkSpot> found;
    for (size_t i = 0; i < all.size(); i++) {
        if (!all[i]) continue;
        found.push_back(*all[i]);
        found.back().point = static_cast<uint32_t>(i);
    }
    return found;
}

std::pair<double, double> BarkAxes::own_part(int32_t branch) const {
    const GrowthBranch& own = planned_.plan.branches[static_cast<size_t>(branch)];
    const double covered =
        planned_.covered[static_cast<size_t>(planned_.branch_of[static_cast<size_t>(branch)])];
    const double end = std::min(covered, own.axis.back().along);
    if (own.parent < 0) return {0.0, end};
    const AxisPlace base =
        place_at(planned_.plan.branches[static_cast<size_t>(own.parent)], own.parent_along);
    for (const AxisPlace& place : own.axis) {
        const DVec3 off = place.position - base.position;
        if (glm::length(off - base.direction * glm::dot(off, base.direction)) > base.radius + place.radius)
            return {place.along, end};
    }
    return {end, end};
}

std::optional<size_t> BarkMap::cell_of(const BarkSpot& spot) const {
    const double row = std::floor((spot.along - begin) / step);
    if (!(row >= 0.0 && row < static_cast<double>(rows))) return std::nullopt;
    const size_t column = static_cast<size_t>(spot.around * static_cast<double>(columns)) % columns;
    return cell(static_cast<size_t>(row), column);
}

BarkMap map_bark(const GrowthBranch& branch, std::span<const BarkSpot> spots, double begin, double end,
                 double step, size_t columns) {
    BarkMap map;
    map.begin = begin;
    map.step = step;
    map.rows = static_cast<size_t>(std::max(std::floor((end - begin) / step), 0.0));
    map.columns = columns;
    for (size_t row = 0; row < map.rows; row++)
        map.radius.push_back(place_at(branch, map.along(row)).radius);
    const size_t cells = map.rows * columns;
    map.height.assign(cells, std::numeric_limits<double>::quiet_NaN());
    map.count.assign(cells, 0);
    for (const BarkSpot& spot : spots)
        if (const std::optional<size_t> cell = map.cell_of(spot)) map.count[*cell]++;
    std::vector<size_t> first(cells + 1, 0);
    for (size_t i = 0; i < cells; i++)
        first[i + 1] = first[i] + map.count[i];
    std::vector<double> heights(first.back());
    std::vector<size_t> next(first.begin(), first.end() - 1);
    for (const BarkSpot& spot : spots)
        if (const std::optional<size_t> cell = map.cell_of(spot))
            heights[next[*cell]++] = spot.out - place_at(branch, spot.along).radius;
    std::vector<double> spread(cells, 0.0), usual, some;
    for (size_t i = 0; i < cells; i++) {
        if (map.count[i] == 0) continue;
        some.assign(heights.begin() + static_cast<std::ptrdiff_t>(first[i]),
                    heights.begin() + static_cast<std::ptrdiff_t>(first[i + 1]));
        map.height[i] = quantile(some, 0.5);
        if (map.count[i] < kFewPoints) continue;
        for (double& height : some)
            height = std::abs(height - map.height[i]);
        spread[i] = kNormalDeviation * quantile(some, 0.5);
        usual.push_back(spread[i]);
    }
    if (!usual.empty()) map.noise = quantile(usual, 0.5);
    for (size_t i = 0; i < cells; i++)
        if (spread[i] > std::max(kNoisy * map.noise, kSpread * step))
            map.height[i] = std::numeric_limits<double>::quiet_NaN();
    return map;
}

std::vector<DVec3> points_near(const Tree& tree, const PointCloud& cloud) {
    if (cloud.empty()) throw Error("The scan has no points that bark could be compared with.");
    const std::vector<Vec3> some =
        cloud.size() > kMostPoints ? sample_points(cloud.positions, kMostPoints) : cloud.positions;
    const bool as_it_is = cloud.frame == tree.frame();
    std::vector<DVec3> points;
    points.reserve(some.size());
    for (const Vec3& p : some)
        points.push_back(as_it_is ? DVec3(p) : tree.frame().to_tree(cloud.frame.to_scan(DVec3(p))));
    return points;
}

double along_of(const Tree& tree, const GrowthBranch& branch, NodeId node) {
    const DVec3 place = tree.node(node).position;
    const AxisPlace* nearest = &branch.axis.front();
    for (const AxisPlace& at : branch.axis)
        if (glm::distance(at.position, place) < glm::distance(nearest->position, place)) nearest = &at;
    return nearest->along;
}

}  // namespace treerec::growth
