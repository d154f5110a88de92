#include "fidelity/segment_tree.h"

#include <algorithm>
#include <array>
#include <limits>

namespace treerec {

namespace {

constexpr int32_t kLeafSize = 4;
constexpr size_t kStackSize = 64;  // median splits of 2^31 segments go 29 deep

double squared(double x) {
    return x * x;
}

// The squared distances from p to the nearest and to the farthest point of the box.
double nearest_squared(const Bounds& box, const DVec3& p) {
    const DVec3 d = glm::max(glm::max(box.min - p, p - box.max), DVec3(0.0));
    return glm::dot(d, d);
}

double farthest_squared(const Bounds& box, const DVec3& p) {
    const DVec3 d = glm::max(glm::abs(p - box.min), glm::abs(p - box.max));
    return glm::dot(d, d);
}

}  // namespace

std::vector<WoodSegment> wood_segments(const Tree& tree) {
    std::vector<WoodSegment> segments;
    segments.reserve(tree.size());
    for (NodeId id : tree.depth_first()) {
        const Node& node = tree.node(id);
        if (node.parent == kNoNode) continue;
        segments.push_back({tree.node(node.parent).position, node.position, node.radius, id});
    }
    return segments;
}

double distance_to_segment(const DVec3& p, const DVec3& from, const DVec3& to) {
    const DVec3 along = to - from;
    const double length2 = glm::dot(along, along);
    const double t = length2 > 0.0 ? std::clamp(glm::dot(p - from, along) / length2, 0.0, 1.0) : 0.0;
    return glm::length(p - from - t * along);
}

SegmentTree::SegmentTree(std::vector<WoodSegment> segments) : segments_(std::move(segments)) {
    if (segments_.empty()) return;
    cells_.reserve(segments_.size());
    build(0, static_cast<int32_t>(segments_.size()));
}

int32_t SegmentTree::build(int32_t begin, int32_t end) {
    const int32_t index = static_cast<int32_t>(cells_.size());
    Cell cell;
    cell.begin = begin;
    cell.end = end;
    cell.least_radius = std::numeric_limits<double>::max();
    Bounds middles;
    for (int32_t i = begin; i < end; i++) {
        const WoodSegment& segment = segments_[i];
        cell.box.add(segment.from);
        cell.box.add(segment.to);
        middles.add(0.5 * (segment.from + segment.to));
        cell.least_radius = std::min(cell.least_radius, segment.radius);
        cell.largest_radius = std::max(cell.largest_radius, segment.radius);
    }
    cells_.push_back(cell);
    if (end - begin <= kLeafSize) return index;
    const DVec3 size = middles.size();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const int32_t middle = begin + (end - begin) / 2;
    std::nth_element(segments_.begin() + begin, segments_.begin() + middle, segments_.begin() + end,
                     [axis](const WoodSegment& a, const WoodSegment& b) {
                         return a.from[axis] + a.to[axis] < b.from[axis] + b.to[axis];
                     });
    build(begin, middle);
    const int32_t right = build(middle, end);
    cells_[index].right = right;
    return index;
}

SegmentTree::Hit SegmentTree::nearest_axis(const DVec3& p, int32_t hint) const {
    Hit best{hint, std::numeric_limits<double>::max()};
    if (empty()) return {-1, 0.0};
    if (hint >= 0) best.distance = distance_to_segment(p, segments_[hint].from, segments_[hint].to);
    std::array<int32_t, kStackSize> stack;
    size_t depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
        const int32_t at = stack[--depth];
        const Cell& cell = cells_[at];
        if (nearest_squared(cell.box, p) >= squared(best.distance)) continue;
        if (cell.right < 0) {
            for (int32_t i = cell.begin; i < cell.end; i++) {
                const double distance = distance_to_segment(p, segments_[i].from, segments_[i].to);
                if (distance < best.distance) best = {i, distance};
            }
            continue;
        }
        const int32_t left = at + 1;
        const bool left_first =
            nearest_squared(cells_[left].box, p) <= nearest_squared(cells_[cell.right].box, p);
        stack[depth++] = left_first ? cell.right : left;
        stack[depth++] = left_first ? left : cell.right;
    }
    return best;
}

double SegmentTree::surface_distance(const DVec3& p, int32_t& hint) const {
    double best = std::numeric_limits<double>::max();
    if (empty()) return best;
    const auto error_of = [&](int32_t index) {
        const WoodSegment& segment = segments_[index];
        return std::abs(distance_to_segment(p, segment.from, segment.to) - segment.radius);
    };
    if (hint >= 0) best = error_of(hint);
    // Whether all wood of the cell has its bark farther from p than the best so far.
    const auto hopeless = [&](const Cell& cell, double nearest) {
        const double reach = best + cell.largest_radius;
        if (nearest >= reach * reach) return true;
        const double inner = cell.least_radius - best;
        return inner > 0.0 && farthest_squared(cell.box, p) <= inner * inner;
    };
    struct Waiting {
        int32_t cell;
        double nearest;  // squared
    };
    std::array<Waiting, kStackSize> stack;
    size_t depth = 0;
    stack[depth++] = {0, nearest_squared(cells_[0].box, p)};
    while (depth > 0) {
        const Waiting at = stack[--depth];
        const Cell& cell = cells_[at.cell];
        if (hopeless(cell, at.nearest)) continue;
        if (cell.right < 0) {
            for (int32_t i = cell.begin; i < cell.end; i++) {
                const double error = error_of(i);
                if (error >= best) continue;
                best = error;
                hint = i;
            }
            continue;
        }
        const Waiting left{at.cell + 1, nearest_squared(cells_[at.cell + 1].box, p)};
        const Waiting right{cell.right, nearest_squared(cells_[cell.right].box, p)};
        const bool left_first = left.nearest <= right.nearest;
        stack[depth++] = left_first ? right : left;
        stack[depth++] = left_first ? left : right;
    }
    return best;
}

}  // namespace treerec
