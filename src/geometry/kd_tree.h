// A k-d tree over points: who is nearest to a place.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <utility>
#include <vector>
#ifdef __SSE2__
#include <emmintrin.h>
#endif

#include "geometry/vec.h"

namespace treerec {

// Splits in the middle of the longest side, as Maneewongvatana and Mount's sliding midpoint (1999) does. A
// search looks at the leaves in the order of the way down, the nearer side first, so that of points at one
// distance the same is found again and again. Keeps copies of the points. Distances are squared.
class KdTree {
  public:
    // points: finite. leaf: so many points, at most, are not split any further.
    explicit KdTree(std::span<const Vec3> points, size_t leaf = 16);

    // Fills index and squared, which have room for `count`, with the nearest points, ascending; how many
    // there are.
    size_t nearest(const Vec3& p, size_t count, uint32_t* index, float* squared) const;

    // All points nearer than a squared distance, ascending.
    void within(const Vec3& p, float squared, std::vector<std::pair<uint32_t, float>>& found) const;

    // Calls found.add(squared, index) for points nearer than found.limit() (squared) was when their leaf was
    // come to. add() may lower the limit.
    template <typename Found>
    void search(const Vec3& p, Found& found) const;

  private:
    struct Node {
        float low, high;      // where the left half ends and the right one begins, along the axis
        uint32_t begin, end;  // a leaf's points; of others, `end` is the right child, the left one is next
        int32_t axis;         // kLeaf for a leaf
    };
    struct Box {
        Vec3 low, high;
    };
    struct Item {
        Vec3 position;
        uint32_t index;
    };
    static constexpr int32_t kLeaf = -1;

    static void build(std::span<Item> items, size_t from, Box& box, size_t leaf, std::vector<Node>& nodes,
                      int forks);
    template <typename Found>
    void visit(uint32_t at, const Vec3& p, float least, std::array<float, 3> aside, Found& found) const;
    template <typename Found>
    void look(const Node& node, const Vec3& p, Found& found) const;

    static constexpr size_t kLanes = 4;  // points looked at together

    Box box_{};
    std::vector<Node> nodes_;
    std::array<std::vector<float>, 3>
        at_;  // in the order of the leaves, and kLanes - 1 more to read over the end
    std::vector<uint32_t> index_;
};

template <typename Found>
void KdTree::search(const Vec3& p, Found& found) const {
    if (nodes_.empty()) return;
    std::array<float, 3> aside{};
    float least = 0.0f;
    for (int i = 0; i < 3; i++) {
        const float off = p[i] < box_.low[i]    ? p[i] - box_.low[i]
                          : p[i] > box_.high[i] ? p[i] - box_.high[i]
                                                : 0.0f;
        aside[static_cast<size_t>(i)] = off * off;
        least += off * off;
    }
    visit(0, p, least, aside, found);
}

template <typename Found>
void KdTree::visit(uint32_t at, const Vec3& p, float least, std::array<float, 3> aside, Found& found) const {
    for (;;) {
        const Node& node = nodes_[at];
        if (node.axis == kLeaf) return look(node, p, found);
        const float value = p[node.axis];
        const float over_low = value - node.low;
        const float over_high = value - node.high;
        const bool left = over_low + over_high < 0.0f;
        const float off = left ? over_high : over_low;
        visit(left ? at + 1 : node.end, p, least, aside, found);
        // The other side is as far away as its wall, and as the box is in the other directions.
        float& of_axis = aside[static_cast<size_t>(node.axis)];
        least = least + off * off - of_axis;
        of_axis = off * off;
        if (!(least <= found.limit())) return;
        at = left ? node.end : at + 1;
    }
}

template <typename Found>
void KdTree::look(const Node& node, const Vec3& p, Found& found) const {
    const float limit = found.limit();
#ifdef __SSE2__
    const __m128 x = _mm_set1_ps(p.x), y = _mm_set1_ps(p.y), z = _mm_set1_ps(p.z);
    const __m128 most = _mm_set1_ps(limit);
    for (uint32_t i = node.begin; i < node.end; i += kLanes) {
        const __m128 dx = _mm_sub_ps(x, _mm_loadu_ps(&at_[0][i]));
        const __m128 dy = _mm_sub_ps(y, _mm_loadu_ps(&at_[1][i]));
        const __m128 dz = _mm_sub_ps(z, _mm_loadu_ps(&at_[2][i]));
        const __m128 square =
            _mm_add_ps(_mm_add_ps(_mm_mul_ps(dx, dx), _mm_mul_ps(dy, dy)), _mm_mul_ps(dz, dz));
        int near = _mm_movemask_ps(_mm_cmplt_ps(square, most));
        if (near == 0) continue;
        alignas(16) std::array<float, kLanes> squares;
        _mm_store_ps(squares.data(), square);
        for (uint32_t k = 0; near != 0 && i + k < node.end; k++, near >>= 1)
            if ((near & 1) != 0) found.add(squares[k], index_[i + k]);
    }
#else
    for (uint32_t i = node.begin; i < node.end; i++) {
        const float dx = p.x - at_[0][i], dy = p.y - at_[1][i], dz = p.z - at_[2][i];
        const float square = dx * dx + dy * dy + dz * dz;
        if (square < limit) found.add(square, index_[i]);
    }
#endif
}

}  // namespace treerec
