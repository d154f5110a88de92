#include "geometry/kd_tree.h"

#include <algorithm>

#include "geometry/parallel.h"

namespace treerec {

namespace {

// So much less than the longest side is as long.
constexpr float kAsLong = 0.00001f;
constexpr int kForks = 2;
constexpr size_t kWorthForking = 8192;  // points

// The nearest points so far, ascending; of equals the one that came first.
struct Nearest {
    uint32_t* index;
    float* squared;
    size_t wanted;
    size_t found = 0;

    float limit() const { return squared[wanted - 1]; }
    void add(float square, uint32_t candidate) {
        if (found == wanted && !(square < limit())) return;
        size_t at = found < wanted ? found++ : wanted - 1;
        for (; at > 0 && squared[at - 1] > square; at--) {
            squared[at] = squared[at - 1];
            index[at] = index[at - 1];
        }
        squared[at] = square;
        index[at] = candidate;
    }
};

struct Within {
    float most;
    std::vector<std::pair<uint32_t, float>>& found;

    float limit() const { return most; }
    void add(float square, uint32_t candidate) { found.emplace_back(candidate, square); }
};

}  // namespace

KdTree::KdTree(std::span<const Vec3> points, size_t leaf) {
    if (points.empty()) return;
    std::vector<Item> items(points.size());
    box_ = {points[0], points[0]};
    for (size_t i = 0; i < points.size(); i++) {
        items[i] = {points[i], static_cast<uint32_t>(i)};
        box_.low = glm::min(box_.low, points[i]);
        box_.high = glm::max(box_.high, points[i]);
    }
    nodes_.reserve(4 * points.size() / std::max<size_t>(leaf, 1) + 1);
    Box box = box_;
    build(items, 0, box, std::max<size_t>(leaf, 1), nodes_, kForks);
    index_.resize(points.size());
    for (std::vector<float>& along : at_)
        along.resize(points.size() + kLanes - 1);
    for (size_t i = 0; i < items.size(); i++) {
        index_[i] = items[i].index;
        for (int axis = 0; axis < 3; axis++)
            at_[static_cast<size_t>(axis)][i] = items[i].position[axis];
    }
}

// Appends to `nodes`. from: the first item's place among all. box: of what has been cut off for these items;
// becomes theirs. forks: so many times, large halves are built side by side.
void KdTree::build(std::span<Item> items, size_t from, Box& box, size_t leaf, std::vector<Node>& nodes,
                   int forks) {
    const size_t own = nodes.size();
    const size_t count = items.size();
    nodes.push_back({0.0f, 0.0f, static_cast<uint32_t>(from), static_cast<uint32_t>(from + count), kLeaf});
    if (count <= leaf) {
        box = {items[0].position, items[0].position};
        for (const Item& item : items) {
            box.low = glm::min(box.low, item.position);
            box.high = glm::max(box.high, item.position);
        }
        return;
    }
    const auto reach = [&](int axis) {
        float low = items[0].position[axis], high = low;
        for (const Item& item : items) {
            low = std::min(low, item.position[axis]);
            high = std::max(high, item.position[axis]);
        }
        return std::pair(low, high);
    };
    // Of the sides that are about as long as the longest, the one along which the points reach farthest.
    const Vec3 sides = box.high - box.low;
    const float long_side = (1 - kAsLong) * std::max({sides.x, sides.y, sides.z});
    int axis = 0;
    std::pair<float, float> ends(0.0f, -1.0f);
    for (int i = 0; i < 3; i++) {
        if (!(sides[i] > long_side)) continue;
        const std::pair<float, float> of_side = reach(i);
        if (!(of_side.second - of_side.first > ends.second - ends.first)) continue;
        axis = i;
        ends = of_side;
    }
    if (ends.second < ends.first) ends = reach(axis);
    const float cut = std::clamp((box.low[axis] + box.high[axis]) / 2, ends.first, ends.second);

    // What is below the cut, what is on it, and what is above. What is on it evens the halves out.
    const auto part = [&](size_t first, const auto& goes_left) {
        size_t left = first, right = count - 1;
        for (;;) {
            while (left <= right && goes_left(items[left].position[axis]))
                left++;
            while (right > 0 && left <= right && !goes_left(items[right].position[axis]))
                right--;
            if (left > right || right == 0) return left;
            std::swap(items[left++], items[right--]);
        }
    };
    const size_t below = part(0, [&](float value) { return value < cut; });
    const size_t not_above = part(below, [&](float value) { return value <= cut; });
    const size_t half = std::clamp(count / 2, below, std::max(below, not_above));

    Box left = box, right = box;
    left.high[axis] = cut;
    right.low[axis] = cut;
    if (forks > 0 && count >= kWorthForking) {
        std::array<std::vector<Node>, 2> halves;
        parallel_for(2, 1, [&](size_t i, size_t) {
            if (i == 0)
                build(items.first(half), from, left, leaf, halves[0], forks - 1);
            else
                build(items.subspan(half), from + half, right, leaf, halves[1], forks - 1);
        });
        for (const std::vector<Node>& made : halves) {
            const auto first = static_cast<uint32_t>(nodes.size());
            nodes[own].end = first;  // of the right half in the end
            for (Node node : made) {
                if (node.axis != kLeaf) node.end += first;
                nodes.push_back(node);
            }
        }
    } else {
        build(items.first(half), from, left, leaf, nodes, 0);
        nodes[own].end = static_cast<uint32_t>(nodes.size());
        build(items.subspan(half), from + half, right, leaf, nodes, 0);
    }
    nodes[own].low = left.high[axis];
    nodes[own].high = right.low[axis];
    nodes[own].axis = axis;
    box = {glm::min(left.low, right.low), glm::max(left.high, right.high)};
}

size_t KdTree::nearest(const Vec3& p, size_t count, uint32_t* index, float* squared) const {
    if (count == 0) return 0;
    squared[count - 1] = std::numeric_limits<float>::max();
    Nearest found{index, squared, count};
    search(p, found);
    return found.found;
}

void KdTree::within(const Vec3& p, float squared, std::vector<std::pair<uint32_t, float>>& found) const {
    found.clear();
    Within all{squared, found};
    search(p, all);
    std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
}

}  // namespace treerec
