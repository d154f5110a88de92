#include "scan/leaves/leaf_blur.h"

#include <algorithm>
#include <array>

#include "geometry/point_tree.h"
#include "geometry/quantile.h"
#include "scan/leaves/leaf_cells.h"
#include "scan/stems/tree_heights.h"

namespace treerec {

namespace {

constexpr double kAround = 1.5 * TreeHeights::kFootTop;  // of the height
constexpr size_t kLookedAt = 512;
constexpr size_t kFewest = 50;
// A piece of a surface is this thin, of its length; points of a cloud without any are about 0.6.
constexpr std::array<size_t, 2> kPieces{16, 48};  // points
constexpr float kThin = 0.3F;
// Leafy scans reach 0.34 and more, blurred bare ones 0.1.
constexpr double kLeastOnSurface = 0.2;

}  // namespace

double blur_of(const std::vector<Vec3>& points, const Progress& progress) {
    const TreeHeights heights(points);
    progress.check();
    std::vector<Vec3> foot;
    std::vector<Vec3> around;
    for (const Vec3& p : points) {
        if (heights.of(p) < kAround) around.push_back(p);
        if (heights.at_foot(p)) foot.push_back(p);
    }
    if (foot.size() < kFewest || around.size() <= kPieces.back()) return 0.0;
    const PointTree tree(around);
    std::array<size_t, kPieces.size()> thin{};
    size_t looked_at = 0;
    std::vector<double> thickness;
    std::array<uint32_t, kPieces.back()> found{};
    std::array<float, kPieces.back()> squares{};
    const size_t stride = std::max<size_t>(1, foot.size() / kLookedAt);
    for (size_t i = stride / 2; i < foot.size(); i += stride, looked_at++) {
        progress.check();
        tree.nearest(foot[i], found.size(), found.data(), squares.data());
        for (size_t s = 0; s < kPieces.size(); s++) {
            const auto count = static_cast<float>(kPieces[s]);
            Vec3 mean(0.0F);
            for (size_t n = 0; n < kPieces[s]; n++)
                mean += (around[found[n]] - foot[i]) / count;
            std::array<float, 6> scatter{};
            for (size_t n = 0; n < kPieces[s]; n++)
                add_product(scatter, around[found[n]] - foot[i] - mean, 1.0F / count);
            const Vec3 deviation = deviations(scatter);
            thin[s] += deviation.z < kThin * deviation.x;
            if (s + 1 == kPieces.size()) thickness.push_back(deviation.z);
        }
    }
    const bool sharp = static_cast<double>(*std::ranges::max_element(thin)) >=
                       kLeastOnSurface * static_cast<double>(looked_at);
    return sharp ? 0.0 : quantile(thickness, 0.5);
}

}  // namespace treerec
