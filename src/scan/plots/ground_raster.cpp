#include "scan/plots/ground_raster.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace treerec {

namespace {

constexpr double kStep = 1e-4;  // metres

// One level of a pyramid of means and of how sure they are (0: nothing is known).
struct Level {
    size_t width = 0, depth = 0;
    std::vector<double> height, sure;

    size_t at(size_t x, size_t z) const { return z * width + x; }
};

Level halve(const Level& fine) {
    Level coarse{(fine.width + 1) / 2, (fine.depth + 1) / 2, {}, {}};
    coarse.height.assign(coarse.width * coarse.depth, 0.0);
    coarse.sure.assign(coarse.height.size(), 0.0);
    for (size_t z = 0; z < fine.depth; z++)
        for (size_t x = 0; x < fine.width; x++) {
            const size_t c = coarse.at(x / 2, z / 2);
            coarse.height[c] += fine.sure[fine.at(x, z)] * fine.height[fine.at(x, z)];
            coarse.sure[c] += fine.sure[fine.at(x, z)];
        }
    for (size_t c = 0; c < coarse.sure.size(); c++) {
        if (coarse.sure[c] > 0.0) coarse.height[c] /= coarse.sure[c];
        coarse.sure[c] = std::min(coarse.sure[c], 1.0);
    }
    return coarse;
}

// Between the middles of the pixels; beyond the last ones as they are.
double sample(const Level& level, double x, double z) {
    const auto near = [](double at, size_t count, size_t& low, size_t& high) {
        const double kept = std::clamp(at, 0.0, static_cast<double>(count - 1));
        low = static_cast<size_t>(kept);
        high = std::min(low + 1, count - 1);
        return kept - static_cast<double>(low);
    };
    size_t x0 = 0, x1 = 0, z0 = 0, z1 = 0;
    const double fx = near(x, level.width, x0, x1), fz = near(z, level.depth, z0, z1);
    const auto row = [&](size_t at) {
        return (1.0 - fx) * level.height[level.at(x0, at)] + fx * level.height[level.at(x1, at)];
    };
    return (1.0 - fz) * row(z0) + fz * row(z1);
}

// Pull and push (Gortler et al. 1996, "The Lumigraph", section 3.4): holes take the means of ever wider
// surroundings.
void fill_holes(Level& level) {
    if (level.width <= 1 && level.depth <= 1) return;
    Level coarse = halve(level);
    fill_holes(coarse);
    for (size_t z = 0; z < level.depth; z++)
        for (size_t x = 0; x < level.width; x++)
            if (const size_t i = level.at(x, z); level.sure[i] < 1.0) {
                const double around =
                    sample(coarse, 0.5 * static_cast<double>(x) - 0.25, 0.5 * static_cast<double>(z) - 0.25);
                level.height[i] = level.sure[i] * level.height[i] + (1.0 - level.sure[i]) * around;
                level.sure[i] = 1.0;
            }
}

}  // namespace

GroundRaster::GroundRaster(const Range& x, const Range& z, double pixel) : x_(x), z_(z) {
    map_.pixel = pixel;
    map_.width = static_cast<size_t>(std::max(1.0, std::ceil(x.size() / pixel)));
    map_.depth = static_cast<size_t>(std::max(1.0, std::ceil(z.size() / pixel)));
    map_.first = DVec2(x.low, z.low) + 0.5 * pixel;
    sums_.resize(map_.width * map_.depth);
    counts_.resize(sums_.size());
}

void GroundRaster::add(const DVec3& p) {
    if (!x_.contains(p.x) || !z_.contains(p.z)) return;
    const auto index = [&](double value, double low, size_t count) {
        return std::min(count - 1, static_cast<size_t>((value - low) / map_.pixel));
    };
    const size_t i = index(p.z, z_.low, map_.depth) * map_.width + index(p.x, x_.low, map_.width);
    sums_[i] += std::llround(p.y / kStep);
    counts_[i]++;
}

Heightmap GroundRaster::finish() const {
    Heightmap map = map_;
    Level level{map.width, map.depth, std::vector<double>(sums_.size()), std::vector<double>(sums_.size())};
    for (size_t i = 0; i < sums_.size(); i++) {
        if (counts_[i] == 0) continue;
        level.height[i] = kStep * static_cast<double>(sums_[i]) / static_cast<double>(counts_[i]);
        level.sure[i] = 1.0;
        map.seen += 1.0;
    }
    if (map.seen == 0.0) return {};
    map.seen /= static_cast<double>(sums_.size());
    fill_holes(level);
    for (const double height : level.height)
        map.heights.push_back(static_cast<float>(height));
    return map;
}

}  // namespace treerec
