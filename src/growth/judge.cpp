#include "growth/judge.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/boost/graph/helpers.h>

#include <utility>
#include <vector>

namespace treerec::growth {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using ExactMesh = CGAL::Surface_mesh<Kernel::Point_3>;

}  // namespace

Soundness judge_surface(const Surface& surface) {
    namespace PMP = CGAL::Polygon_mesh_processing;
    Soundness found;
    ExactMesh mesh;
    std::vector<ExactMesh::Vertex_index> vertex_of(surface.mesh.num_vertices());
    for (const Vertex v : surface.mesh.vertices()) {
        const DVec3& p = surface.place(v);
        vertex_of[v] = mesh.add_vertex({p.x, p.y, p.z});
    }
    bool manifold = true;
    for (const Face face : surface.mesh.faces()) {
        Vertex corners[3];
        surface.corners(face, corners);
        manifold &= mesh.add_face(vertex_of[corners[0]], vertex_of[corners[1]], vertex_of[corners[2]]) !=
                    ExactMesh::null_face();
    }
    found.closed = manifold && mesh.is_valid() && CGAL::is_closed(mesh);
    found.outward = found.closed && PMP::is_outward_oriented(mesh);
    std::vector<std::pair<ExactMesh::Face_index, ExactMesh::Face_index>> meets;
    PMP::self_intersections(mesh, std::back_inserter(meets));
    found.intersections = meets.size();
    auto component = mesh.add_property_map<ExactMesh::Face_index, size_t>("f:component", 0).first;
    found.components = PMP::connected_components(mesh, component);
    return found;
}

GrowthStep judge(const Run& run, double longest) {
    const Surface& surface = run.surface();
    const StepCount& count = run.count();
    GrowthStep step;
    step.step = run.step();
    step.vertices = count.vertices;
    step.edges = count.edges;
    step.faces = count.faces;
    step.chi = chi_of(count);
    step.frozen = count.frozen;
    step.frozen_free = count.folded;
    step.apical = count.short_edges.apical;
    step.parting = count.short_edges.parting;
    step.link = count.short_edges.link;
    step.fold = count.short_edges.fold;
    step.contact = count.short_edges.contact;
    step.unexplained = count.short_edges.unexplained;
    for (const Edge edge : surface.mesh.edges())
        if (surface.length(edge) > longest) step.above_longest++;
    const Soundness found = judge_surface(surface);
    step.closed = found.closed;
    step.outward = found.outward;
    step.intersections = found.intersections;
    step.components = found.components;
    return step;
}

}  // namespace treerec::growth
