// Which faces lie where: balls about them in a hashed grid. Internal to growth/.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "geometry/vec.h"

namespace treerec::growth {

class FaceGrid {
  public:
    // cell: metres; about twice what a face measures.
    explicit FaceGrid(double cell) : scale_(1.0 / cell), buckets_(kBuckets) {}

    // middle and round: of a ball about it, metres.
    void add(uint32_t item, const DVec3& middle, double round);
    // middle: as it was added by.
    void remove(uint32_t item, const DVec3& middle);
    // Calls take(item) once for each whose ball meets this one. May be asked by several threads at once.
    template <typename Take>
    void visit(const DVec3& middle, double radius, Take take) const {
        const double most = radius + largest_;
        const glm::i64vec3 low = cell_of(middle - most), high = cell_of(middle + most);
        for (int64_t z = low.z; z <= high.z; z++)
            for (int64_t y = low.y; y <= high.y; y++)
                for (int64_t x = low.x; x <= high.x; x++)
                    for (const Entry& entry : buckets_[bucket_of({x, y, z})]) {
                        const DVec3 off = entry.middle - middle;
                        const double reach = radius + entry.round;
                        if (glm::dot(off, off) > reach * reach) continue;
                        // Other cells share the bucket.
                        if (cell_of(entry.middle) == glm::i64vec3(x, y, z)) take(entry.item);
                    }
    }

  private:
    static constexpr size_t kBuckets = size_t{1} << 16;

    struct Entry {
        DVec3 middle;
        double round;
        uint32_t item;
    };

    glm::i64vec3 cell_of(const DVec3& place) const { return glm::i64vec3(glm::floor(place * scale_)); }
    static size_t bucket_of(const glm::i64vec3& cell) {
        const uint64_t key = static_cast<uint64_t>(cell.x) * 0x9E3779B97F4A7C15ULL ^
                             static_cast<uint64_t>(cell.y) * 0xC2B2AE3D27D4EB4FULL ^
                             static_cast<uint64_t>(cell.z) * 0x165667B19E3779F9ULL;
        return static_cast<size_t>((key ^ (key >> 29)) * 0xBF58476D1CE4E5B9ULL >> 48);
    }

    double scale_;
    double largest_ = 0.0;  // radius of all balls that there ever were
    std::vector<std::vector<Entry>> buckets_;
};

}  // namespace treerec::growth
