#include "skeleton/paths.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

namespace treerec {

PathTree shortest_paths(const PointGraph& graph, const LocalScale& scale, const std::vector<PathSeed>& seeds,
                        Progress& progress) {
    const size_t count = graph.size();
    PathTree tree;
    tree.parent.assign(count, -1);
    tree.step.assign(count, 0.0f);
    tree.along.assign(count, 0.0f);
    tree.order.reserve(count);
    std::vector<double> cost(count, std::numeric_limits<double>::max());
    std::vector<uint8_t> done(count, 0);
    using Entry = std::pair<double, uint32_t>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    for (const PathSeed& seed : seeds) {
        if (seed.distance >= cost[seed.vertex]) continue;
        cost[seed.vertex] = seed.distance;
        tree.along[seed.vertex] = static_cast<float>(seed.distance);
        queue.emplace(seed.distance, seed.vertex);
    }
    while (!queue.empty()) {
        const uint32_t v = queue.top().second;
        queue.pop();
        if (done[v]) continue;
        done[v] = 1;
        if (tree.order.size() % 8192 == 0) progress.check();
        tree.order.push_back(v);
        for (uint32_t e = graph.begin[v]; e < graph.begin[v + 1]; e++) {
            const uint32_t n = graph.neighbour[e];
            if (done[n]) continue;
            const double length = graph.length[e];
            const double stretch = std::max(1.0, length / edge_reach(scale, v, n));
            const double through = cost[v] + length * stretch * stretch;
            if (through < cost[n]) {
                cost[n] = through;
                tree.parent[n] = static_cast<int32_t>(v);
                tree.step[n] = graph.length[e];
                tree.along[n] = tree.along[v] + graph.length[e];
                queue.emplace(through, n);
            }
        }
    }
    return tree;
}

}  // namespace treerec
