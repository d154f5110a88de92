#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "geometry/random.h"
#include "scan/cleaning/clean_cloud.h"
#include "scan/cleaning/clean_steps.h"

namespace treerec {
namespace {

constexpr double kPi = 3.14159265358979323846;

// The bark of a stem with arms, `count` points of it.
std::vector<Vec3> wood(Random& random, int count) {
    std::vector<Vec3> points;
    for (int i = 0; i < count; i++) {
        const double turn = random.uniform(0.0, 2.0 * kPi), x = std::cos(turn), z = std::sin(turn);
        if (i % 3 != 0) {
            points.emplace_back(0.15 * x, random.uniform(0.0, 10.0), 0.15 * z);
        } else {
            const int arm = static_cast<int>(random.below(8));
            const double out = random.uniform(0.0, 2.5);
            const double angle = arm * kPi / 4.0;
            points.emplace_back(std::cos(angle) * out + 0.02 * x, 4.0 + 0.7 * arm + 0.02 * z,
                                std::sin(angle) * out);
        }
    }
    return points;
}

// A thousandth of a large scan is dust, as near to each other as sparse twigs of a small one.
TEST(FindOutliers, DustInALargeScanGoes) {
    Random random(5);
    std::vector<Vec3> points = wood(random, 250000);
    const size_t first = points.size();
    for (int i = 0; i < 2500; i++)
        points.emplace_back(random.uniform(-3.0, 3.0), random.uniform(0.0, 11.0), random.uniform(-3.0, 3.0));
    double spacing = 0.0;
    const CleanOptions options;
    const std::vector<uint8_t> goes = find_outliers(points, robust_ranges(points), options.neighbours,
                                                    options.outlier_deviations, spacing, nullptr);
    const auto gone = [&](size_t from, size_t to) {
        return static_cast<size_t>(std::count(goes.begin() + static_cast<ptrdiff_t>(from),
                                              goes.begin() + static_cast<ptrdiff_t>(to), 1));
    };
    EXPECT_EQ(gone(0, first), 0u);
    EXPECT_GT(gone(first, points.size()), 2300u);
}

}  // namespace
}  // namespace treerec
