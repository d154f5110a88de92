#include "geometry/point_tree.h"

#include <bit>

#include "geometry/morton.h"
#include "geometry/parallel.h"

namespace treerec {

namespace {

constexpr size_t kGrain = 4096;
constexpr size_t kGroupsPerTask = 64;

uint64_t entry_of(float squared, uint32_t index) {
    return static_cast<uint64_t>(std::bit_cast<uint32_t>(squared)) << 32 | index;
}

}  // namespace

class PointTree::Nearest {
  public:
    // None yet of `count`.
    void reset(size_t count) {
        count_ = count;
        size_ = 0;
        limit_ = kFarthest;
    }
    size_t size() const { return size_; }
    float limit() const { return limit_; }
    void add(float squared, uint32_t index) {
        const uint64_t entry = entry_of(squared, index);
        if (size_ < count_)
            size_++;
        else if (entry >= entries_[count_ - 1])
            return;
        size_t at = size_ - 1;
        for (; at > 0 && entries_[at - 1] > entry; at--)
            entries_[at] = entries_[at - 1];
        entries_[at] = entry;
        if (size_ == count_) limit_ = this->squared(count_ - 1);
    }
    uint32_t index(size_t i) const { return static_cast<uint32_t>(entries_[i]); }
    float squared(size_t i) const { return std::bit_cast<float>(static_cast<uint32_t>(entries_[i] >> 32)); }

  private:
    std::array<uint64_t, kMostNearest + 1> entries_;
    size_t count_ = 0;  // wanted
    size_t size_ = 0;   // found
    float limit_ = kFarthest;
};

class PointTree::Builder {
  public:
    Builder(PointTree& tree, std::span<const Vec3> points, const Progress* progress)
        : tree_(tree), points_(points), progress_(progress), items_(points.size()) {
        for (size_t i = 0; i < points.size(); i++)
            items_[i].index = static_cast<uint32_t>(i);
        sort_morton(points, items_, progress);
        const size_t guess = points.size() / (kMost / 2) + 1;
        tree_.groups_.reserve(guess);
        tree_.blocks_.reserve(guess / (kWide / 2) + 1);
        add_block(0, points.size());
        // The number of groups is known now.
        for (Block& block : tree_.blocks_)
            for (uint32_t& node : block.node)
                if (node & kIsBlock) node = (node & ~kIsBlock) + static_cast<uint32_t>(tree_.groups_.size());
    }

  private:
    static constexpr uint32_t kIsBlock = uint32_t{1} << 31;
    static constexpr float kNowhere = std::numeric_limits<float>::infinity();

    struct Range {
        size_t begin;
        size_t end;
        size_t size() const { return end - begin; }
    };

    // Where the key's highest bit that differs changes. Of equal keys, finer ones are made first; equal
    // points are halved.
    size_t cut(const Range& range) {
        if (items_[range.begin].key == items_[range.end - 1].key) {
            const auto begin = items_.begin() + static_cast<ptrdiff_t>(range.begin);
            std::vector<KeyedIndex> cell(begin, items_.begin() + static_cast<ptrdiff_t>(range.end));
            sort_morton(points_, cell, progress_);
            std::copy(cell.begin(), cell.end(), begin);
        }
        const uint64_t differing = items_[range.begin].key ^ items_[range.end - 1].key;
        if (differing == 0) return range.begin + range.size() / 2;
        const uint64_t bit = std::bit_floor(differing);
        return static_cast<size_t>(
            std::partition_point(items_.begin() + static_cast<ptrdiff_t>(range.begin),
                                 items_.begin() + static_cast<ptrdiff_t>(range.end),
                                 [&](const KeyedIndex& item) { return (item.key & bit) == 0; }) -
            items_.begin());
    }

    Box add_block(size_t begin, size_t end) {
        // The largest is cut in two until there are eight, or all are small.
        std::array<Range, kWide> parts;
        parts[0] = {begin, end};
        size_t count = 1;
        while (count < kWide) {
            const auto largest =
                std::max_element(parts.begin(), parts.begin() + static_cast<ptrdiff_t>(count),
                                 [](const Range& a, const Range& b) { return a.size() < b.size(); });
            if (largest->size() <= kMost) break;
            const size_t middle = cut(*largest);
            std::move_backward(largest + 1, parts.begin() + static_cast<ptrdiff_t>(count),
                               parts.begin() + static_cast<ptrdiff_t>(count) + 1);
            largest[1] = {middle, largest->end};
            largest->end = middle;
            count++;
        }
        Block block;
        block.count = static_cast<uint32_t>(count);
        Box whole;
        for (size_t i = 0; i < kWide; i++) {
            Box box;
            block.node[i] = 0;
            if (i < count) {
                const bool small = parts[i].size() <= kMost;
                box = small ? add_group(parts[i]) : add_block(parts[i].begin, parts[i].end);
                block.node[i] = static_cast<uint32_t>(small ? tree_.groups_.size() - 1
                                                            : (tree_.blocks_.size() - 1) | kIsBlock);
            }
            block.low_x[i] = box.low.x;
            block.low_y[i] = box.low.y;
            block.low_z[i] = box.low.z;
            block.high_x[i] = box.high.x;
            block.high_y[i] = box.high.y;
            block.high_z[i] = box.high.z;
            whole.low = glm::min(whole.low, box.low);
            whole.high = glm::max(whole.high, box.high);
        }
        tree_.blocks_.push_back(block);
        return whole;
    }

    Box add_group(const Range& range) {
        if (progress_ && tree_.groups_.size() % kGrain == 0) progress_->check();
        Group& group = tree_.groups_.emplace_back();
        group.count = static_cast<uint32_t>(range.size());
        Box& box = group.box;
        for (size_t i = 0; i < kMost; i++) {
            const bool there = i < range.size();
            const Vec3 p = there ? points_[items_[range.begin + i].index] : Vec3(kNowhere);
            group.index[i] = there ? items_[range.begin + i].index : UINT32_MAX;
            group.x[i] = p.x;
            group.y[i] = p.y;
            group.z[i] = p.z;
            if (!there) continue;
            box.low = glm::min(box.low, p);
            box.high = glm::max(box.high, p);
        }
        return box;
    }

    PointTree& tree_;
    std::span<const Vec3> points_;
    const Progress* progress_;
    std::vector<KeyedIndex> items_;
};

PointTree::PointTree(std::span<const Vec3> points, const Progress* progress) : count_(points.size()) {
    if (count_ > 0) Builder(*this, points, progress);
}

size_t PointTree::nearest(const Vec3& p, size_t count, uint32_t* index, float* squared) const {
    count = std::min(count, count_);
    if (count == 0) return 0;
    Nearest nearest;
    nearest.reset(count);
    search(p, nearest);
    for (size_t i = 0; i < nearest.size(); i++) {
        index[i] = nearest.index(i);
        squared[i] = nearest.squared(i);
    }
    return nearest.size();
}

std::vector<uint32_t> PointTree::nearest_of_all(size_t count, const Progress& progress) const {
    std::vector<uint32_t> all(count_ * count);
    parallel_for(groups_.size(), kGroupsPerTask, [&](size_t begin, size_t end) {
        progress.check();
        std::vector<Nearest> nearest(kMost);
        for (size_t g = begin; g < end; g++) {
            nearest_of_group(g, count + 1, nearest);
            const std::span<const uint32_t> own = in_group(g);
            for (size_t i = 0; i < own.size(); i++) {
                uint32_t* to = &all[own[i] * count];
                const uint32_t* last = to + count;
                for (size_t n = 0; n < nearest[i].size() && to != last; n++)
                    if (nearest[i].index(n) != own[i]) *to++ = nearest[i].index(n);
            }
        }
    });
    return all;
}

// The points of a group have much the same neighbours: one walk through the tree does for all.
void PointTree::nearest_of_group(size_t group, size_t count, std::vector<Nearest>& nearest) const {
    const Group& own = groups_[group];
    const size_t members = own.count;
    for (size_t i = 0; i < members; i++)
        nearest[i].reset(count);
    const auto look_at = [&](const Group& other) {
        const Many to_box = own.distances_to(other.box);
        float farthest = 0.0F;
        for (size_t i = 0; i < members; i++) {
            const float limit = nearest[i].limit();
            if (to_box[i] <= limit) {
                const Many squared = other.distances({own.x[i], own.y[i], own.z[i]});
                // Those nearer first, without a branch that is hard to foretell.
                std::array<uint32_t, kMost> nearer;
                size_t found = 0;
                for (uint32_t k = 0; k < kMost; k++) {
                    nearer[found] = k;
                    found += squared[k] <= limit ? 1 : 0;
                }
                for (size_t k = 0; k < found; k++)
                    nearest[i].add(squared[nearer[k]], other.index[nearer[k]]);
            }
            farthest = std::max(farthest, nearest[i].limit());
        }
        return farthest;
    };
    // Those beside it in the order are near, and tell how far to look.
    float limit = look_at(own);
    const size_t first = group > 0 ? group - 1 : 0;
    const size_t end = std::min(group + 2, groups_.size());
    for (size_t g = first; g < end; g++)
        if (g != group) limit = look_at(groups_[g]);
    Stack stack;
    size_t depth = 0;
    stack[depth++] = {0.0F, static_cast<uint32_t>(node_count() - 1)};
    while (depth > 0) {
        const Waiting at = stack[--depth];
        if (at.nearest > limit) continue;
        if (at.node >= groups_.size()) {
            const Block& block = blocks_[at.node - groups_.size()];
            push(block, block.distances(own.box), limit, stack, depth);
        } else if (at.node < first || at.node >= end) {
            limit = look_at(groups_[at.node]);
        }
    }
}

std::vector<uint32_t> names_of_nodes(const PointTree& tree, const std::vector<uint32_t>& names) {
    std::vector<uint32_t> of_nodes(tree.node_count());
    for (size_t node = 0; node < tree.node_count(); node++) {
        const bool group = node < tree.group_count();
        const std::span<const uint32_t> members = group ? tree.in_group(node) : tree.in_block(node);
        const std::vector<uint32_t>& of = group ? names : of_nodes;
        const uint32_t name = of[members.front()];
        const bool all =
            std::all_of(members.begin(), members.end(), [&](uint32_t m) { return of[m] == name; });
        of_nodes[node] = all ? name : kSeveral;
    }
    return of_nodes;
}

}  // namespace treerec
