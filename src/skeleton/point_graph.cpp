#include "skeleton/point_graph.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <utility>

#include "geometry/kd_tree.h"
#include "geometry/parallel.h"

namespace treerec {

namespace {

constexpr size_t kNeighbours = 10;
constexpr size_t kGrain = 2048;  // points between two looks at the cancel flag
constexpr size_t kLeafSize = 12;
constexpr size_t kScaleMax = 8;
constexpr size_t kScaleNeighbour = 2;  // the local spacing is the length of this shortest edge
constexpr int kScaleSmoothings = 3;
constexpr float kStrayFactor = 2.5f;  // times the neighbours' spacing, at most
constexpr float kReachFactor = 2.0f;
constexpr float kReachCap = 12.0f;  // times the cloud's median: no edge longer is ever surface

using Edge = std::pair<uint32_t, uint32_t>;  // the smaller vertex first

uint32_t find(std::vector<uint32_t>& leader, uint32_t v) {
    while (leader[v] != v)
        v = leader[v] = leader[leader[v]];
    return v;
}

void join(std::vector<uint32_t>& leader, uint32_t a, uint32_t b) {
    a = find(leader, a);
    b = find(leader, b);
    leader[std::max(a, b)] = std::min(a, b);
}

// nanoflann's result set for the nearest point of another part.
struct NearestOutside {
    using DistanceType = float;

    const std::vector<uint32_t>& part;
    uint32_t own;
    float best;  // squared metres
    uint32_t index = 0;
    bool found = false;

    size_t size() const { return found ? 1 : 0; }
    bool full() const { return true; }
    float worstDist() const { return best; }
    bool addPoint(float distance, uint32_t candidate) {
        if (part[candidate] != own && distance < best) {
            best = distance;
            index = candidate;
            found = true;
        }
        return true;
    }
    void sort() {}
};

// Boruvka's algorithm from the parts that the edges leave: each but the largest part is linked to the part
// nearest to it, until one is left.
void connect_parts(const std::vector<Vec3>& points, const KdTree& tree, std::vector<Edge>& edges,
                   Progress& progress) {
    std::vector<uint32_t> leader(points.size());
    std::iota(leader.begin(), leader.end(), 0u);
    for (const auto& [a, b] : edges)
        join(leader, a, b);
    std::vector<uint32_t> part(points.size());
    std::vector<uint32_t> members(points.size());
    std::vector<std::pair<float, Edge>> link(points.size());
    for (;;) {
        std::fill(members.begin(), members.end(), 0u);
        for (uint32_t v = 0; v < points.size(); v++)
            members[part[v] = find(leader, v)]++;
        const auto largest =
            static_cast<uint32_t>(std::max_element(members.begin(), members.end()) - members.begin());
        if (members[largest] == points.size()) return;
        std::fill(link.begin(), link.end(), std::pair(std::numeric_limits<float>::max(), Edge{}));
        for (uint32_t v = 0; v < points.size(); v++) {
            if (part[v] == largest) continue;
            if (v % kGrain == 0) progress.check();
            NearestOutside nearest{part, part[v], link[part[v]].first};
            tree.findNeighbors(nearest, &points[v].x, nanoflann::SearchParams());
            if (nearest.found)
                link[part[v]] = {nearest.best, Edge{std::min(v, nearest.index), std::max(v, nearest.index)}};
        }
        for (const auto& [distance, edge] : link) {
            if (distance == std::numeric_limits<float>::max()) continue;
            if (find(leader, edge.first) == find(leader, edge.second)) continue;
            join(leader, edge.first, edge.second);
            edges.push_back(edge);
        }
    }
}

}  // namespace

PointGraph neighbour_graph(const std::vector<Vec3>& points, Progress& progress) {
    const KdPoints kd_points{points};
    progress.check();
    const KdTree tree(3, kd_points, nanoflann::KDTreeSingleIndexAdaptorParams(kLeafSize));
    const size_t near = std::min(kNeighbours, points.size() - 1);
    std::vector<uint32_t> nearest(points.size() * near);
    parallel_for(points.size(), kGrain, [&](size_t begin, size_t end) {
        progress.check();
        std::array<uint32_t, kNeighbours + 1> index;
        std::array<float, kNeighbours + 1> distance;
        for (size_t v = begin; v < end; v++) {
            const size_t found = tree.knnSearch(&points[v].x, near + 1, index.data(), distance.data());
            uint32_t* to = &nearest[v * near];
            const uint32_t* last = to + near;
            for (size_t i = 0; i < found && to != last; i++)
                if (index[i] != v) *to++ = index[i];
        }
    });
    std::vector<Edge> edges;
    edges.reserve(points.size() * kNeighbours * 2 / 3);
    for (uint32_t v = 0; v < points.size(); v++)
        for (size_t i = 0; i < near; i++) {
            const uint32_t n = nearest[v * near + i];
            const uint32_t* others = &nearest[n * near];
            // An edge that both ends know is taken from its smaller end.
            if (v < n || std::find(others, others + near, v) == others + near)
                edges.emplace_back(std::min(v, n), std::max(v, n));
        }
    connect_parts(points, tree, edges, progress);

    PointGraph graph;
    graph.begin.assign(points.size() + 1, 0);
    for (const auto& [a, b] : edges) {
        graph.begin[a + 1]++;
        graph.begin[b + 1]++;
    }
    for (size_t v = 0; v < points.size(); v++)
        graph.begin[v + 1] += graph.begin[v];
    graph.neighbour.resize(2 * edges.size());
    graph.length.resize(2 * edges.size());
    std::vector<uint32_t> fill(graph.begin.begin(), graph.begin.end() - 1);
    for (const auto& [a, b] : edges) {
        graph.neighbour[fill[a]++] = b;
        graph.neighbour[fill[b]++] = a;
    }
    for (uint32_t v = 0; v < points.size(); v++) {
        std::sort(graph.neighbour.begin() + graph.begin[v], graph.neighbour.begin() + graph.begin[v + 1]);
        for (uint32_t e = graph.begin[v]; e < graph.begin[v + 1]; e++)
            graph.length[e] = glm::distance(points[v], points[graph.neighbour[e]]);
    }
    return graph;
}

void LocalScale::set_spacing(std::vector<float> values) {
    spacing = std::move(values);
    reach.resize(spacing.size());
    for (size_t v = 0; v < spacing.size(); v++)
        reach[v] = kReachFactor * spacing[v];
}

LocalScale local_scale(const PointGraph& graph, double thinning_spacing) {
    const size_t count = graph.size();
    std::vector<float> spacing(count);
    for (size_t v = 0; v < count; v++) {
        std::array<float, kScaleMax> shortest;
        shortest.fill(std::numeric_limits<float>::max());
        for (uint32_t e = graph.begin[v]; e < graph.begin[v + 1]; e++) {
            float length = graph.length[e];
            for (float& s : shortest)
                if (length < s) std::swap(length, s);
        }
        const size_t last = std::min<size_t>(kScaleNeighbour, graph.begin[v + 1] - graph.begin[v]);
        spacing[v] = std::max(static_cast<float>(thinning_spacing), last ? shortest[last - 1] : 0.0f);
    }
    std::vector<float> sorted = spacing;
    std::nth_element(sorted.begin(), sorted.begin() + static_cast<ptrdiff_t>(count / 2), sorted.end());
    const float cap = kReachCap / kReachFactor * sorted[count / 2];
    for (float& s : spacing)
        s = std::min(s, cap);

    std::vector<float> smooth(count);
    for (int round = 0; round < kScaleSmoothings; round++) {
        for (size_t v = 0; v < count; v++) {
            float sum = spacing[v];
            float weight = 1.0f;
            for (uint32_t e = graph.begin[v]; e < graph.begin[v + 1]; e++) {
                const uint32_t n = graph.neighbour[e];
                if (graph.length[e] > kReachFactor * spacing[v]) continue;
                sum += spacing[n];
                weight += 1.0f;
            }
            smooth[v] = sum / weight;
        }
        spacing.swap(smooth);
    }
    // A stray point is not as far-reaching as it is far away.
    for (size_t v = 0; v < count; v++) {
        float sum = 0.0f;
        for (uint32_t e = graph.begin[v]; e < graph.begin[v + 1]; e++)
            sum += spacing[graph.neighbour[e]];
        smooth[v] = std::min(spacing[v],
                             kStrayFactor * sum / static_cast<float>(graph.begin[v + 1] - graph.begin[v]));
    }
    LocalScale scale;
    scale.set_spacing(std::move(smooth));
    return scale;
}

}  // namespace treerec
