#include "skeleton/sampling/point_graph.h"

#include <algorithm>
#include <array>
#include <utility>

#include "geometry/parallel.h"
#include "geometry/point_tree.h"
#include "skeleton/sampling/bridges.h"

namespace treerec {

namespace {

constexpr size_t kNeighbours = 9;
constexpr size_t kGrain = 2048;        // points between two looks at the cancel flag
constexpr size_t kScaleNeighbour = 2;  // the local spacing is the length of this shortest edge
constexpr int kScaleSmoothings = 3;
constexpr float kStrayFactor = 2.5f;  // times the neighbours' spacing, at most
constexpr float kReachFactor = 2.0f;
constexpr float kReachCap = 12.0f;  // times the cloud's median: no edge longer is ever surface

PointGraph graph_of(const std::vector<Vec3>& points, const std::vector<PointEdge>& edges,
                    const Progress* progress = nullptr) {
    const auto check = [&] {
        if (progress) progress->check();
    };
    check();
    PointGraph graph;
    graph.begin.assign(points.size() + 1, 0);
    for (const auto& [a, b] : edges) {
        graph.begin[a + 1]++;
        graph.begin[b + 1]++;
    }
    for (size_t v = 0; v < points.size(); v++)
        graph.begin[v + 1] += graph.begin[v];
    check();
    graph.neighbour.resize(2 * edges.size());
    graph.length.resize(2 * edges.size());
    std::vector<uint32_t> fill(graph.begin.begin(), graph.begin.end() - 1);
    for (const auto& [a, b] : edges) {
        graph.neighbour[fill[a]++] = b;
        graph.neighbour[fill[b]++] = a;
    }
    parallel_for(points.size(), kGrain, [&](size_t begin, size_t end) {
        check();
        for (size_t v = begin; v < end; v++) {
            std::sort(graph.neighbour.begin() + graph.begin[v], graph.neighbour.begin() + graph.begin[v + 1]);
            for (uint32_t e = graph.begin[v]; e < graph.begin[v + 1]; e++)
                graph.length[e] = glm::distance(points[v], points[graph.neighbour[e]]);
        }
    });
    return graph;
}

}  // namespace

PointGraph neighbour_graph(const std::vector<Vec3>& points, Progress& progress, PassSet left_out) {
    progress.check();
    const PointTree tree(points, &progress);
    const size_t near = std::min(kNeighbours, points.size() - 1);
    const std::vector<uint32_t> nearest = tree.nearest_of_all(near, progress);
    std::vector<std::vector<PointEdge>> parts((points.size() + kGrain - 1) / kGrain);
    parallel_for(points.size(), kGrain, [&](size_t begin, size_t end) {
        progress.check();
        std::vector<PointEdge>& part = parts[begin / kGrain];
        part.reserve((end - begin) * kNeighbours * 2 / 3);
        for (size_t v = begin; v < end; v++)
            for (size_t i = 0; i < near; i++) {
                const uint32_t own = static_cast<uint32_t>(v);
                const uint32_t n = nearest[v * near + i];
                const uint32_t* others = &nearest[n * near];
                // An edge that both ends know is taken from its smaller end.
                if (own < n || std::find(others, others + near, own) == others + near)
                    part.emplace_back(std::min(own, n), std::max(own, n));
            }
    });
    std::vector<PointEdge> edges;
    edges.reserve(points.size() * kNeighbours * 2 / 3);
    for (const std::vector<PointEdge>& part : parts)
        edges.insert(edges.end(), part.begin(), part.end());
    progress.check();
    Groups groups(points.size());
    groups.join_all([&](uint32_t v, const auto& link) {
        if (v % kGrain == 0) progress.check();
        for (size_t i = 0; i < near; i++)
            link(nearest[v * near + i]);
    });
    bridge_parts(points, tree, std::move(groups), edges, progress, left_out);

    return graph_of(points, edges, &progress);
}

std::optional<uint32_t> find_edge(const PointGraph& graph, const PointEdge& edge) {
    const auto begin = graph.neighbour.begin() + graph.begin[edge.first];
    const auto end = graph.neighbour.begin() + graph.begin[edge.first + 1];
    const auto found = std::lower_bound(begin, end, edge.second);
    if (found == end || *found != edge.second) return std::nullopt;
    return static_cast<uint32_t>(found - graph.neighbour.begin());
}

void add_edges(PointGraph& graph, const std::vector<Vec3>& points, std::vector<PointEdge> edges) {
    for (uint32_t v = 0; v < points.size(); v++)
        for (uint32_t e = graph.begin[v]; e < graph.begin[v + 1]; e++)
            if (v < graph.neighbour[e]) edges.emplace_back(v, graph.neighbour[e]);
    graph = graph_of(points, edges);
}

void LocalScale::set_spacing(std::vector<float> values) {
    spacing = std::move(values);
    reach.resize(spacing.size());
    for (size_t v = 0; v < spacing.size(); v++)
        reach[v] = kReachFactor * spacing[v];
}

LocalScale local_scale(const PointGraph& graph, double thinning_spacing, const Progress* progress) {
    const size_t count = graph.size();
    std::vector<float> spacing(count);
    parallel_for(count, kGrain, [&](size_t begin, size_t end) {
        if (progress) progress->check();
        for (size_t v = begin; v < end; v++) {
            std::array<float, kScaleNeighbour> shortest;
            shortest.fill(std::numeric_limits<float>::max());
            for (uint32_t e = graph.begin[v]; e < graph.begin[v + 1]; e++) {
                float length = graph.length[e];
                for (float& s : shortest)
                    if (length < s) std::swap(length, s);
            }
            const size_t last = std::min<size_t>(kScaleNeighbour, graph.begin[v + 1] - graph.begin[v]);
            spacing[v] = std::max(static_cast<float>(thinning_spacing), last ? shortest[last - 1] : 0.0f);
        }
    });
    std::vector<float> sorted = spacing;
    std::nth_element(sorted.begin(), sorted.begin() + static_cast<ptrdiff_t>(count / 2), sorted.end());
    const float cap = kReachCap / kReachFactor * sorted[count / 2];
    for (float& s : spacing)
        s = std::min(s, cap);

    std::vector<float> smooth(count);
    for (int round = 0; round < kScaleSmoothings; round++) {
        parallel_for(count, kGrain, [&](size_t begin, size_t end) {
            if (progress) progress->check();
            for (size_t v = begin; v < end; v++) {
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
        });
        spacing.swap(smooth);
    }
    // A stray point is not as far-reaching as it is far away.
    parallel_for(count, kGrain, [&](size_t begin, size_t end) {
        for (size_t v = begin; v < end; v++) {
            float sum = 0.0f;
            for (uint32_t e = graph.begin[v]; e < graph.begin[v + 1]; e++)
                sum += spacing[graph.neighbour[e]];
            smooth[v] = std::min(
                spacing[v], kStrayFactor * sum / static_cast<float>(graph.begin[v + 1] - graph.begin[v]));
        }
    });
    LocalScale scale;
    scale.set_spacing(std::move(smooth));
    return scale;
}

}  // namespace treerec
