// How wood differs from a circle across.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "geometry/vec.h"

namespace treerec {

// A cross-section's outline as a Fourier series of the radius over its mean. The first harmonic is only an
// offset of the axis and is none of the shape. Angles count from section_zero(), towards
// cross(direction, zero): what is known of a section so depends on the wood alone, not on a mesh.
struct SectionShape {
    static constexpr size_t kHarmonics = 4;  // the second to the fifth
    std::array<float, kHarmonics> cosine{};
    std::array<float, kHarmonics> sine{};

    bool operator==(const SectionShape&) const = default;
};

// No outline that a tree has needs more: a buttress that stands out by twice the radius.
inline constexpr float kLargestHarmonic = 2.0f;
inline constexpr size_t kMostSections = 65535;

// The table that a tree's nodes name their sections in. Copies of a tree share it; null: an empty one.
using SectionTable = std::shared_ptr<const std::vector<SectionShape>>;

// Where a section's angle is 0: +X, after the smallest rotation that takes +Y to the wood's direction (unit).
// That changes steadily with the direction but for wood that hangs straight down.
DVec3 section_zero(const DVec3& direction);

// How far sections can be told about wood of that direction: 1, and 0 where it hangs straight down.
double section_steadiness(const DVec3& direction);

}  // namespace treerec
