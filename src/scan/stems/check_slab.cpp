#include "scan/stems/check_slab.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>

#include "error.h"
#include "geometry/circle_fit.h"
#include "geometry/quantile.h"
#include "scan/cleaning/samples.h"
#include "scan/robust.h"

namespace treerec {

namespace {

constexpr size_t kLookedAt = 8192;      // points
constexpr size_t kFewestPoints = 40;    // of a section
constexpr double kMostRough = 0.12;     // of its radius: that half of its points lie off the bark
constexpr double kLeastCoverage = 0.3;  // of the circle: seen from one side
constexpr double kMostInside = 0.1;     // of its points
constexpr double kLeastOnBark = 0.7;    // of all points
constexpr double kWholeHeight = 0.9;    // of the slab's height, that a section spans
constexpr double kDisc = 0.4;           // height over width of one section: less is no stump
constexpr double kSlab = 0.2;           // height over width of several sections, all alike cut off,
constexpr double kShortPiece = 4.0;     // and over the trunks' own diameter
constexpr double kUpright = 0.5;        // of its radius: how far its lower half stands from its upper one
constexpr double kApart = 4.0;          // times the points' usual distance: between two sections

// The distance from a point to the nearest other one, the median of some. points: seen from above, distinct.
double usual_distance(const std::vector<Vec3>& flat) {
    std::vector<double> nearest;
    const size_t stride = flat.size() / 256 + 1;
    for (size_t i = 0; i < flat.size(); i += stride) {
        float best = std::numeric_limits<float>::max();
        for (size_t k = 0; k < flat.size(); k++)
            if (k != i) best = std::min(best, glm::distance(flat[i], flat[k]));
        nearest.push_back(static_cast<double>(best));
    }
    return quantile(nearest, 0.9);
}

}  // namespace

void refuse_slab(const PointCloud& cloud, const std::array<Range, 3>& ranges, const Progress* progress) {
    size_t axis = 0;
    for (size_t k = 1; k < 3; k++)
        if (ranges[k].size() < ranges[axis].size()) axis = k;
    const double height = ranges[axis].size();
    const double width = std::max(ranges[(axis + 1) % 3].size(), ranges[(axis + 2) % 3].size());
    if (!(height > 0.0) || height >= kDisc * width) return;
    const std::vector<Vec3> points = some_of(cloud.positions, kLookedAt, progress);
    if (points.size() < kFewestPoints) return;
    std::vector<Vec3> flat;
    std::vector<double> heights;
    const auto at = [&](const Vec3& p, size_t k) { return p[static_cast<int>(k % 3)]; };
    for (const Vec3& p : points) {
        flat.emplace_back(at(p, axis + 1), 0.0F, at(p, axis + 2));
        heights.push_back(static_cast<double>(at(p, axis)));
    }
    const double apart = kApart * usual_distance(flat);
    if (!(apart > 0.0) || apart > 0.1 * width) return;
    const std::vector<uint32_t> label =
        connected_components(flat, robust_ranges(flat, progress), apart, progress);
    std::vector<std::vector<size_t>> sections(*std::max_element(label.begin(), label.end()) + size_t{1});
    for (size_t i = 0; i < flat.size(); i++)
        sections[label[i]].push_back(i);
    size_t on_bark = 0;
    size_t found = 0;
    double widest = 0.0;
    for (const std::vector<size_t>& section : sections) {
        if (section.size() < kFewestPoints) continue;
        std::vector<DVec2> places;
        std::vector<double> levels;
        for (const size_t i : section) {
            places.emplace_back(flat[i].x, flat[i].z);
            levels.push_back(heights[i]);
        }
        const std::optional<CircleFit> ring = fit_circle(places, width, Random(1));
        if (!ring || ring->spread > kMostRough * ring->radius || ring->coverage < kLeastCoverage ||
            ring->inside > kMostInside)
            continue;
        const double low = quantile(levels, 0.02);
        if (quantile(levels, 0.98) - low < kWholeHeight * height * 0.96) continue;
        // What runs along, tilted, has its halves in different places.
        const double middle = quantile(levels, 0.5);
        std::array<DVec2, 2> centre{};
        std::array<double, 2> count{};
        for (size_t k = 0; k < section.size(); k++) {
            const size_t half = heights[section[k]] > middle;
            centre[half] += places[k];
            count[half] += 1.0;
        }
        if (glm::distance(centre[0] / std::max(count[0], 1.0), centre[1] / std::max(count[1], 1.0)) >
            kUpright * ring->radius)
            continue;
        found++;
        on_bark += section.size();
        widest = std::max(widest, 2.0 * ring->radius);
    }
    if (static_cast<double>(on_bark) < kLeastOnBark * static_cast<double>(points.size())) return;
    const bool slab =
        found > 1 ? height < kSlab * width && height < kShortPiece * widest : height < kDisc * widest;
    if (!slab) return;
    std::array<char, 300> text;
    std::snprintf(
        text.data(), text.size(),
        "The cloud is a slice across %s, %.3g units thick and %.3g wide, and no tree can be made of "
        "it. Take the whole scan that it was cut from.",
        found > 1 ? (std::to_string(found) + " trunks").c_str() : "a trunk", height, width);
    throw Error(text.data());
}

}  // namespace treerec
