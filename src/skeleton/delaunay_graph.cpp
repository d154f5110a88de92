#include "skeleton/delaunay_graph.h"

#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Delaunay_triangulation_cell_base_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Spatial_sort_traits_adapter_3.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>
#include <CGAL/property_map.h>
#include <CGAL/spatial_sort.h>

#include <algorithm>
#include <array>
#include <utility>

namespace treerec {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_3<uint32_t, Kernel>;
using CellBase = CGAL::Delaunay_triangulation_cell_base_3<Kernel>;
using Triangulation =
    CGAL::Delaunay_triangulation_3<Kernel, CGAL::Triangulation_data_structure_3<VertexBase, CellBase>>;

constexpr size_t kInsertChunk = 2000;  // points between two looks at the cancel flag
constexpr size_t kScaleMax = 8;
constexpr size_t kScaleNeighbour = 2;  // the local spacing is the length of this shortest edge
constexpr int kScaleSmoothings = 3;
constexpr float kReachFactor = 2.0f;
constexpr float kReachCap = 12.0f;  // times the cloud's median: no edge longer is ever surface

}  // namespace

PointGraph delaunay_graph(const std::vector<Vec3>& points, Progress& progress) {
    std::vector<Kernel::Point_3> sites(points.size());
    std::vector<size_t> order(points.size());
    for (size_t i = 0; i < points.size(); i++) {
        sites[i] = Kernel::Point_3(points[i].x, points[i].y, points[i].z);
        order[i] = i;
    }
    // Insertion along a space-filling curve keeps each point near the last one (the hint).
    using SiteMap = CGAL::Pointer_property_map<Kernel::Point_3>::type;
    CGAL::spatial_sort(order.begin(), order.end(),
                       CGAL::Spatial_sort_traits_adapter_3<Kernel, SiteMap>(CGAL::make_property_map(sites)));
    Triangulation triangulation;
    Triangulation::Vertex_handle hint;
    for (size_t i = 0; i < order.size(); i++) {
        if (i % kInsertChunk == 0) {
            progress.check();
            progress.update(0.9 * static_cast<double>(i) / static_cast<double>(order.size()),
                            "Triangulation");
        }
        hint = triangulation.insert(sites[order[i]], hint);
        hint->info() = static_cast<uint32_t>(order[i]);
    }
    if (triangulation.dimension() < 3)
        throw Error(
            "All points of the cloud lie on one plane or line, so no tree can be found in it. Check that the "
            "file's three coordinate columns were read as x, y and z.");

    std::vector<std::pair<uint32_t, uint32_t>> edges;
    edges.reserve(points.size() * 8);
    for (auto edge = triangulation.finite_edges_begin(); edge != triangulation.finite_edges_end(); ++edge)
        edges.emplace_back(edge->first->vertex(edge->second)->info(),
                           edge->first->vertex(edge->third)->info());
    progress.check();

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
    LocalScale scale;
    scale.set_spacing(std::move(spacing));
    return scale;
}

}  // namespace treerec
