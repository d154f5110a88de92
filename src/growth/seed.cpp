#include "growth/seed.h"

#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/boost/graph/Euler_operations.h>
#include <CGAL/boost/graph/helpers.h>
#include <CGAL/boost/graph/iterator.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>

#include "edit/commands/command_text.h"
#include "error.h"
#include "growth/feature.h"
#include "growth/judge.h"

namespace treerec::growth {

namespace {

constexpr int kSides = 6;           // of the prism
constexpr double kPrismEdge = 0.7;  // of the longest edge
constexpr double kPrismTip = 1.7;   // such edges above its base
constexpr size_t kMostFaces = 200000;
constexpr double kAtCorner = 0.5;  // of the shortest edge: nearer to a corner, the tip is that corner,
constexpr double kAtEdge = 0.1;    // and with less than such a share of the far corner, it lies on the edge

Vertex add_cambium(Surface& surface, const DVec3& place, double along, double tip_along) {
    const Vertex v = surface.mesh.add_vertex(place);
    Cell& cell = surface.cells[v];
    cell.id = surface.next_id++;
    cell.previous = place;
    cell.along = along;
    cell.tip_along = tip_along;
    return v;
}

// A closed mesh's corners, each once, and its faces by them; without what has no area for want of corners.
struct Indexed {
    std::vector<DVec3> places;
    std::vector<std::array<size_t, 3>> faces;
};

Indexed index(const std::vector<std::array<DVec3, 3>>& triangles) {
    Indexed mesh;
    std::map<std::tuple<double, double, double>, size_t> known;
    double volume = 0.0;
    for (const std::array<DVec3, 3>& triangle : triangles) {
        std::array<size_t, 3> face{};
        for (size_t k = 0; k < 3; k++) {
            const DVec3& p = triangle[k];
            if (!std::isfinite(glm::dot(p, p)))
                throw Error("The seed has corners that are no numbers: give a mesh that has its place.");
            const auto [at, fresh] = known.try_emplace({p.x, p.y, p.z}, mesh.places.size());
            if (fresh) mesh.places.push_back(p);
            face[k] = at->second;
        }
        if (face[0] == face[1] || face[1] == face[2] || face[2] == face[0]) continue;
        mesh.faces.push_back(face);
        const DVec3& origin = mesh.places.front();
        volume += glm::dot(triangle[0] - origin, glm::cross(triangle[1] - origin, triangle[2] - origin));
    }
    if (volume < 0.0)  // inside out
        for (std::array<size_t, 3>& face : mesh.faces)
            std::swap(face[1], face[2]);
    return mesh;
}

// Nearest of the trunk's axis; metres along it.
double along_axis(const GrowthBranch& trunk, const DVec3& place) {
    double nearest = 1e300, along = trunk.axis.front().along;
    for (size_t i = 1; i < trunk.axis.size(); i++) {
        const AxisPlace &a = trunk.axis[i - 1], &b = trunk.axis[i];
        const DVec3 way = b.pith - a.pith;
        const double square = glm::dot(way, way);
        const double t = square > 0.0 ? std::clamp(glm::dot(place - a.pith, way) / square, 0.0, 1.0) : 0.0;
        const double far = glm::distance(place, a.pith + t * way);
        if (far >= nearest) continue;
        nearest = far;
        along = glm::mix(a.along, b.along, t);
    }
    return along;
}

struct Exit {
    Face face;
    DVec3 place, shares;  // of the face's corners
    double along;         // metres of the axis
};

// Where the axis first comes out of the mesh.
std::optional<Exit> find_exit(const Surface& surface, const GrowthBranch& trunk) {
    for (size_t i = 1; i < trunk.axis.size(); i++) {
        const AxisPlace &from = trunk.axis[i - 1], &to = trunk.axis[i];
        const DVec3 way = to.pith - from.pith;
        std::optional<Exit> first;
        double soonest = 2.0;
        for (const Face face : surface.mesh.faces()) {
            Vertex v[3];
            surface.corners(face, v);
            const DVec3 &a = surface.place(v[0]), &b = surface.place(v[1]), &c = surface.place(v[2]);
            // Moeller and Trumbore 1997, from inside to outside.
            const DVec3 across = glm::cross(b - a, c - a);
            const double falls = glm::dot(way, across);
            if (!(falls > 0.0)) continue;
            const double t = glm::dot(a - from.pith, across) / falls;
            if (t < 0.0 || t > 1.0 || t >= soonest) continue;
            const DVec3 at = from.pith + t * way;
            const double area = glm::dot(across, across);
            const DVec3 shares(glm::dot(glm::cross(b - at, c - at), across) / area,
                               glm::dot(glm::cross(c - at, a - at), across) / area,
                               glm::dot(glm::cross(a - at, b - at), across) / area);
            if (glm::any(glm::lessThan(shares, DVec3(-1e-12)))) continue;
            soonest = t;
            first = Exit{face, at, shares, glm::mix(from.along, to.along, t)};
        }
        if (first) return first;
    }
    return std::nullopt;
}

// A vertex at the exit: a corner, on an edge or within the face.
Vertex vertex_at(Surface& surface, const Exit& exit, double shortest) {
    SurfaceMesh& mesh = surface.mesh;
    Vertex corners[3];
    surface.corners(exit.face, corners);
    for (const Vertex corner : corners)
        if (glm::distance(surface.place(corner), exit.place) < kAtCorner * shortest) return corner;
    // corners() begins with the target of the face's halfedge.
    Halfedge h = mesh.halfedge(exit.face);
    for (int k = 0; k < 3; k++, h = mesh.next(h)) {
        if (exit.shares[(k + 1) % 3] >= kAtEdge) continue;
        const Halfedge made = CGAL::Euler::split_edge(h, mesh), back = mesh.opposite(h);
        const Vertex v = mesh.target(made);
        CGAL::Euler::split_face(made, mesh.next(h), mesh);
        CGAL::Euler::split_face(back, mesh.next(mesh.opposite(made)), mesh);
        const DVec3 a = surface.place(mesh.source(made)), way = surface.place(mesh.target(h)) - a;
        mesh.point(v) = a + way * (glm::dot(exit.place - a, way) / glm::dot(way, way));
        return v;
    }
    const Vertex v = mesh.target(CGAL::Euler::add_center_vertex(h, mesh));
    mesh.point(v) = exit.place;
    return v;
}

}  // namespace

Vertex plant_prism(Surface& surface, const GrowthPlan& plan, double longest) {
    SurfaceMesh& mesh = surface.mesh;
    const AxisPlace& base = plan.branches.front().axis.front();
    const DVec3 up = base.direction, x = any_perpendicular(up), z = glm::cross(up, x);
    const double edge = kPrismEdge * longest, tip = base.along + kPrismTip * edge;
    Vertex ring[2][kSides];
    for (int row = 0; row < 2; row++)
        for (int side = 0; side < kSides; side++) {
            const double angle = 2.0 * kPi * side / kSides;
            ring[row][side] = add_cambium(
                surface, base.pith + edge * (x * std::cos(angle) + z * std::sin(angle)) + up * (edge * row),
                base.along + edge * row, tip);
        }
    const Vertex below = add_cambium(surface, base.pith, base.along, tip);
    const Vertex above = add_cambium(surface, base.pith + up * (kPrismTip * edge), tip, tip);
    surface.cells[above].tissue = Tissue::kApical;
    for (int side = 0; side < kSides; side++) {
        const int next = (side + 1) % kSides;
        mesh.add_face(below, ring[0][next], ring[0][side]);
        mesh.add_face(ring[0][side], ring[0][next], ring[1][next]);
        mesh.add_face(ring[0][side], ring[1][next], ring[1][side]);
        mesh.add_face(above, ring[1][side], ring[1][next]);
        surface.links[mesh.edge(mesh.halfedge(ring[0][side], ring[1][side]))] = true;
        surface.links[mesh.edge(mesh.halfedge(ring[1][side], above))] = true;
    }
    return above;
}

Vertex plant_mesh(Surface& surface, const GrowthPlan& plan, double shortest) {
    if (plan.seed.size() > kMostFaces)
        throw Error("The seed has " + std::to_string(plan.seed.size()) + " triangles, and can have " +
                    std::to_string(kMostFaces) + ": simplify it.");
    const Indexed indexed = index(plan.seed);
    if (indexed.faces.empty() ||
        !CGAL::Polygon_mesh_processing::is_polygon_soup_a_polygon_mesh(indexed.faces))
        throw Error(
            "The seed is not one surface: at each edge two triangles must meet, and they must face the same "
            "way. Weld its vertices, and recalculate its normals outside.");
    const GrowthBranch& trunk = plan.branches.front();
    SurfaceMesh& mesh = surface.mesh;
    std::vector<Vertex> vertices;
    for (const DVec3& place : indexed.places) {
        const double along = along_axis(trunk, place);
        vertices.push_back(add_cambium(surface, place, along, along));
    }
    std::vector<std::vector<Vertex>> faces;
    for (const std::array<size_t, 3>& face : indexed.faces)
        faces.push_back({vertices[face[0]], vertices[face[1]], vertices[face[2]]});
    CGAL::Euler::add_faces(faces, mesh);
    for (const Vertex v : vertices)
        if (mesh.is_isolated(v)) mesh.remove_vertex(v);
    if (!CGAL::is_closed(mesh)) throw Error("The seed has holes: bark grows from a closed mesh. Fill them.");
    const Soundness found = judge_surface(surface);
    if (found.components > 1)
        throw Error("The seed has " + std::to_string(found.components) +
                    " parts that don't hang together: join them, or leave all but one out.");
    if (found.intersections > 0)
        throw Error("The seed goes through itself in " + std::to_string(found.intersections) +
                    " places: mend it, for example by remeshing.");
    Region inside;
    for (const Face face : mesh.faces()) {
        Vertex v[3];
        surface.corners(face, v);
        inside.add(surface.place(v[0]), surface.place(v[1]), surface.place(v[2]));
    }
    const DVec3& base = trunk.axis.front().pith;
    if (!inside.holds(base))
        throw Error("The trunk does not begin in the seed: move it so that it holds " + number_text(base.x) +
                    "," + number_text(base.y) + "," + number_text(base.z) + ".");
    const std::optional<Exit> exit = find_exit(surface, trunk);
    if (!exit) throw Error("The trunk does not come out of the seed: nothing is left to grow.");
    const Vertex tip = vertex_at(surface, *exit, shortest);
    Cell& cell = surface.cells[tip];
    if (std::find(vertices.begin(), vertices.end(), tip) == vertices.end()) cell.id = surface.next_id++;
    cell.tissue = Tissue::kApical;
    cell.along = cell.tip_along = exit->along;
    for (const Halfedge h : CGAL::halfedges_around_target(mesh.halfedge(tip), mesh))
        surface.links[mesh.edge(h)] = true;
    // As if all had been farther apart: what is finer than T_m is merged at once.
    for (const Vertex v : mesh.vertices())
        surface.cells[v].previous = base + 2.0 * (surface.place(v) - base);
    return tip;
}

}  // namespace treerec::growth
