// Which scanned points lie side by side.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "geometry/groups.h"
#include "geometry/vec.h"
#include "progress.h"
#include "skeleton/passes.h"

namespace treerec {

using PointEdge = std::pair<uint32_t, uint32_t>;  // the smaller vertex first

// An undirected, connected graph in compressed rows: the neighbours of v are neighbour[begin[v]] ..
// neighbour[begin[v+1]), in ascending order, with the edges' lengths in metres beside them.
struct PointGraph {
    std::vector<uint32_t> begin;
    std::vector<uint32_t> neighbour;
    std::vector<float> length;

    size_t size() const { return begin.empty() ? 0 : begin.size() - 1; }
};

// points: distinct, metres. Every point is linked to its nearest ones, and what that leaves apart by the
// shortest edges that make the whole connected. (AdTree, Du et al. 2019, takes the edges of the Delaunay
// triangulation, which costs ten times as much: skeleton/delaunay/.)
PointGraph neighbour_graph(const std::vector<Vec3>& points, Progress& progress, PassSet left_out = {});

// Where the edge stands in the first vertex's row (an index into `neighbour`), if there is one.
std::optional<uint32_t> find_edge(const PointGraph& graph, const PointEdge& edge);

// Adds edges that the graph does not have.
void add_edges(PointGraph& graph, const std::vector<Vec3>& points, std::vector<PointEdge> edges);

// How densely the scan samples the surface around each point.
struct LocalScale {
    std::vector<float> spacing;  // metres between neighbouring samples, smoothed over the neighbours
    std::vector<float> reach;    // metres; an edge longer than this crosses a gap
    std::vector<float> radius;   // metres, of the wood a point lies on, where that is known; else 0, or empty

    // Takes new spacings; the reach follows.
    void set_spacing(std::vector<float> values);
};

LocalScale local_scale(const PointGraph& graph, double thinning_spacing, const Progress* progress = nullptr);

// The gap length of an edge between a and b.
inline float edge_reach(const LocalScale& scale, uint32_t a, uint32_t b) {
    return 0.5f * (scale.reach[a] + scale.reach[b]);
}

// By vertex: the smallest of those that it is linked to, directly or by others, by edges that cross no gap
// and that may(a, b) allows, which asks the same both ways.
template <typename May>
std::vector<uint32_t> pieces_of(const PointGraph& graph, const LocalScale& scale, const May& may) {
    Groups groups(graph.size());
    groups.join_all([&](uint32_t v, const auto& link) {
        for (uint32_t e = graph.begin[v]; e < graph.begin[v + 1]; e++) {
            const uint32_t n = graph.neighbour[e];
            if (n > v) break;  // they ascend
            if (graph.length[e] <= edge_reach(scale, v, n) && may(v, n)) link(n);
        }
    });
    return groups.names();
}

inline std::vector<uint32_t> pieces_of(const PointGraph& graph, const LocalScale& scale) {
    return pieces_of(graph, scale, [](uint32_t, uint32_t) { return true; });
}

}  // namespace treerec
