// Who is nearest to a place, and to every point at once.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "geometry/vec.h"
#include "progress.h"

namespace treerec {

// Points in Morton order, cut where their cells end into groups of at most sixteen, with boxes around the
// groups, boxes around eight boxes each, and so on (Lauterbach et al. 2009, but eight wide): built by a radix
// sort, and many distances are found at a time. Distances are squared, as floats; what is found depends on
// them and the indices of points alone, whatever the tree. Points so far apart that this overflows do not see
// each other. Keeps copies of the points.
class PointTree {
  public:
    static constexpr size_t kMostNearest = 64;

    // points: finite. Throws Cancelled.
    explicit PointTree(std::span<const Vec3> points, const Progress* progress = nullptr);

    size_t size() const { return count_; }

    // Fills index and squared, which have room for `count` (at most kMostNearest + 1), with the nearest
    // points, ascending, of equals the one with the smaller index first; how many there are.
    size_t nearest(const Vec3& p, size_t count, uint32_t* index, float* squared) const;

    // For every point the `count` nearest others (fewer than there are points, at most kMostNearest), in the
    // same order; those of point 0 first; 0 where there are fewer in sight. Throws Cancelled.
    std::vector<uint32_t> nearest_of_all(size_t count, const Progress& progress) const;

    // Calls found.add(squared, index) for points no farther than found.limit() (squared) was when their group
    // was come to. add() may lower the limit.
    template <typename Found>
    void search(const Vec3& p, Found& found) const {
        search(p, found, [](uint32_t) { return true; });
    }

    // The same but for the groups and blocks, by node, of which enters(node) is false. found.limit() is asked
    // after it.
    template <typename Found, typename Enters>
    void search(const Vec3& p, Found& found, const Enters& enters) const;

    // Nodes are numbered, children before parents: the groups of points, then the blocks.
    size_t group_count() const { return groups_.size(); }
    size_t node_count() const { return groups_.size() + blocks_.size(); }
    // The points of a group (indices), or the nodes of a block.
    std::span<const uint32_t> in_group(size_t group) const {
        return std::span(groups_[group].index).first(groups_[group].count);
    }
    std::span<const uint32_t> in_block(size_t node) const {
        const Block& block = blocks_[node - groups_.size()];
        return std::span(block.node).first(block.count);
    }

  private:
    static constexpr size_t kWide = 8;   // boxes in a block
    static constexpr size_t kMost = 16;  // points in a group
    static constexpr float kFarthest = std::numeric_limits<float>::max();
    using Eight = std::array<float, kWide>;
    using Many = std::array<float, kMost>;

    struct Box {
        Vec3 low{std::numeric_limits<float>::infinity()};
        Vec3 high{-std::numeric_limits<float>::infinity()};
    };

    // The one that is above 0; without a branch, which would keep the loop from being vectorised.
    static float outside(float below, float above) {
        return 0.5F * ((below + std::abs(below)) + (above + std::abs(above)));
    }

    // Points; where there are fewer than sixteen, infinitely far ones.
    struct Group {
        Many x, y, z;
        std::array<uint32_t, kMost> index;
        uint32_t count;
        Box box;

        Many distances(const Vec3& p) const {
            Many squared;
            for (size_t i = 0; i < kMost; i++) {
                const float dx = p.x - x[i], dy = p.y - y[i], dz = p.z - z[i];
                squared[i] = dx * dx + dy * dy + dz * dz;
            }
            return squared;
        }

        // Of the points to another box. Never more than distances() of the points in it: rounding keeps the
        // order of differences, squares and sums.
        Many distances_to(const Box& other) const {
            Many squared;
            for (size_t i = 0; i < kMost; i++) {
                const float dx = outside(other.low.x - x[i], x[i] - other.high.x);
                const float dy = outside(other.low.y - y[i], y[i] - other.high.y);
                const float dz = outside(other.low.z - z[i], z[i] - other.high.z);
                squared[i] = dx * dx + dy * dy + dz * dz;
            }
            return squared;
        }
    };

    // The boxes of eight nodes; where there are fewer, infinitely far ones.
    struct Block {
        Eight low_x, low_y, low_z, high_x, high_y, high_z;
        std::array<uint32_t, kWide> node;
        uint32_t count;

        // To the nearest points of the boxes, likewise.
        Eight distances(const Box& box) const {
            Eight squared;
            for (size_t i = 0; i < kWide; i++) {
                const float x = outside(low_x[i] - box.high.x, box.low.x - high_x[i]);
                const float y = outside(low_y[i] - box.high.y, box.low.y - high_y[i]);
                const float z = outside(low_z[i] - box.high.z, box.low.z - high_z[i]);
                squared[i] = x * x + y * y + z * z;
            }
            return squared;
        }
    };

    // A node on the way, and how near it is.
    struct Waiting {
        float nearest;
        uint32_t node;
    };
    // At most one waits for every bit of a key that is cut at on the way down: 33 of each of the 25 keys,
    // ever finer by 2047, that part all floats there are, and 32 for equal points.
    using Stack = std::array<Waiting, 1024>;

    // The nearest so far, ascending; each a distance's bits, which have its order, before an index.
    class Nearest;
    void nearest_of_group(size_t group, size_t count, std::vector<Nearest>& nearest) const;

    // Puts the nodes of a block that are no farther than the limit on the stack, the nearest last.
    static void push(const Block& block, const Eight& squared, float limit, Stack& stack, size_t& depth) {
        const size_t bottom = depth;
        for (size_t i = 0; i < kWide; i++) {
            if (!(squared[i] <= limit)) continue;
            size_t at = depth++;
            for (; at > bottom && stack[at - 1].nearest < squared[i]; at--)
                stack[at] = stack[at - 1];
            stack[at] = {squared[i], block.node[i]};
        }
    }

    class Builder;

    size_t count_;
    std::vector<Group> groups_;
    std::vector<Block> blocks_;  // the root is the last
};

template <typename Found, typename Enters>
void PointTree::search(const Vec3& p, Found& found, const Enters& enters) const {
    if (count_ == 0) return;
    Stack stack;
    size_t depth = 0;
    stack[depth++] = {0.0F, static_cast<uint32_t>(node_count() - 1)};
    while (depth > 0) {
        const Waiting at = stack[--depth];
        if (!enters(at.node)) continue;
        const float limit = std::min(found.limit(), kFarthest);
        if (at.nearest > limit) continue;
        if (at.node >= groups_.size()) {
            const Block& block = blocks_[at.node - groups_.size()];
            push(block, block.distances({p, p}), limit, stack, depth);
            continue;
        }
        const Group& group = groups_[at.node];
        const Many squared = group.distances(p);
        for (size_t i = 0; i < kMost; i++)
            if (squared[i] <= limit) found.add(squared[i], group.index[i]);
    }
}

// By node of a tree: the name that all its points have, or kSeveral. A node whose points all have one's own
// name is passed over by who looks for others. names: by point.
inline constexpr uint32_t kSeveral = std::numeric_limits<uint32_t>::max();
std::vector<uint32_t> names_of_nodes(const PointTree& tree, const std::vector<uint32_t>& names);

}  // namespace treerec
