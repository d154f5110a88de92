#include "growth/box_grid.h"

#include <algorithm>

namespace treerec::growth {

void BoxGrid::add(uint32_t item, const Box& box) {
    each_bucket(box, [&](size_t bucket) { buckets_[bucket].push_back(item); });
}

void BoxGrid::remove(uint32_t item, const Box& box) {
    each_bucket(box, [&](size_t bucket) {
        std::vector<uint32_t>& items = buckets_[bucket];
        const auto at = std::find(items.begin(), items.end(), item);
        if (at == items.end()) return;
        *at = items.back();
        items.pop_back();
    });
}

}  // namespace treerec::growth
