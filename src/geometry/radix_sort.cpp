#include "geometry/radix_sort.h"

#include <algorithm>
#include <array>
#include <bit>

#include "geometry/parallel.h"

namespace treerec {

namespace {

constexpr int kDigitBits = 11;
constexpr size_t kBuckets = size_t{1} << kDigitBits;
constexpr size_t kBlock = size_t{1} << 17;  // items between two looks at the progress
constexpr size_t kFewest = 64;              // below which a comparison sort is quicker

using Histogram = std::array<uint32_t, kBuckets>;

// The lowest bits of the windows that together cover every bit in which the keys differ.
std::vector<int> digit_shifts(uint64_t differing) {
    std::vector<int> shifts;
    while (differing != 0) {
        const int shift = std::countr_zero(differing);
        shifts.push_back(shift);
        const int next = shift + kDigitBits;
        differing = next >= 64 ? 0 : differing >> next << next;
    }
    return shifts;
}

uint64_t differing_bits(const std::vector<KeyedIndex>& items) {
    const uint64_t first = items.front().key;
    uint64_t differing = 0;
    for (const KeyedIndex& item : items)
        differing |= item.key ^ first;
    return differing;
}

}  // namespace

void radix_sort(std::vector<KeyedIndex>& items, const Progress* progress) {
    if (items.size() < kFewest) {
        std::stable_sort(items.begin(), items.end(),
                         [](const KeyedIndex& a, const KeyedIndex& b) { return a.key < b.key; });
        return;
    }
    const std::vector<int> shifts = digit_shifts(differing_bits(items));
    if (shifts.empty()) return;
    std::vector<KeyedIndex> other(items.size());
    const size_t parts =
        std::clamp<size_t>(items.size() / kBlock, 1, static_cast<size_t>(std::min(thread_count(), 64)));
    const size_t part = (items.size() + parts - 1) / parts;
    std::vector<Histogram> histograms(parts);
    auto in_blocks = [&](size_t begin, size_t end, const auto& body) {
        for (size_t block = begin; block < end; block += kBlock) {
            if (progress) progress->check();
            for (size_t i = block; i < std::min(end, block + kBlock); i++)
                body(i);
        }
    };
    for (const int shift : shifts) {
        auto digit = [shift](const KeyedIndex& item) { return item.key >> shift & (kBuckets - 1); };
        parallel_for(items.size(), part, [&](size_t begin, size_t end) {
            Histogram& histogram = histograms[begin / part];
            histogram.fill(0);
            in_blocks(begin, end, [&](size_t i) { histogram[digit(items[i])]++; });
        });
        uint32_t sum = 0;
        for (size_t bucket = 0; bucket < kBuckets; bucket++)
            for (Histogram& histogram : histograms) {
                const uint32_t count = histogram[bucket];
                histogram[bucket] = sum;
                sum += count;
            }
        parallel_for(items.size(), part, [&](size_t begin, size_t end) {
            Histogram& place = histograms[begin / part];
            in_blocks(begin, end, [&](size_t i) { other[place[digit(items[i])]++] = items[i]; });
        });
        items.swap(other);
    }
}

}  // namespace treerec
