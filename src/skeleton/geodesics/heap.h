// The least of many numbers, again and again.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <utility>
#include <vector>

namespace treerec {

// A vertex by what it costs to reach, at least 0, as one number: the bits of positive floats are in the order
// of their values. Ties go to the smaller vertex.
inline uint64_t heap_entry(float cost, uint32_t vertex) {
    return (static_cast<uint64_t>(std::bit_cast<uint32_t>(cost)) << 32) | vertex;
}

// A heap with four children to a node, which is half as deep as std::priority_queue. Numbers that differ come
// out in one order only, whatever the heap.
class LeastFirst {
  public:
    LeastFirst() = default;
    explicit LeastFirst(std::vector<uint64_t> entries) : entries_(std::move(entries)) {
        for (size_t i = entries_.size() / kChildren + 1; i-- > 0;)
            if (i < entries_.size()) sink(i, entries_[i]);
    }

    bool empty() const { return entries_.empty(); }

    void push(uint64_t entry) {
        size_t at = entries_.size();
        entries_.push_back(entry);
        for (; at > 0; at = (at - 1) / kChildren) {
            const uint64_t above = entries_[(at - 1) / kChildren];
            if (above <= entry) break;
            entries_[at] = above;
        }
        entries_[at] = entry;
    }

    // Not empty.
    uint64_t pop() {
        const uint64_t least = entries_.front();
        const uint64_t last = entries_.back();
        entries_.pop_back();
        if (!entries_.empty()) sink(0, last);
        return least;
    }

  private:
    static constexpr size_t kChildren = 4;

    // Puts the entry at `at` or below.
    void sink(size_t at, uint64_t entry) {
        for (;;) {
            const size_t first = kChildren * at + 1;
            if (first >= entries_.size()) break;
            const size_t end = std::min(first + kChildren, entries_.size());
            size_t least = first;
            for (size_t child = first + 1; child < end; child++)
                least = entries_[child] < entries_[least] ? child : least;
            if (entries_[least] >= entry) break;
            entries_[at] = entries_[least];
            at = least;
        }
        entries_[at] = entry;
    }

    std::vector<uint64_t> entries_;
};

}  // namespace treerec
