#include "skeleton/geodesics/paths.h"

#include <algorithm>
#include <bit>
#include <limits>

#include "geometry/parallel.h"
#include "skeleton/geodesics/heap.h"

namespace treerec {

namespace {

constexpr size_t kGrain = 1024;
constexpr double kRawRadius = 0.002;  // metres
constexpr float kThicker = 1.5F;      // times as thick as what bears it: more than measures differ
constexpr float kGrows = 30.0F;       // of the radius by which wood grows thicker: what that costs

// What each edge of the graph costs from the vertex of its row: its length, and more where it is a gap or
// leads to thicker wood.
std::vector<float> edge_costs(const PointGraph& graph, const LocalScale& scale, const Progress& progress) {
    std::vector<float> costs(graph.length.size());
    parallel_for(graph.size(), kGrain, [&](size_t begin, size_t end) {
        progress.check();
        for (size_t v = begin; v < end; v++)
            for (uint32_t e = graph.begin[v]; e < graph.begin[v + 1]; e++) {
                const float length = graph.length[e];
                float reach = edge_reach(scale, static_cast<uint32_t>(v), graph.neighbour[e]), grows = 0.0F;
                if (!scale.radius.empty()) {
                    const float from = scale.radius[v], to = scale.radius[graph.neighbour[e]];
                    reach = std::max(reach, std::min(from, to));
                    if (from > 0.0F && to > kThicker * from) grows = kGrows * (to - from);
                }
                const float stretch = std::max(1.0f, length / reach);
                costs[e] = length * stretch * stretch + grows;
            }
    });
    return costs;
}

}  // namespace

PathTree shortest_paths(const PointGraph& graph, const LocalScale& scale, const std::vector<PathSeed>& seeds,
                        Progress& progress, const std::vector<SureLink>& sure) {
    const size_t count = graph.size();
    PathTree tree;
    tree.parent.assign(count, -1);
    tree.step.assign(count, 0.0f);
    tree.along.assign(count, 0.0f);
    tree.order.reserve(count);
    std::vector<float> cost(count, std::numeric_limits<float>::max());
    LeastFirst queue;
    for (const PathSeed& seed : seeds) {
        const float distance = static_cast<float>(std::max(0.0, seed.distance));
        if (distance >= cost[seed.vertex]) continue;
        cost[seed.vertex] = distance;
        tree.along[seed.vertex] = distance;
        queue.push(heap_entry(distance, seed.vertex));
    }
    std::vector<float> edge_cost = edge_costs(graph, scale, progress);
    for (const SureLink& link : sure)
        for (const PointEdge& way : {link.edge, PointEdge(link.edge.second, link.edge.first)})
            if (const auto e = find_edge(graph, way)) edge_cost[*e] = std::min(edge_cost[*e], link.cost);
    while (!queue.empty()) {
        const uint64_t least = queue.pop();
        const uint32_t v = static_cast<uint32_t>(least);
        const float own = cost[v];
        if (static_cast<uint32_t>(least >> 32) != std::bit_cast<uint32_t>(own))
            continue;  // since reached for less
        if (tree.order.size() % 8192 == 0) progress.check();
        tree.order.push_back(v);
        for (uint32_t e = graph.begin[v], end = graph.begin[v + 1]; e < end; e++) {
            const float through = own + edge_cost[e];
            const uint32_t n = graph.neighbour[e];
            if (through < cost[n]) {
                cost[n] = through;
                tree.parent[n] = static_cast<int32_t>(v);
                tree.step[n] = graph.length[e];
                queue.push(heap_entry(through, n));
            }
        }
    }
    for (const uint32_t v : tree.order)
        if (tree.parent[v] >= 0) tree.along[v] = tree.along[tree.parent[v]] + tree.step[v];
    return tree;
}

Tree path_tree_as_tree(const std::vector<Vec3>& points, const PathTree& paths, const DVec3& root) {
    std::vector<NodeId> parents(points.size() + 1);
    std::vector<DVec3> positions(points.size() + 1);
    const std::vector<double> radii(points.size() + 1, kRawRadius);
    const std::vector<uint8_t> flags(points.size() + 1, 0);
    parents[0] = kNoNode;
    positions[0] = root;
    for (size_t v = 0; v < points.size(); v++) {
        parents[v + 1] = paths.parent[v] + 1;
        positions[v + 1] = DVec3(points[v]);
    }
    return Tree::from_arrays(parents, positions, radii, flags);
}

}  // namespace treerec
