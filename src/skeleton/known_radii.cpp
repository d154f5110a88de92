#include "skeleton/known_radii.h"

#include <algorithm>
#include <array>
#include <limits>

#include "geometry/groups.h"
#include "geometry/parallel.h"
#include "geometry/quantile.h"

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

// The nearest point of other wood that is at least as thick as asked for.
struct NearestThick {
    const std::vector<float>& radii;
    const std::vector<uint32_t>& wood;
    uint32_t own;
    float thick;
    float best;  // squared metres
    uint32_t found = std::numeric_limits<uint32_t>::max();

    float limit() const { return best; }
    void add(float squared, uint32_t v) {
        if (radii[v] < thick || wood[v] == own || squared > best || (squared == best && v > found)) return;
        best = squared;
        found = v;
    }
};

// By point, what is linked without gaps and about as thick: the smallest of its points.
std::vector<uint32_t> pieces_of(const PointGraph& graph, const LocalScale& scale) {
    Groups groups(graph.size());
    groups.join_all([&](uint32_t v, const auto& link) {
        for (uint32_t e = graph.begin[v]; e < graph.begin[v + 1]; e++) {
            const uint32_t n = graph.neighbour[e];
            if (n > v) break;  // they ascend
            const auto [thin, thick] = std::minmax(scale.radius[v], scale.radius[n]);
            if (thin >= kAlike * thick && graph.length[e] <= edge_reach(scale, v, n)) link(n);
        }
    });
    return groups.names();
}

}  // namespace

KnownRadii::KnownRadii(const PointCloud& cloud, double spacing, const Progress* progress)
    : cloud_(cloud), spacing_(spacing) {
    if (std::any_of(cloud.radii.begin(), cloud.radii.end(), [](float radius) { return radius > 0.0F; }))
        tree_.emplace(cloud.positions, progress);
}

std::optional<double> KnownRadii::around(const Station& station) const {
    std::array<uint32_t, kAsked> index{};
    std::array<float, kAsked> squared{};
    const size_t count = tree_->nearest(Vec3(station.position), kAsked, index.data(), squared.data());
    const double reach = kReach * (station.radius + spacing_);
    std::vector<float> known;
    size_t near = 0;
    for (; near < count && static_cast<double>(squared[near]) <= reach * reach; near++)
        if (const float radius = cloud_.radii[index[near]]; radius > 0.0F) known.push_back(radius);
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
            if (tree_->nearest(points[v], 1, &index, &squared) == 1) radii[v] = cloud_.radii[index];
        }
    });
    return radii;
}

void KnownRadii::tell(std::vector<std::vector<Station>>& axes) const {
    if (!tree_) return;
    parallel_for(axes.size(), 16, [&](size_t begin, size_t end) {
        for (size_t l = begin; l < end; l++)
            for (Station& station : axes[l]) {
                const std::optional<double> known = around(station);
                if (!known || (station.measured && station.radius > kThicker * *known + spacing_)) continue;
                station.radius = *known;
                station.scatter = 0.0;
                station.measured = true;
            }
    });
}

void link_stout_wood(const std::vector<Vec3>& points, const LocalScale& scale, double spacing,
                     PointGraph& graph, const Progress& progress) {
    const PointTree tree(points, &progress);
    const std::vector<uint32_t> wood = pieces_of(graph, scale);
    constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();
    std::vector<uint32_t> other(points.size(), kNone);
    parallel_for(points.size(), 256, [&](size_t begin, size_t end) {
        progress.check();
        for (size_t v = begin; v < end; v++) {
            const float radius = scale.radius[v];
            if (static_cast<double>(radius) < kStout * spacing) continue;
            const float far = static_cast<float>(kFar) * radius;
            NearestThick nearest{scale.radius, wood, wood[v], kAsThick * radius, far * far};
            tree.search(points[v], nearest);
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
