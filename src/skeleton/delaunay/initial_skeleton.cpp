#include "skeleton/delaunay/initial_skeleton.h"

#include <algorithm>

#include "skeleton/delaunay/triangulate.h"

namespace treerec {

InitialSkeleton initial_skeleton(const std::vector<Vec3>& points, const DVec3& root, SpanningTreeKind kind,
                                 Progress& progress) {
    const PointGraph graph = delaunay_graph(points, progress);
    uint32_t nearest = 0;
    for (uint32_t v = 1; v < points.size(); v++)
        if (glm::distance(DVec3(points[v]), root) < glm::distance(DVec3(points[nearest]), root)) nearest = v;
    InitialSkeleton skeleton;
    skeleton.tree = spanning_tree(graph, nearest, kind, progress);
    skeleton.weight.assign(points.size(), 0.0);
    skeleton.reach.assign(points.size(), 0.0);
    for (auto it = skeleton.tree.order.rbegin(); it != skeleton.tree.order.rend(); ++it) {
        const int32_t parent = skeleton.tree.parent[*it];
        if (parent < 0) continue;
        const double step = skeleton.tree.step[*it];
        skeleton.weight[parent] += skeleton.weight[*it] + step;
        skeleton.reach[parent] = std::max(skeleton.reach[parent], skeleton.reach[*it] + step);
    }
    return skeleton;
}

}  // namespace treerec
