#include "skeleton/delaunay/spanning_tree.h"

#include <limits>

#include "skeleton/geodesics/heap.h"

namespace treerec {

PathTree spanning_tree(const PointGraph& graph, uint32_t root, SpanningTreeKind kind, Progress& progress) {
    const size_t count = graph.size();
    PathTree tree;
    tree.parent.assign(count, -1);
    tree.step.assign(count, 0.0F);
    tree.along.assign(count, 0.0F);
    tree.order.reserve(count);
    std::vector<float> cost(count, std::numeric_limits<float>::max());
    std::vector<uint8_t> done(count, 0);
    LeastFirst queue;
    cost[root] = 0.0F;
    queue.push(heap_entry(0.0F, root));
    while (!queue.empty()) {
        const auto v = static_cast<uint32_t>(queue.pop());
        if (done[v]) continue;
        done[v] = 1;
        if (tree.order.size() % 8192 == 0) progress.check();
        tree.order.push_back(v);
        if (tree.parent[v] >= 0) tree.along[v] = tree.along[tree.parent[v]] + tree.step[v];
        const float own = kind == SpanningTreeKind::kMinimum ? 0.0F : cost[v];
        for (uint32_t e = graph.begin[v], end = graph.begin[v + 1]; e < end; e++) {
            const uint32_t n = graph.neighbour[e];
            const float length = graph.length[e];
            const float through = own + length * length;
            if (done[n] || through >= cost[n]) continue;
            cost[n] = through;
            tree.parent[n] = static_cast<int32_t>(v);
            tree.step[n] = length;
            queue.push(heap_entry(through, n));
        }
    }
    return tree;
}

}  // namespace treerec
