// An order statistic.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace treerec {

// The value below which the share q (0..1) lies. values: not empty; gets reordered. Linear.
template <typename T>
T quantile(std::vector<T>& values, double q) {
    const size_t index =
        std::min(values.size() - 1, static_cast<size_t>(q * static_cast<double>(values.size())));
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(index), values.end());
    return values[index];
}

}  // namespace treerec
