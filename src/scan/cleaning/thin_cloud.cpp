#include "scan/cleaning/thin_cloud.h"

#include <limits>
#include <string>
#include <vector>

#include "scan/cleaning/samples.h"

namespace treerec {

void thin_cloud(PointCloud& cloud, size_t most, const Progress* progress) {
    if (most < kFewestPoints)
        throw Error("A cloud must keep at least " + std::to_string(kFewestPoints) + " points.");
    if (cloud.size() <= most) return;
    constexpr size_t kBlock = size_t{1} << 20;
    constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();
    // The limit of the samples is met about.
    Samples samples = take_samples(cloud.positions, most, progress);
    for (size_t limit = most; samples.points.size() > most;) {
        limit -= limit / 10;
        samples = take_samples(cloud.positions, limit, progress);
    }
    // Of points at one place the colour decides, so that their order does not.
    const auto comes_before = [&](uint32_t a, uint32_t b) {
        return cloud.has_colors() && cloud.colors[a] < cloud.colors[b];
    };
    std::vector<uint32_t> kept(samples.points.size(), kNone);
    for (uint32_t i = 0; i < cloud.size(); i++) {
        if (progress && i % kBlock == 0) progress->check();
        const uint32_t sample = samples.of_point[i];
        if (cloud.positions[i] != samples.points[sample]) continue;
        if (kept[sample] == kNone || comes_before(i, kept[sample])) kept[sample] = i;
    }
    PointCloud thin;
    thin.frame = cloud.frame;
    for (const uint32_t i : kept) {
        thin.positions.push_back(cloud.positions[i]);
        if (cloud.has_colors()) thin.colors.push_back(cloud.colors[i]);
        if (cloud.has_normals()) thin.normals.push_back(cloud.normals[i]);
        if (!cloud.radii.empty()) thin.radii.push_back(cloud.radii[i]);
    }
    cloud = std::move(thin);
}

}  // namespace treerec
