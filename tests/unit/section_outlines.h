// What a measured section says.
#pragma once

#include <cmath>

#include "tree/section_shape.h"

namespace treerec::test {

// The radius at an angle, over the mean.
inline double outline_radius(const SectionShape& shape, double angle) {
    double sum = 1.0;
    for (size_t i = 0; i < SectionShape::kHarmonics; i++) {
        const double by = static_cast<double>(i + 2) * angle;
        sum += static_cast<double>(shape.cosine[i]) * std::cos(by) +
               static_cast<double>(shape.sine[i]) * std::sin(by);
    }
    return sum;
}

}  // namespace treerec::test
