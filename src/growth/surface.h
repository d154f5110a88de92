// The growing surface: a closed triangle mesh whose vertices are tissue. Internal to growth/.
#pragma once

#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "geometry/vec.h"
#include "growth/tissue.h"

namespace treerec::growth {

using SurfaceMesh = CGAL::Surface_mesh<DVec3>;
using Vertex = SurfaceMesh::Vertex_index;
using Halfedge = SurfaceMesh::Halfedge_index;
using Edge = SurfaceMesh::Edge_index;
using Face = SurfaceMesh::Face_index;

// Why a vertex did not go where it wanted to.
enum class Hold : uint8_t {
    kFree,
    kFold,      // its own neighbourhood would fold over
    kSurface,   // another part of the surface is in the way
    kObstacle,  // an obstacle is
};

// What is known of a vertex beside its place. Metres and steps.
struct Cell {
    DVec3 previous{0.0};     // where it was a step ago (equation 2)
    DVec3 velocity{0.0};     // of this step (equation 1)
    double along = 0.0;      // of its branch's axis
    double speed = 0.0;      // S_c of this step
    double extra = 0.0;      // of this step, metres: what it grows away from its axis beside S_c,
    double excess = 0.0;     // and what it has so far
    double sunk = 0.0;       // metres that decayed wood has sunk in
    double bound = 0.0;      // of a tip: where along its axis this step is to lead it
    double tip_along = 0.0;  // of its branch's tip when the vertex was made (equation 7)
    // Of Contact's odometer: until then nothing far can be in its way, and nothing around it can fold over.
    double safe_until = -1.0, flat_until = -1.0;
    uint32_t id = 0;       // never given out again
    int32_t owner = 0;     // branch
    int32_t bud = -1;      // the branch that sprouts here, while it is dormant
    int32_t hollow = -1;   // the feature that makes it decay
    int32_t touched = -1;  // the obstacle that it stands against
    Tissue tissue = Tissue::kCambium;
    Hold hold = Hold::kFree;
    bool centre = false;  // spheres of burls ride on it
};

// In how many pieces of at most T_m / 4 (`shortest`: T_m, metres) it goes in a step.
inline int pieces_of(const Cell& cell, double shortest) {
    return std::max(static_cast<int>(std::ceil(4.0 * glm::length(cell.velocity) / shortest)), 1);
}

// Axis-aligned, metres.
struct Box {
    DVec3 low{1e300};
    DVec3 high{-1e300};

    void take(const DVec3& p) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    void take(const Box& box) {
        low = glm::min(low, box.low);
        high = glm::max(high, box.high);
    }
    Box grown(double by) const { return {low - by, high + by}; }
    bool holds(const Box& box) const {
        return glm::all(glm::lessThanEqual(low, box.low)) && glm::all(glm::lessThanEqual(box.high, high));
    }
    // Metres between two boxes; 0 where they meet. Never more than between what lies in them.
    double distance(const Box& box) const {
        const DVec3 gap = glm::max(glm::max(low - box.high, box.low - high), DVec3(0.0));
        return glm::length(gap);
    }
    bool meets(const Box& box) const {
        return glm::all(glm::lessThanEqual(low, box.high)) && glm::all(glm::lessThanEqual(box.low, high));
    }
};

struct FaceCell {
    DVec3 normal{0.0};   // unit, outwards
    Box box;             // of its corners,
    DVec3 centre{0.0};   // their middle
    double reach = 0.0;  // and metres from there to the farthest of them
    DVec3 middle{0.0};   // of the ball that it is listed by,
    double round = 0.0;  // and its radius, metres
    uint32_t stamp = 0;
    bool listed = false;
};

// The mesh with what its vertices, edges and faces are.
class Surface {
  public:
    SurfaceMesh mesh;
    SurfaceMesh::Property_map<Vertex, Cell> cells = mesh.add_property_map<Vertex, Cell>("v:cell").first;
    SurfaceMesh::Property_map<Edge, bool> links = mesh.add_property_map<Edge, bool>("e:link", false).first;
    SurfaceMesh::Property_map<Face, FaceCell> faces = mesh.add_property_map<Face, FaceCell>("f:cell").first;
    uint32_t next_id = 0;

    Surface() = default;
    Surface(const Surface&) = delete;
    Surface& operator=(const Surface&) = delete;

    const DVec3& place(Vertex v) const { return mesh.point(v); }
    double length(Edge e) const { return glm::distance(place(mesh.vertex(e, 0)), place(mesh.vertex(e, 1))); }
    // Corners of a face, counter-clockwise from outside.
    void corners(Face f, Vertex (&v)[3]) const {
        const Halfedge h = mesh.halfedge(f);
        v[0] = mesh.target(h);
        v[1] = mesh.target(mesh.next(h));
        v[2] = mesh.source(h);
    }
    // Its box, centre and reach from where its corners are now.
    void measure(Face f) {
        Vertex v[3];
        corners(f, v);
        const DVec3 p[3] = {place(v[0]), place(v[1]), place(v[2])};
        FaceCell& cell = faces[f];
        cell.centre = (p[0] + p[1] + p[2]) / 3.0;
        cell.box = Box();
        double square = 0.0;
        for (const DVec3& corner : p) {
            const DVec3 off = corner - cell.centre;
            square = std::max(square, glm::dot(off, off));
            cell.box.take(corner);
        }
        cell.reach = std::sqrt(square);
    }
    // Metres from a face as it was measured to what lies both in a box and in a ball; never more than it is.
    // Boxes of slanted faces side by side overlap, where balls about them don't.
    double least_distance(Face f, const Box& box, const DVec3& middle, double round) const {
        const FaceCell& cell = faces[f];
        return std::max(box.distance(cell.box), glm::distance(cell.centre, middle) - cell.reach - round);
    }
    // Unit; zero for a face without area.
    DVec3 normal_of(Face f) const {
        Vertex v[3];
        corners(f, v);
        return normalized_or(glm::cross(place(v[1]) - place(v[0]), place(v[2]) - place(v[0])), DVec3(0.0));
    }
};

// Equation 5: the unit sum of the unit normals of the faces around; zero where they cancel out.
inline DVec3 vertex_normal(const Surface& surface, Vertex v) {
    DVec3 sum(0.0);
    const SurfaceMesh& mesh = surface.mesh;
    const Halfedge first = mesh.halfedge(v);
    Halfedge h = first;
    do {
        sum += surface.faces[mesh.face(h)].normal;
        h = mesh.opposite(mesh.next(h));
    } while (h != first);
    return normalized_or(sum, DVec3(0.0));
}

}  // namespace treerec::growth
