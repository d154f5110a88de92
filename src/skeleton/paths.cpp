#include "skeleton/paths.h"

#include <algorithm>
#include <bit>
#include <limits>

#include "skeleton/heap.h"

namespace treerec {

PathTree shortest_paths(const PointGraph& graph, const LocalScale& scale, const std::vector<PathSeed>& seeds,
                        Progress& progress) {
    const size_t count = graph.size();
    PathTree tree;
    tree.parent.assign(count, -1);
    tree.step.assign(count, 0.0f);
    tree.along.assign(count, 0.0f);
    tree.order.reserve(count);
    std::vector<float> cost(count, std::numeric_limits<float>::max());
    std::vector<uint8_t> done(count, 0);
    // The bits of positive floats are in the order of their values, so that one integer holds an entry.
    LeastFirst queue;
    const auto entry = [](float value, uint32_t vertex) {
        return (static_cast<uint64_t>(std::bit_cast<uint32_t>(value)) << 32) | vertex;
    };
    for (const PathSeed& seed : seeds) {
        const float distance = static_cast<float>(std::max(0.0, seed.distance));
        if (distance >= cost[seed.vertex]) continue;
        cost[seed.vertex] = distance;
        tree.along[seed.vertex] = distance;
        queue.push(entry(distance, seed.vertex));
    }
    while (!queue.empty()) {
        const uint32_t v = static_cast<uint32_t>(queue.pop());
        if (done[v]) continue;
        done[v] = 1;
        if (tree.order.size() % 8192 == 0) progress.check();
        tree.order.push_back(v);
        for (uint32_t e = graph.begin[v]; e < graph.begin[v + 1]; e++) {
            const uint32_t n = graph.neighbour[e];
            if (done[n]) continue;
            const float length = graph.length[e];
            const float stretch = std::max(1.0f, length / edge_reach(scale, v, n));
            const float through = cost[v] + length * stretch * stretch;
            if (through < cost[n]) {
                cost[n] = through;
                tree.parent[n] = static_cast<int32_t>(v);
                tree.step[n] = graph.length[e];
                tree.along[n] = tree.along[v] + graph.length[e];
                queue.push(entry(through, n));
            }
        }
    }
    return tree;
}

}  // namespace treerec
