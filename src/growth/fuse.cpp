#include "growth/fuse.h"

#include <CGAL/boost/graph/Euler_operations.h>
#include <CGAL/boost/graph/iterator.h>

#include <algorithm>
#include <array>
#include <functional>
#include <tuple>

namespace treerec::growth {

namespace {

// Longest edges along the surface within which two places are one sheet: what meets there is a crease, which
// is zipped up, and no handle.
constexpr double kOneSheet = 6.0;
constexpr double kFacing = -0.5;    // cosine between the normals of faces that may become one,
constexpr double kCrease = -0.5;    // and of those beside a crease that is zipped up
constexpr double kKeepsSide = 0.2;  // cosine between a face's normals before and after
constexpr size_t kTries = 8;        // pairs of faces that one vertex offers
constexpr size_t kLeastDegree = 5;  // of a crease's ends: zipping takes two of their edges

}  // namespace

// Cambium and not about to sprout.
bool Fuser::sound(Vertex vertex) const {
    return surface_.cells[vertex].tissue == Tissue::kCambium && surface_.cells[vertex].bud < 0;
}

void Fuser::run() {
    merged_.clear();
    std::vector<std::pair<uint32_t, Vertex>> held;
    for (const Vertex v : surface_.mesh.vertices())
        if (surface_.cells[v].hold == Hold::kSurface && sound(v)) held.emplace_back(surface_.cells[v].id, v);
    std::sort(held.begin(), held.end());
    for (const auto& [id, v] : held)
        if (!surface_.mesh.is_removed(v) && surface_.cells[v].id == id) join(v);
    zip_all();
}

// Marks what is at most kOneSheet along the surface's edges from a vertex.
void Fuser::find_near(Vertex vertex) {
    const SurfaceMesh& mesh = surface_.mesh;
    reached_.resize(mesh.num_vertices(), 0);
    round_++;
    heap_.assign(1, {0.0, vertex});
    while (!heap_.empty()) {
        std::pop_heap(heap_.begin(), heap_.end(), std::greater<>());
        const auto [way, v] = heap_.back();
        heap_.pop_back();
        if (reached_[v] == round_) continue;
        reached_[v] = round_;
        for (const Vertex next : CGAL::vertices_around_target(mesh.halfedge(v), mesh)) {
            const double far = way + glm::distance(surface_.place(v), surface_.place(next));
            if (reached_[next] == round_ || far > kOneSheet * longest_) continue;
            heap_.emplace_back(far, next);
            std::push_heap(heap_.begin(), heap_.end(), std::greater<>());
        }
    }
}

void Fuser::join(Vertex held) {
    const SurfaceMesh& mesh = surface_.mesh;
    find_near(held);
    std::vector<Face> others;
    contact_.visit(surface_.place(held), longest_, [&](Face face) {
        Vertex corners[3];
        surface_.corners(face, corners);
        for (const Vertex corner : corners)
            if (reached_[corner] == round_ || !sound(corner)) return;
        others.push_back(face);
    });
    std::sort(others.begin(), others.end());
    std::vector<Pair> pairs;
    for (const Halfedge h : CGAL::halfedges_around_target(mesh.halfedge(held), mesh)) {
        if (!sound(mesh.source(h)) || !sound(mesh.target(mesh.next(h)))) continue;
        const Face own = mesh.face(h);
        for (const Face other : others) {
            if (glm::dot(surface_.faces[own].normal, surface_.faces[other].normal) > kFacing) continue;
            Pair best{1e300, h, Halfedge()};
            Halfedge g = mesh.halfedge(other);
            for (int turn = 0; turn < 3; turn++, g = mesh.next(g)) {
                double cost = 0.0, most = 0.0;
                Halfedge a = h, b = g;
                for (int k = 0; k < 3; k++, a = mesh.next(a), b = mesh.prev(b)) {
                    const DVec3 off = surface_.place(mesh.target(a)) - surface_.place(mesh.source(b));
                    cost += glm::dot(off, off);
                    most = std::max(most, glm::dot(off, off));
                }
                if (most <= longest_ * longest_ && cost < best.cost) best = {cost, h, g};
            }
            if (best.cost < 1e300) pairs.push_back(best);
        }
    }
    std::sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) {
        return std::tie(a.cost, a.own, a.other) < std::tie(b.cost, b.own, b.other);
    });
    if (pairs.size() > kTries) pairs.resize(kTries);
    for (const Pair& pair : pairs)
        if (try_join(pair)) return;
}

// Adds to the change that a face's corners become others; false where it would turn over.
bool Fuser::replace(Face face, const std::vector<std::pair<Vertex, Vertex>>& becomes) {
    std::array<Vertex, 3> made;
    Vertex corners[3];
    surface_.corners(face, corners);
    DVec3 p[3];
    for (size_t k = 0; k < 3; k++) {
        made[k] = corners[k];
        for (const auto& [from, to] : becomes)
            if (corners[k] == from) made[k] = to;
        p[k] = made[k] == change_.moved ? change_.to : surface_.place(made[k]);
    }
    const DVec3 normal = normalized_or(glm::cross(p[1] - p[0], p[2] - p[0]), DVec3(0.0));
    change_.made.push_back(made);
    change_.replaced.push_back(face);
    return glm::dot(normal, surface_.faces[face].normal) >= kKeepsSide;
}

// What a vertex knows that another has become part of.
void Fuser::settle(Vertex kept, const Cell& gone) {
    Cell& cell = surface_.cells[kept];
    cell.id = std::min(cell.id, gone.id);
    cell.previous = 0.5 * (cell.previous + gone.previous);
    cell.excess = 0.5 * (cell.excess + gone.excess);
    cell.speed = 0.5 * (cell.speed + gone.speed);
    cell.centre |= gone.centre;
    cell.touched = std::max(cell.touched, gone.touched);
}

bool Fuser::try_join(const Pair& pair) {
    SurfaceMesh& mesh = surface_.mesh;
    Vertex own[3], other[3], made[3];
    Halfedge a = pair.own, b = pair.other;
    Halfedge other_edges[3];
    for (int k = 0; k < 3; k++, a = mesh.next(a), b = mesh.prev(b)) {
        own[k] = mesh.target(a);
        other[k] = mesh.source(b);
        other_edges[k] = b;
    }
    // The places where they meet, as vertices for the check alone.
    std::vector<std::pair<Vertex, Vertex>> becomes;
    for (int k = 0; k < 3; k++) {
        made[k] = mesh.add_vertex(0.5 * (surface_.place(own[k]) + surface_.place(other[k])));
        becomes.emplace_back(own[k], made[k]);
        becomes.emplace_back(other[k], made[k]);
    }
    change_.clear();
    change_.sudden = true;
    const Face faces[2] = {mesh.face(pair.own), mesh.face(pair.other)};
    std::vector<Face> around;
    for (const auto& [from, to] : becomes)
        for (const Face face : CGAL::faces_around_target(mesh.halfedge(from), mesh))
            if (face != faces[0] && face != faces[1]) around.push_back(face);
    std::sort(around.begin(), around.end());
    around.erase(std::unique(around.begin(), around.end()), around.end());
    bool free = std::all_of(around.begin(), around.end(), [&](Face face) { return replace(face, becomes); });
    change_.replaced.insert(change_.replaced.end(), faces, faces + 2);
    free = free && contact_.check(change_) == Hold::kFree;
    DVec3 places[3];
    for (int k = 0; k < 3; k++) {
        places[k] = surface_.place(made[k]);
        mesh.remove_vertex(made[k]);
    }
    if (!free) return false;
    for (const Face face : change_.replaced)
        contact_.unlist(face);
    // The edge from own[k - 1] to own[k] becomes one with other_edges[k].
    Halfedge h = pair.own;
    for (int k = 0; k < 3; k++, h = mesh.next(h))
        if (surface_.links[mesh.edge(other_edges[k])]) surface_.links[mesh.edge(h)] = true;
    CGAL::Euler::join_loop(pair.own, pair.other, mesh);
    for (int k = 0; k < 3; k++) {
        mesh.point(own[k]) = places[k];
        settle(own[k], surface_.cells[other[k]]);
        merged_.emplace_back(other[k], own[k]);
    }
    for (const Vertex v : own)
        for (const Face face : CGAL::faces_around_target(mesh.halfedge(v), mesh))
            contact_.list(face);
    for (const Vertex v : own)
        contact_.look_again_around(v);
    joined_++;
    return true;
}

// An edge in a valley whose sides have come together.
bool Fuser::creases(Edge edge) const {
    const SurfaceMesh& mesh = surface_.mesh;
    const Halfedge h = mesh.halfedge(edge), o = mesh.opposite(h);
    const FaceCell& f = surface_.faces[mesh.face(h)];
    if (glm::dot(f.normal, surface_.faces[mesh.face(o)].normal) > kCrease) return false;
    const Vertex a = mesh.target(mesh.next(h)), b = mesh.target(mesh.next(o));
    const DVec3 across = surface_.place(b) - surface_.place(a);
    return glm::dot(across, f.normal) > 0.0 && glm::dot(across, across) < shortest_ * shortest_ && sound(a) &&
           sound(b);
}

void Fuser::zip_all() {
    const SurfaceMesh& mesh = surface_.mesh;
    std::vector<std::pair<double, Edge>> found;
    for (const Edge edge : mesh.edges())
        if (creases(edge)) {
            const Halfedge h = mesh.halfedge(edge);
            found.emplace_back(glm::distance(surface_.place(mesh.target(mesh.next(h))),
                                             surface_.place(mesh.target(mesh.next(mesh.opposite(h))))),
                               edge);
        }
    std::sort(found.begin(), found.end());
    for (const auto& [width, edge] : found)
        if (!mesh.is_removed(edge) && creases(edge)) try_zip(edge);
}

// As a flip, and a merge of the two that it links.
bool Fuser::try_zip(Edge edge) {
    SurfaceMesh& mesh = surface_.mesh;
    const Halfedge h = mesh.halfedge(edge), o = mesh.opposite(h);
    const Vertex u = mesh.source(h), v = mesh.target(h);
    const Vertex a = mesh.target(mesh.next(h)), b = mesh.target(mesh.next(o));
    if (a == b || mesh.degree(u) < kLeastDegree || mesh.degree(v) < kLeastDegree) return false;
    // Merged, they must have no neighbours in common but the crease's ends.
    for (const Vertex near : CGAL::vertices_around_target(mesh.halfedge(a), mesh)) {
        if (near == b) return false;
        if (near != u && near != v && mesh.halfedge(near, b) != SurfaceMesh::null_halfedge()) return false;
    }
    change_.clear();
    change_.moved = b;
    change_.to = 0.5 * (surface_.place(a) + surface_.place(b));
    change_.sudden = true;
    const Face f = mesh.face(h), g = mesh.face(o);
    for (const Vertex end : {a, b})
        for (const Face face : CGAL::faces_around_target(mesh.halfedge(end), mesh))
            if (face != f && face != g && !replace(face, {{a, b}})) return false;
    change_.replaced.push_back(f);
    change_.replaced.push_back(g);
    if (contact_.check(change_) != Hold::kFree) return false;
    const DVec3 place = change_.to;
    const Cell cells[2] = {surface_.cells[a], surface_.cells[b]};
    bool links[2];
    const Vertex ends[2] = {u, v};
    for (int k = 0; k < 2; k++)
        links[k] = surface_.links[mesh.edge(mesh.halfedge(a, ends[k]))] ||
                   surface_.links[mesh.edge(mesh.halfedge(b, ends[k]))];
    for (const Face face : change_.replaced)
        contact_.unlist(face);
    CGAL::Euler::flip_edge(h, mesh);
    surface_.links[mesh.edge(h)] = false;
    const Vertex kept = CGAL::Euler::collapse_edge(mesh.edge(h), mesh);
    mesh.point(kept) = place;
    surface_.cells[kept] = cells[1];
    settle(kept, cells[0]);
    for (int k = 0; k < 2; k++)
        surface_.links[mesh.edge(mesh.halfedge(kept, ends[k]))] = links[k];
    for (const Face face : CGAL::faces_around_target(mesh.halfedge(kept), mesh))
        contact_.list(face);
    contact_.look_again_around(kept);
    merged_.emplace_back(kept == b ? a : b, kept);
    return true;
}

}  // namespace treerec::growth
