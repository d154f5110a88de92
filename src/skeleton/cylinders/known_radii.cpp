#include "skeleton/cylinders/known_radii.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <tuple>
#include <utility>

#include "geometry/parallel.h"
#include "geometry/quantile.h"
#include "skeleton/cylinders/radii.h"

namespace treerec {

namespace {

constexpr size_t kAsked = 16;      // points around a station
constexpr size_t kLeast = 4;       // of them, of known radius,
constexpr double kMost = 0.66;     // and that share
constexpr double kReach = 2.0;     // radii and spacings, within which they lie
constexpr double kThicker = 1.25;  // times the known radius, and a spacing more: a surface with lines on it

constexpr double kStout = 0.5;    // spacings: thinner wood than that is linked as it is
constexpr double kFar = 6.0;      // radii, to other wood
constexpr float kAsThick = 0.8F;  // of the radius: what may bear it
constexpr float kAlike = 0.5F;    // one radius by the other of the same wood

constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();

// The nearest point of other wood that is at least as thick as asked for.
struct NearestThick {
    const std::vector<float>& radii;
    const std::vector<uint32_t>& wood;
    uint32_t own;
    float thick;
    float best;  // squared metres
    uint32_t found = kNone;

    float limit() const { return best; }
    void add(float squared, uint32_t v) {
        if (radii[v] < thick || wood[v] == own || squared > best || (squared == best && v > found)) return;
        best = squared;
        found = v;
    }
};

// By node: how thick the thickest of its points is. Without this and their names a thick trunk's points would
// all look at each other for other wood.
std::vector<float> thickest_of_nodes(const PointTree& tree, const std::vector<float>& radii) {
    std::vector<float> thickest(tree.node_count(), 0.0F);
    for (size_t node = 0; node < tree.node_count(); node++) {
        const bool group = node < tree.group_count();
        for (const uint32_t member : group ? tree.in_group(node) : tree.in_block(node))
            thickest[node] = std::max(thickest[node], (group ? radii : thickest)[member]);
    }
    return thickest;
}

}  // namespace

KnownRadii::KnownRadii(const PointCloud& cloud, double spacing, const Progress* progress)
    : spacing_(spacing) {
    const auto known = [](float radius) { return std::isfinite(radius) && radius > 0.0F; };
    if (std::none_of(cloud.radii.begin(), cloud.radii.end(), known)) return;
    // Each place once, and in an order that is not the cloud's.
    std::vector<std::pair<Vec3, float>> places;
    places.reserve(cloud.size());
    for (size_t i = 0; i < cloud.size(); i++)
        if (is_finite(DVec3(cloud.positions[i])))
            places.emplace_back(cloud.positions[i], known(cloud.radii[i]) ? cloud.radii[i] : 0.0F);
    const auto key = [](const std::pair<Vec3, float>& place) {
        return std::tuple(place.first.x, place.first.y, place.first.z, -place.second);
    };
    std::sort(places.begin(), places.end(), [&](const auto& a, const auto& b) { return key(a) < key(b); });
    places.erase(std::unique(places.begin(), places.end(),
                             [](const auto& a, const auto& b) { return a.first == b.first; }),
                 places.end());
    std::vector<Vec3> positions;
    positions.reserve(places.size());
    radii_.reserve(places.size());
    for (const auto& [position, radius] : places) {
        positions.push_back(position);
        radii_.push_back(radius);
    }
    tree_.emplace(positions, progress);
}

std::optional<double> KnownRadii::around(const Station& station) const {
    std::array<uint32_t, kAsked> index{};
    std::array<float, kAsked> squared{};
    const size_t count = tree_->nearest(Vec3(station.position), kAsked, index.data(), squared.data());
    const double reach = kReach * (station.radius + spacing_);
    std::vector<float> known;
    size_t near = 0;
    for (; near < count && static_cast<double>(squared[near]) <= reach * reach; near++)
        if (const float radius = radii_[index[near]]; radius > 0.0F) known.push_back(radius);
    if (known.size() < kLeast || static_cast<double>(known.size()) < kMost * static_cast<double>(near))
        return {};
    return static_cast<double>(quantile(known, 0.5));
}

std::vector<float> KnownRadii::at(const std::vector<Vec3>& points, const Progress& progress) const {
    std::vector<float> radii(points.size(), 0.0F);
    if (!tree_) return radii;
    parallel_for(points.size(), 1024, [&](size_t begin, size_t end) {
        progress.check();
        for (size_t v = begin; v < end; v++) {
            uint32_t index = 0;
            float squared = 0.0F;
            if (tree_->nearest(points[v], 1, &index, &squared) == 1) radii[v] = radii_[index];
        }
    });
    return radii;
}

void KnownRadii::tell(std::vector<std::vector<Station>>& axes) const {
    if (!tree_) return;
    parallel_for(axes.size(), 16, [&](size_t begin, size_t end) {
        for (size_t l = begin; l < end; l++) {
            double to_tip = 0.0;
            for (size_t i = axes[l].size(); i-- > 0;) {
                Station& station = axes[l][i];
                if (i + 1 < axes[l].size())
                    to_tip += glm::distance(station.position, axes[l][i + 1].position);
                const std::optional<double> known = around(station);
                if (!known || (station.measured && station.radius > kThicker * *known + spacing_)) continue;
                // Wood so stout would show its section, had it points of its own.
                const bool doubted = !station.measured && *known > spacing_;
                station.radius = doubted ? std::min(*known, thickest_unmeasured(to_tip)) : *known;
                station.scatter = 0.0;
                station.measured = true;
            }
        }
    });
}

void link_stout_wood(const std::vector<Vec3>& points, const PointTree& tree, const LocalScale& scale,
                     double spacing, PointGraph& graph, const Progress& progress) {
    const std::vector<uint32_t> wood = pieces_of(graph, scale, [&](uint32_t a, uint32_t b) {
        const auto [thin, thick] = std::minmax(scale.radius[a], scale.radius[b]);
        return thin >= kAlike * thick;
    });
    const std::vector<uint32_t> wood_of_nodes = names_of_nodes(tree, wood);
    const std::vector<float> thickest = thickest_of_nodes(tree, scale.radius);
    std::vector<uint32_t> other(points.size(), kNone);
    parallel_for(points.size(), 256, [&](size_t begin, size_t end) {
        progress.check();
        for (size_t v = begin; v < end; v++) {
            const float radius = scale.radius[v];
            if (static_cast<double>(radius) < kStout * spacing) continue;
            const float far = static_cast<float>(kFar) * radius;
            NearestThick nearest{scale.radius, wood, wood[v], kAsThick * radius, far * far};
            tree.search(points[v], nearest, [&](uint32_t node) {
                return wood_of_nodes[node] != wood[v] && thickest[node] >= nearest.thick;
            });
            other[v] = nearest.found;
        }
    });
    std::vector<PointEdge> edges;
    for (uint32_t v = 0; v < points.size(); v++) {
        if (other[v] == kNone) continue;
        const PointEdge edge(std::min(v, other[v]), std::max(v, other[v]));
        if (!find_edge(graph, edge)) edges.push_back(edge);
    }
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    if (!edges.empty()) add_edges(graph, points, std::move(edges));
}

}  // namespace treerec
