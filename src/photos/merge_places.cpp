#include <algorithm>
#include <cmath>
#include <unordered_set>

#include "geometry/parallel.h"
#include "geometry/point_tree.h"
#include "geometry/quantile.h"
#include "photos/thin_wood.h"

namespace treerec {

namespace {

constexpr size_t kAsked = 64;         // neighbours of a place
constexpr double kReach = 1.5;        // radii, within which places are of the same wood
constexpr double kReachPixels = 2.5;  // at least
constexpr double kSameWay = 0.85;
constexpr size_t kLeastPhotos = 3;  // that found it
constexpr double kInside = 1.1;     // radii of thicker wood, within which thinner wood is not believed
constexpr double kThinner = 0.6;    // of its radius
constexpr double kApart = 2.0;      // pixels between two places that stay

// Furrows and lights on thicker wood: what lies inside of it, and is much thinner.
void drop_inside(std::vector<ThinPlace>& places, const DVec3& origin, Progress* progress) {
    // From class to class of radii, each twice as thick as the one before.
    std::vector<uint8_t> drop(places.size(), 0);
    double thickest = 0.0, thinnest = INFINITY;
    for (const ThinPlace& place : places) {
        thickest = std::max(thickest, place.radius);
        thinnest = std::min(thinnest, place.radius);
    }
    for (double least = thickest / 2.0; least > thinnest; least /= 2.0) {
        std::vector<Vec3> axes;
        std::vector<double> radii;
        for (const ThinPlace& place : places)
            if (place.radius >= least && place.radius < 2.0 * least + 1e-12) {
                axes.emplace_back(place.position - origin);
                radii.push_back(place.radius);
            }
        if (axes.empty()) continue;
        const PointTree tree(axes, progress);
        parallel_for(places.size(), 512, [&](size_t first, size_t last) {
            for (size_t i = first; i < last; i++) {
                uint32_t near = 0;
                float squared = 0.0F;
                if (drop[i] || tree.nearest(Vec3(places[i].position - origin), 1, &near, &squared) != 1)
                    continue;
                const double inside = kInside * radii[near];
                drop[i] = places[i].radius < kThinner * radii[near] &&
                          static_cast<double>(squared) < inside * inside;
            }
        });
    }
    size_t kept = 0;
    for (size_t i = 0; i < places.size(); i++)
        if (!drop[i]) places[kept++] = places[i];
    places.resize(kept);
}

}  // namespace

std::vector<ThinPlace> merged_places(std::span<const ThinPlace> places, Progress* progress) {
    std::vector<ThinPlace> merged;
    if (places.empty()) return merged;
    const DVec3 origin = places[0].position;
    std::vector<Vec3> points;
    for (const ThinPlace& place : places)
        points.emplace_back(place.position - origin);
    const PointTree tree(points, progress);
    std::vector<ThinPlace> moved(places.begin(), places.end());
    std::vector<uint8_t> keep(places.size(), 0);
    parallel_for(places.size(), 512, [&](size_t first, size_t last) {
        std::vector<uint32_t> near(kAsked);
        std::vector<float> squared(kAsked);
        std::vector<double> radii;
        std::vector<uint32_t> photos;
        for (size_t i = first; i < last; i++) {
            if (progress && i % 256 == 0) progress->check();
            const ThinPlace& place = places[i];
            const double reach = std::max(kReach * place.radius, kReachPixels * place.pixel);
            const size_t count = tree.nearest(points[i], kAsked, near.data(), squared.data());
            DVec3 mean(0.0);
            radii.clear();
            photos.clear();
            for (size_t k = 0; k < count; k++) {
                const ThinPlace& other = places[near[k]];
                if (static_cast<double>(squared[k]) > reach * reach ||
                    std::abs(glm::dot(other.way, place.way)) < kSameWay)
                    continue;
                mean += other.position - place.position;
                radii.push_back(other.radius);
                photos.push_back(other.photo);
            }
            std::sort(photos.begin(), photos.end());
            const auto seen = std::unique(photos.begin(), photos.end()) - photos.begin();
            if (static_cast<size_t>(seen) < kLeastPhotos) continue;
            mean /= static_cast<double>(radii.size());
            moved[i].position += mean - glm::dot(mean, place.way) * place.way;
            moved[i].radius = quantile(radii, 0.5);
            keep[i] = 1;
        }
    });
    // One in each cell, that of the first photo.
    std::unordered_set<uint64_t> taken;
    for (size_t i = 0; i < moved.size(); i++) {
        if (!keep[i]) continue;
        const DVec3 cell = glm::floor((moved[i].position - origin) / (kApart * moved[i].pixel));
        uint64_t key = 0;
        for (int axis = 0; axis < 3; axis++)
            key = key << 21 | (static_cast<uint64_t>(static_cast<int64_t>(cell[axis])) & 0x1FFFFF);
        if (taken.insert(key).second) merged.push_back(moved[i]);
    }
    drop_inside(merged, origin, progress);
    return merged;
}

}  // namespace treerec
