// Which boxes lie where: a hashed grid. Internal to growth/.
#pragma once

#include <cstdint>
#include <vector>

#include "growth/surface.h"

namespace treerec::growth {

class BoxGrid {
  public:
    // cell: metres; boxes of about that size are found fastest.
    explicit BoxGrid(double cell) : scale_(1.0 / cell), buckets_(kBuckets) {}

    void add(uint32_t item, const Box& box);
    // The box must be the one that it was added by.
    void remove(uint32_t item, const Box& box);
    // Calls take(item) for all whose boxes may meet this one, and for others; for some more than once.
    template <typename Take>
    void visit(const Box& box, Take take) const {
        each_bucket(box, [&](size_t bucket) {
            for (const uint32_t item : buckets_[bucket])
                take(item);
        });
    }

  private:
    static constexpr size_t kBuckets = size_t{1} << 16;

    template <typename Take>
    void each_bucket(const Box& box, Take take) const {
        const glm::i64vec3 low(glm::floor(box.low * scale_)), high(glm::floor(box.high * scale_));
        for (int64_t z = low.z; z <= high.z; z++)
            for (int64_t y = low.y; y <= high.y; y++)
                for (int64_t x = low.x; x <= high.x; x++)
                    take(bucket_of(x, y, z));
    }
    static size_t bucket_of(int64_t x, int64_t y, int64_t z) {
        const uint64_t key = static_cast<uint64_t>(x) * 0x9E3779B97F4A7C15ULL ^
                             static_cast<uint64_t>(y) * 0xC2B2AE3D27D4EB4FULL ^
                             static_cast<uint64_t>(z) * 0x165667B19E3779F9ULL;
        return static_cast<size_t>((key ^ (key >> 29)) * 0xBF58476D1CE4E5B9ULL >> 48);
    }

    double scale_;
    std::vector<std::vector<uint32_t>> buckets_;
};

}  // namespace treerec::growth
