#include "geometry/cell_grid.h"

#include <algorithm>

#include "geometry/parallel.h"
#include "geometry/radix_sort.h"
#include "geometry/random.h"

namespace treerec {

namespace {

constexpr size_t kBlock = size_t{1} << 17;  // points between two looks at the progress

constexpr size_t kSome = size_t{1} << 13;  // points looked at by one thread

// An open table; keys are never 0. Which slot a key gets does not change how many there are.
class CellCounter {
  public:
    // most: cells, more are not counted.
    explicit CellCounter(size_t most) : most_(most) { grow(size_t{1} << 12); }

    size_t count() const { return count_; }

    // Whether there are no more than `most` yet.
    bool add(uint64_t key) {
        uint64_t& slot = slot_of(key, hash_seed(0, key));
        if (slot == key) return true;
        if (count_ >= most_) return false;
        slot = key;
        if (++count_ * 2 > table_.size()) grow(4 * table_.size());
        return true;
    }

  private:
    uint64_t& slot_of(uint64_t key, uint64_t hash) {
        const size_t mask = table_.size() - 1;
        size_t slot = hash & mask;
        while (table_[slot] != 0 && table_[slot] != key)
            slot = (slot + 1) & mask;
        return table_[slot];
    }

    void grow(size_t size) {
        std::vector<uint64_t> old(size);
        old.swap(table_);
        for (const uint64_t key : old)
            if (key != 0) slot_of(key, hash_seed(0, key)) = key;
    }

    size_t most_;
    size_t count_ = 0;
    std::vector<uint64_t> table_;
};

}  // namespace

CellGrid::CellGrid(std::span<const Vec3> points, const CellLayout& layout_, const Progress* progress)
    : layout(layout_) {
    std::vector<KeyedIndex> items(points.size());
    parallel_for(points.size(), kBlock, [&](size_t from, size_t to) {
        if (progress) progress->check();
        for (size_t i = from; i < to; i++)
            items[i] = {layout.key(points[i]), static_cast<uint32_t>(i)};
    });
    radix_sort(items, progress);
    order.resize(items.size());
    for (size_t block = 0; block < items.size(); block += kBlock) {
        if (progress) progress->check();
        for (size_t i = block; i < std::min(items.size(), block + kBlock); i++) {
            order[i] = items[i].index;
            if (keys.empty() || keys.back() != items[i].key) {
                keys.push_back(items[i].key);
                begin.push_back(static_cast<uint32_t>(i));
            }
        }
    }
    begin.push_back(static_cast<uint32_t>(items.size()));
}

std::pair<size_t, size_t> CellGrid::cells_between(uint64_t low, uint64_t high) const {
    const auto first = std::lower_bound(keys.begin(), keys.end(), low);
    auto last = first;
    // Runs are short, and a second search would not be.
    while (last != keys.end() && *last <= high)
        ++last;
    return {static_cast<size_t>(first - keys.begin()), static_cast<size_t>(last - keys.begin())};
}

size_t count_cells(std::span<const Vec3> points, const CellLayout& layout, size_t most,
                   const Progress* progress) {
    most = std::min(most, points.size());
    CellCounter counter(most);
    for (size_t block = 0; block < points.size(); block += kBlock) {
        if (progress) progress->check();
        for (const Vec3& p : points.subspan(block, std::min(kBlock, points.size() - block)))
            if (!counter.add(layout.key(p))) return most + 1;
    }
    return counter.count();
}

size_t guess_cells(std::span<const Vec3> points, const CellLayout& layout, const Progress* progress) {
    constexpr int kSharedBits = 4;
    // Cells whose hash begins with so many zeros; most points are in others, which takes all threads to see.
    std::vector<std::vector<uint64_t>> some((points.size() + kSome - 1) / kSome);
    parallel_for(points.size(), kSome, [&](size_t begin, size_t end) {
        if (progress) progress->check();
        std::vector<uint64_t>& keys = some[begin / kSome];
        for (size_t i = begin; i < end; i++) {
            const uint64_t key = layout.key(points[i]);
            if (hash_seed(0, key) >> (64 - kSharedBits) == 0) keys.push_back(key);
        }
    });
    CellCounter counter(points.size());
    for (const std::vector<uint64_t>& keys : some)
        for (const uint64_t key : keys)
            counter.add(key);
    return counter.count() << kSharedBits;
}

}  // namespace treerec
