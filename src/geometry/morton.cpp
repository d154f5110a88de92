#include "geometry/morton.h"

#include <algorithm>

#include "geometry/parallel.h"

namespace treerec {

namespace {

constexpr int kAxisBits = 11;  // of a key: 33 bits are three rounds of the radix sort
constexpr double kLastCell = (1 << kAxisBits) - 1;
constexpr size_t kGrain = 4096;

// The lowest eleven bits, three apart.
uint64_t spread(uint64_t bits) {
    bits = (bits | bits << 32) & 0x1f00000000ffff;
    bits = (bits | bits << 16) & 0x1f0000ff0000ff;
    bits = (bits | bits << 8) & 0x100f00f00f00f00f;
    bits = (bits | bits << 4) & 0x10c30c30c30c30c3;
    return (bits | bits << 2) & 0x1249249249249249;
}

uint64_t cell_of(double at) {
    return at > 0.0 ? static_cast<uint64_t>(std::min(at, kLastCell)) : 0;
}

}  // namespace

void sort_morton(std::span<const Vec3> points, std::vector<KeyedIndex>& items, const Progress* progress) {
    if (items.empty()) return;
    Vec3 low = points[items.front().index];
    Vec3 high = low;
    for (const KeyedIndex& item : items) {
        low = glm::min(low, points[item.index]);
        high = glm::max(high, points[item.index]);
    }
    const DVec3 size = DVec3(high) - DVec3(low);
    const double extent = std::max({size.x, size.y, size.z});
    const double scale = extent > 0.0 ? kLastCell / extent : 0.0;
    parallel_for(items.size(), kGrain, [&](size_t begin, size_t end) {
        if (progress) progress->check();
        for (size_t i = begin; i < end; i++) {
            const DVec3 at = (DVec3(points[items[i].index]) - DVec3(low)) * scale;
            items[i].key = spread(cell_of(at.x)) | spread(cell_of(at.y)) << 1 | spread(cell_of(at.z)) << 2;
        }
    });
    radix_sort(items, progress);
}

std::vector<KeyedIndex> morton_order(std::span<const Vec3> points, const Progress* progress) {
    std::vector<KeyedIndex> items(points.size());
    for (size_t i = 0; i < points.size(); i++)
        items[i].index = static_cast<uint32_t>(i);
    sort_morton(points, items, progress);
    return items;
}

}  // namespace treerec
