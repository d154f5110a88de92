// The shortest-path tree of the point graph.
#pragma once

#include <vector>

#include "skeleton/sampling/point_graph.h"
#include "tree/tree.h"

namespace treerec {

// Where the paths start.
struct PathSeed {
    uint32_t vertex = 0;
    double distance = 0.0;  // metres that the vertex already is away from the base
};

// An edge over a gap that wood is known to cross.
struct SureLink {
    PointEdge edge;
    float cost;  // metres
};

struct PathTree {
    std::vector<int32_t> parent;  // by vertex; -1 at a seed
    std::vector<float> step;      // length of the edge to the parent, metres; 0 at a seed
    std::vector<float> along;     // metres along the path from the base
    std::vector<uint32_t> order;  // the vertices, parents before children
};

// Dijkstra's algorithm from all seeds at once. An edge costs its length up to the local reach, and
// length * (length / reach)^2 beyond it, so that a path takes the wood rather than a gap (AdTree, Du et al.
// 2019, 2.2, finds the same with plain lengths on complete scans). Where the wood's radius is known
// (scale.radius), a gap is wide by that measure, too, and a way from thin wood to thicker costs as much as
// many times the difference: no branch grows out of a twig. Ties are broken by vertex number. seeds: at least
// one. sure: edges over gaps that wood is known to cross, with their costs.
PathTree shortest_paths(const PointGraph& graph, const LocalScale& scale, const std::vector<PathSeed>& seeds,
                        Progress& progress, const std::vector<SureLink>& sure = {});

// The paths themselves, for pictures: vertex v is node v + 1, and the seeds hang on `root` (metres). Thin
// constant radii.
Tree path_tree_as_tree(const std::vector<Vec3>& points, const PathTree& paths, const DVec3& root);

}  // namespace treerec
