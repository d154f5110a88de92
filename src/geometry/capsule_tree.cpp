#include "geometry/capsule_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace treerec {

namespace {

constexpr int32_t kLeafSize = 4;
constexpr double kSlack = 1e-9;    // metres: what rounding may part in a bound
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

double distance_to_segment(const DVec3& p, const DVec3& from, const DVec3& to) {
    const DVec3 along = to - from;
    const double length2 = glm::dot(along, along);
    const double t = length2 > 0.0 ? std::clamp(glm::dot(p - from, along) / length2, 0.0, 1.0) : 0.0;
    return glm::length(p - from - t * along);
}

double bark_error(const WoodSegment& segment, const DVec3& p) {
    return distance_to_segment(p, segment.from, segment.to) - segment.radius;
}

bool solid_holds(const WoodSegment& segment, const DVec3& p, double tolerance) {
    const DVec3 d = p - segment.from;
    const double square = glm::dot(d, d);
    const double near = segment.from_radius + tolerance, far = segment.radius + tolerance;
    if (square <= near * near) return true;
    const DVec3 e = p - segment.to;
    if (glm::dot(e, e) <= far * far) return true;
    const DVec3 along = segment.to - segment.from;
    const double length2 = glm::dot(along, along);
    if (!(length2 > 0.0)) return false;
    // In the plane through the axis and p: x along the axis, y away from it.
    const double length = std::sqrt(length2);
    const double x = glm::dot(d, along) / length;
    const double y = std::sqrt(std::max(0.0, square - x * x));
    const double taper = segment.radius - segment.from_radius;
    if (x >= 0.0 && x <= length && y <= segment.from_radius + taper * x / length) return true;
    // The frustum's flat ends lie in the balls: only its side is left.
    const double t =
        std::clamp((x * length + (y - segment.from_radius) * taper) / (length2 + taper * taper), 0.0, 1.0);
    const double dx = x - t * length, dy = y - segment.from_radius - t * taper;
    return dx * dx + dy * dy <= tolerance * tolerance;
}

CapsuleTree::CapsuleTree(std::vector<WoodSegment> segments) : segments_(std::move(segments)) {
    if (segments_.empty()) return;
    cells_.reserve(segments_.size());
    std::vector<Key> keys(segments_.size());
    for (size_t i = 0; i < keys.size(); i++)
        keys[i].segment = static_cast<int32_t>(i);
    build(0, static_cast<int32_t>(segments_.size()), keys);
    std::vector<WoodSegment> sorted;
    sorted.reserve(segments_.size());
    for (const Key& key : keys)
        sorted.push_back(segments_[static_cast<size_t>(key.segment)]);
    segments_ = std::move(sorted);
}

// Sorts the keys: they are lighter to move than the segments.
int32_t CapsuleTree::build(int32_t begin, int32_t end, std::vector<Key>& keys) {
    const int32_t index = static_cast<int32_t>(cells_.size());
    Cell cell;
    cell.begin = begin;
    cell.end = end;
    cell.least_radius = std::numeric_limits<double>::max();
    Bounds middles;
    for (int32_t i = begin; i < end; i++) {
        const WoodSegment& segment = segments_[keys[i].segment];
        cell.box.add(segment.from);
        cell.box.add(segment.to);
        middles.add(0.5 * (segment.from + segment.to));
        cell.least_radius = std::min(cell.least_radius, segment.radius);
        cell.largest_radius = std::max(cell.largest_radius, segment.radius);
        cell.largest_end = std::max({cell.largest_end, segment.radius, segment.from_radius});
    }
    cells_.push_back(cell);
    if (end - begin <= kLeafSize) return index;
    const DVec3 size = middles.size();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const int32_t middle = begin + (end - begin) / 2;
    for (int32_t i = begin; i < end; i++) {
        const WoodSegment& segment = segments_[keys[i].segment];
        keys[i].along = segment.from[axis] + segment.to[axis];
    }
    std::nth_element(keys.begin() + begin, keys.begin() + middle, keys.begin() + end,
                     [](const Key& a, const Key& b) { return a.along < b.along; });
    build(begin, middle, keys);
    const int32_t right = build(middle, end, keys);
    cells_[index].right = right;
    return index;
}

CapsuleTree::Hit CapsuleTree::nearest_axis(const DVec3& p, int32_t hint) const {
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

double CapsuleTree::surface_distance(const DVec3& p, int32_t& hint) const {
    if (empty()) return std::numeric_limits<double>::max();
    BarkHit best;
    if (hint >= 0) best = {segments_[hint].child, bark_error(segments_[hint], p), hint};
    find_bark(p, best);
    hint = best.segment;
    return std::abs(best.error);
}

void CapsuleTree::find_bark(const DVec3& p, BarkHit& best) const {
    if (empty()) return;
    double least = std::abs(best.error);
    // Whether all wood of the cell has its bark farther from p than the best so far.
    const auto hopeless = [&](const Cell& cell, double nearest) {
        const double reach = least + cell.largest_radius + kSlack;
        if (nearest > reach * reach) return true;
        const double inner = cell.least_radius - least - kSlack;
        return inner > 0.0 && farthest_squared(cell.box, p) < inner * inner;
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
                const double error = bark_error(segments_[i], p);
                const double size = std::abs(error);
                if (size > least || (size == least && segments_[i].child >= best.child)) continue;
                least = size;
                best = {segments_[i].child, error, i};
            }
            continue;
        }
        const Waiting left{at.cell + 1, nearest_squared(cells_[at.cell + 1].box, p)};
        const Waiting right{cell.right, nearest_squared(cells_[cell.right].box, p)};
        const bool left_first = left.nearest <= right.nearest;
        stack[depth++] = left_first ? right : left;
        stack[depth++] = left_first ? left : right;
    }
}

int32_t CapsuleTree::find_solid(const DVec3& p, double tolerance, int32_t hint) const {
    if (empty()) return -1;
    if (hint >= 0 && solid_holds(segments_[hint], p, tolerance)) return hint;
    std::array<int32_t, kStackSize> stack;
    size_t depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
        const int32_t at = stack[--depth];
        const Cell& cell = cells_[at];
        if (nearest_squared(cell.box, p) > squared(cell.largest_end + tolerance + kSlack)) continue;
        if (cell.right >= 0) {
            stack[depth++] = cell.right;
            stack[depth++] = at + 1;
            continue;
        }
        for (int32_t i = cell.begin; i < cell.end; i++)
            if (solid_holds(segments_[i], p, tolerance)) return i;
    }
    return -1;
}

}  // namespace treerec
