#include "growth/face_grid.h"

#include <algorithm>

namespace treerec::growth {

void FaceGrid::add(uint32_t item, const DVec3& middle, double round) {
    largest_ = std::max(largest_, round);
    buckets_[bucket_of(cell_of(middle))].push_back({middle, round, item});
}

void FaceGrid::remove(uint32_t item, const DVec3& middle) {
    std::vector<Entry>& entries = buckets_[bucket_of(cell_of(middle))];
    const auto at =
        std::find_if(entries.begin(), entries.end(), [&](const Entry& entry) { return entry.item == item; });
    if (at == entries.end()) return;
    *at = entries.back();
    entries.pop_back();
}

}  // namespace treerec::growth
