#include "skeleton/delaunay/triangulate.h"

#ifdef TREEREC_CGAL

#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>

#include <algorithm>
#include <utility>

#endif

#include "error.h"

namespace treerec {

#ifndef TREEREC_CGAL

PointGraph delaunay_graph(const std::vector<Vec3>&, Progress&) {
    throw Error(
        "This build was made without CGAL and has no Delaunay triangulation; take the skeleton method "
        "geodesic or flood.");
}

#else

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Vertex = CGAL::Triangulation_vertex_base_with_info_3<uint32_t, Kernel>;
using Delaunay = CGAL::Delaunay_triangulation_3<Kernel, CGAL::Triangulation_data_structure_3<Vertex> >;

}  // namespace

PointGraph delaunay_graph(const std::vector<Vec3>& points, Progress& progress) {
    progress.check();
    std::vector<std::pair<Kernel::Point_3, uint32_t> > numbered;
    numbered.reserve(points.size());
    for (const Vec3& p : points)
        numbered.emplace_back(Kernel::Point_3(p.x, p.y, p.z), static_cast<uint32_t>(numbered.size()));
    const Delaunay triangulation(numbered.begin(), numbered.end());
    progress.check();
    if (triangulation.dimension() < 3)
        throw Error(
            "All points lie on a plane or on a line, and a tree needs depth: this looks like a photo or a "
            "section of a scan.");
    std::vector<PointEdge> edges;
    edges.reserve(8 * points.size());
    for (const Delaunay::Edge& edge : triangulation.finite_edges()) {
        const uint32_t a = edge.first->vertex(edge.second)->info();
        const uint32_t b = edge.first->vertex(edge.third)->info();
        edges.emplace_back(std::min(a, b), std::max(a, b));
    }
    PointGraph graph;
    graph.begin.assign(points.size() + 1, 0);
    add_edges(graph, points, std::move(edges));
    return graph;
}

#endif

}  // namespace treerec
