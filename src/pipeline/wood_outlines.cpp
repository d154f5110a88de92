#include "pipeline/wood_outlines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "geometry/parallel.h"
#include "geometry/point_tree.h"
#include "photos/outline_radii.h"

namespace treerec {

namespace {

constexpr double kThinnest = 0.0004;   // of the tree's extent: few photos have two pixels for it
constexpr size_t kMostPlaces = 12000;  // the thickest
constexpr size_t kAsked = 8;           // places near a point
constexpr double kAlong = 1.5;         // radii between a point and the place that it is of, along the wood
constexpr double kBark = 0.35;         // radii between a point and the bark,
constexpr double kBarkSpacings = 3.0;  // or so many spacings of the cloud
constexpr double kLookedAt = 0.9;      // of the progress

// A place every radius along the wood, in the scan's coordinates.
std::vector<WoodPlace> places_on(const Tree& tree) {
    const ScanFrame& frame = tree.frame();
    std::vector<WoodPlace> places;
    double extent = 0.0;
    for (const NodeId id : tree.depth_first())
        extent = std::max(extent, glm::length(tree.node(id).position));
    for (const NodeId id : tree.depth_first()) {
        const Node& node = tree.node(id);
        if (node.parent == kNoNode) continue;
        const Node& parent = tree.node(node.parent);
        const DVec3 way = node.position - parent.position;
        const double length = glm::length(way), thick = std::max(node.radius, parent.radius);
        if (!(length > 0.0) || !(thick > kThinnest * extent)) continue;
        const auto pieces = static_cast<size_t>(std::clamp(std::round(length / thick), 1.0, 1000.0));
        for (size_t k = 0; k < pieces; k++) {
            const double t = (static_cast<double>(k) + 0.5) / static_cast<double>(pieces);
            places.push_back({frame.to_scan(parent.position + t * way),
                              glm::normalize(frame.turn_to_scan(way)),
                              frame.length_to_scan(glm::mix(parent.radius, node.radius, t))});
        }
    }
    if (places.size() > kMostPlaces) {
        std::stable_sort(places.begin(), places.end(),
                         [](const WoodPlace& a, const WoodPlace& b) { return a.radius > b.radius; });
        places.resize(kMostPlaces);
    }
    return places;
}

}  // namespace

size_t measure_outlines(PointCloud& cloud, const Tree& tree, const PhotoModel& model,
                        const std::string& folder, Progress* progress) {
    std::vector<WoodPlace> places = places_on(tree);
    SubProgress looking(progress, 0.0, kLookedAt);
    const std::vector<double> radii = outline_radii(model, folder, places, {}, &looking);
    // A point that is of a place that was not measured is of none that was.
    size_t measured = 0;
    std::vector<Vec3> axes;
    for (size_t i = 0; i < places.size(); i++) {
        if (radii[i] > 0.0) places[i].radius = radii[i];
        measured += radii[i] > 0.0;
        axes.emplace_back(places[i].position - cloud.frame.origin);
    }
    if (measured == 0) return 0;
    const PointTree near_axes(axes, progress);
    cloud.radii.resize(cloud.size(), 0.0F);
    parallel_for(cloud.size(), 1024, [&](size_t first, size_t last) {
        if (progress) progress->check();
        std::array<uint32_t, kAsked> index{};
        std::array<float, kAsked> squared{};
        for (size_t i = first; i < last; i++) {
            const size_t count = near_axes.nearest(cloud.positions[i], kAsked, index.data(), squared.data());
            double best = std::numeric_limits<double>::max();
            uint32_t nearest = 0;
            for (size_t k = 0; k < count; k++) {
                const WoodPlace& place = places[index[k]];
                const DVec3 offset(cloud.positions[i] - axes[index[k]]);
                const double along = glm::dot(offset, place.way),
                             off = std::abs(glm::length(offset - along * place.way) - place.radius);
                if (std::abs(along) > kAlong * place.radius || off >= best ||
                    off > std::max(kBark * place.radius, kBarkSpacings * cloud.spacing))
                    continue;
                best = off;
                nearest = index[k];
            }
            if (best < std::numeric_limits<double>::max() && radii[nearest] > 0.0)
                cloud.radii[i] = static_cast<float>(radii[nearest]);
        }
    });
    return measured;
}

}  // namespace treerec
