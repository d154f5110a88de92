#include "photos/even_exposures.h"

#include <cmath>

namespace treerec {

namespace {

constexpr double kMostRatio = 0.7;  // in logarithms: more is no exposure but another thing
constexpr double kPrior = 0.02;     // of gains of 1, in overlaps
constexpr int kSteps = 300;         // of Gauss and Seidel's

}  // namespace

void ExposureOverlaps::add(size_t a, size_t b, const DVec3& ratio) {
    if (std::abs(ratio.x) + std::abs(ratio.y) + std::abs(ratio.z) > 3.0 * kMostRatio) return;
    Overlap& overlap = overlaps_[{a, b}];
    overlap.count += 1.0;
    overlap.sum += ratio;
}

std::vector<DVec3> ExposureOverlaps::gains(size_t photos) const {
    std::vector<DVec3> gains(photos, DVec3(0.0));
    for (int step = 0; step < kSteps; step++) {
        for (auto first = overlaps_.begin(); first != overlaps_.end();) {
            const size_t a = first->first.first;
            double count = 0.0;
            DVec3 sum(0.0);
            auto next = first;
            for (; next != overlaps_.end() && next->first.first == a; ++next) {
                sum += next->second.count * gains[next->first.second] - next->second.sum;
                count += next->second.count;
            }
            gains[a] = sum / (count * (1.0 + kPrior));
            first = next;
        }
    }
    return gains;
}

}  // namespace treerec
