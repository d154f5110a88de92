// Sorting by an integer key, in linear time and on several threads.
#pragma once

#include <cstdint>
#include <vector>

#include "progress.h"

namespace treerec {

struct KeyedIndex {
    uint64_t key;
    uint32_t index;
};

// Sorts by key, ascending. Stable, so that the result does not depend on the number of threads. Costs one
// pass per eleven bits in which the keys differ, and a second array of the same size. Throws Cancelled.
void radix_sort(std::vector<KeyedIndex>& items, const Progress* progress = nullptr);

}  // namespace treerec
