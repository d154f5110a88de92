#include "photos/sky_blends.h"

#include <array>
#include <vector>

#include "geometry/parallel.h"
#include "geometry/point_tree.h"
#include "geometry/quantile.h"

namespace treerec {

namespace {

constexpr size_t kAround = 64;        // points that tell how light it is there
constexpr double kBlend = 0.4;        // of the way from there to the sky
constexpr double kLeastApart = 40.0;  // grey levels between them: nearer ones can't be told apart

}  // namespace

size_t drop_sky_blends(PointCloud& cloud, const DVec3& sky_colour, const Progress* progress) {
    const auto grey_of = [](const DVec3& c) { return (77.0 * c.x + 150.0 * c.y + 29.0 * c.z) / 256.0; };
    const double sky = grey_of(sky_colour);
    if (cloud.empty() || !cloud.has_colors() || !(sky > 0.0)) return 0;
    std::vector<double> grey(cloud.size());
    for (size_t i = 0; i < cloud.size(); i++) {
        const Color8& c = cloud.colors[i];
        grey[i] = grey_of(DVec3(c[0], c[1], c[2]));
    }
    const PointTree tree(cloud.positions, progress);
    std::vector<uint8_t> keep(cloud.size(), 1);
    parallel_for(cloud.size(), 1024, [&](size_t first, size_t last) {
        if (progress) progress->check();
        std::array<uint32_t, kAround> index{};
        std::array<float, kAround> squared{};
        std::vector<double> around;
        for (size_t i = first; i < last; i++) {
            const size_t count = tree.nearest(cloud.positions[i], kAround, index.data(), squared.data());
            around.clear();
            for (size_t k = 0; k < count; k++)
                around.push_back(grey[index[k]]);
            const double usual = quantile(around, 0.5);
            keep[i] = sky - usual < kLeastApart || grey[i] < usual + kBlend * (sky - usual);
        }
    });
    const size_t before = cloud.size();
    cloud.keep_only(keep);
    return before - cloud.size();
}

}  // namespace treerec
