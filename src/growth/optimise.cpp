#include "growth/optimise.h"

#include <CGAL/boost/graph/Euler_operations.h>
#include <CGAL/boost/graph/properties.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "geometry/parallel.h"
#include "geometry/portable_math.h"

namespace treerec::growth {

namespace {

constexpr double kNearer = 1.0 - 1e-9;  // equation 2: less than rounding is no coming nearer
constexpr double kFlat = 0.94;          // cosine between faces (20 degrees) whose edge may be flipped
constexpr double kBetter = 0.05;        // sine of what a flip must win at least
constexpr size_t kGrain = 1024;
constexpr double kMostAdvance = 2.0;  // longest edges for which one split turns the grain at most
constexpr double kRound = 0.8;        // of young wood's radius: what lies nearer in is rounded off
constexpr int kMostRounds = 20;       // of splits and merges in a step
constexpr double kKeepsSide = 0.2;    // cosine between a face's normals before and after a merge

// Sine and cosine of the angle at the corner opposite to the halfedge, each times `lengths`.
struct Corner {
    double sine, cosine, lengths;
};

Corner corner(const Surface& surface, Halfedge h) {
    const SurfaceMesh& mesh = surface.mesh;
    const DVec3 at = surface.place(mesh.target(mesh.next(h)));
    const DVec3 a = surface.place(mesh.target(h)) - at, b = surface.place(mesh.source(h)) - at;
    return {glm::length(glm::cross(a, b)), glm::dot(a, b), std::sqrt(glm::dot(a, a) * glm::dot(b, b))};
}

}  // namespace

bool Optimiser::nearer_tip(int32_t a, int32_t b) const {
    return plan_.branches[static_cast<size_t>(a)].first_step() >
           plan_.branches[static_cast<size_t>(b)].first_step();
}

// Of a vertex whose edges are new or of another length.
void Optimiser::changed_around(Vertex vertex) {
    SurfaceMesh& mesh = surface_.mesh;
    for (const Halfedge h : CGAL::halfedges_around_target(mesh.halfedge(vertex), mesh)) {
        const Edge edge = mesh.edge(h);
        const double length = surface_.length(edge);
        if (length > longest_) long_.push_back(edge);
        if (length < shortest_) short_.push_back(edge);
    }
    contact_.look_again_around(vertex);
}

bool Optimiser::linked(Vertex vertex) const {
    for (const Halfedge h : CGAL::halfedges_around_target(surface_.mesh.halfedge(vertex), surface_.mesh))
        if (surface_.links[surface_.mesh.edge(h)]) return true;
    return false;
}

void Optimiser::run() {
    merged_.clear();
    scan();
    settle();
    round_tips();
    flip_all();
    settle();
}

// Finds what is too long or short.
void Optimiser::scan() {
    const SurfaceMesh& mesh = surface_.mesh;
    struct Found {
        std::vector<Edge> too_long, too_short;
    };
    std::vector<Found> found((mesh.num_edges() + kGrain - 1) / kGrain);
    parallel_for(mesh.num_edges(), kGrain, [&](size_t begin, size_t end) {
        Found& own = found[begin / kGrain];
        for (size_t i = begin; i < end; i++) {
            const Edge edge(static_cast<uint32_t>(i));
            if (mesh.is_removed(edge)) continue;
            const double length = surface_.length(edge);
            if (length > longest_) own.too_long.push_back(edge);
            if (length < shortest_) own.too_short.push_back(edge);
        }
    });
    long_.clear();
    short_.clear();
    for (const Found& some : found) {
        long_.insert(long_.end(), some.too_long.begin(), some.too_long.end());
        short_.insert(short_.end(), some.too_short.begin(), some.too_short.end());
    }
}

// Until nothing is too long and nothing can be merged any more; then the last round's counts are final.
void Optimiser::settle() {
    for (int round = 0; round < kMostRounds; round++) {
        split_long();
        if (merge_short() == 0) return;
    }
    split_long();
}

void Optimiser::split_long() {
    std::vector<std::pair<double, Edge>> queue;
    while (!long_.empty()) {
        queue.clear();
        for (const Edge edge : long_) {
            if (surface_.mesh.is_removed(edge)) continue;
            const double length = surface_.length(edge);
            if (length > longest_) queue.emplace_back(-length, edge);
        }
        std::sort(queue.begin(), queue.end());
        queue.erase(std::unique(queue.begin(), queue.end()), queue.end());
        long_.clear();
        for (const auto& [length, edge] : queue)
            split(edge);
    }
}

// Table 1.
void Optimiser::split(Edge edge) {
    SurfaceMesh& mesh = surface_.mesh;
    const Halfedge h = mesh.halfedge(edge);
    const Vertex i = mesh.source(h), j = mesh.target(h);
    const Cell a = surface_.cells[i], b = surface_.cells[j];
    const DVec3 place = 0.5 * (surface_.place(i) + surface_.place(j));
    // From an apical vertex to a linked one the new one is linked, too (Mizoguchi and Miyata 2014, 6.3).
    const bool link = surface_.links[edge] ||
                      (a.tissue == Tissue::kApical && b.tissue == Tissue::kCambium && linked(j)) ||
                      (b.tissue == Tissue::kApical && a.tissue == Tissue::kCambium && linked(i));
    const Halfedge made = CGAL::Euler::split_edge(h, mesh);
    const Vertex v = mesh.target(made);
    mesh.point(v) = place;
    surface_.links[mesh.edge(made)] = link;
    const Halfedge back = mesh.opposite(h);
    for (const Halfedge side : {CGAL::Euler::split_face(made, mesh.next(h), mesh),
                                CGAL::Euler::split_face(back, mesh.next(mesh.opposite(made)), mesh)})
        surface_.links[mesh.edge(side)] = false;
    Cell cell;
    cell.id = surface_.next_id++;
    cell.previous = 0.5 * (a.previous + b.previous);
    cell.excess = 0.5 * (a.excess + b.excess);
    const bool decayed = a.tissue == Tissue::kDecayed || b.tissue == Tissue::kDecayed;
    const bool apical = a.tissue == Tissue::kApical || b.tissue == Tissue::kApical;
    cell.tissue = decayed && !apical ? Tissue::kDecayed : Tissue::kCambium;
    if (cell.tissue == Tissue::kDecayed) cell.hollow = a.tissue == Tissue::kDecayed ? a.hollow : b.hollow;
    // New cambium belongs to its apical vertex's branch, else to the one nearer the tip (Mizoguchi and Miyata
    // 2014, 9).
    const Cell& elder = a.owner == b.owner || nearer_tip(a.owner, b.owner) ? a : b;
    const Cell& by = a.tissue == Tissue::kApical ? a : b.tissue == Tissue::kApical ? b : elder;
    cell.owner = by.owner;
    cell.speed = 0.5 * (a.speed + b.speed);
    if (a.owner == b.owner) {
        cell.along = 0.5 * (a.along + b.along);
    } else {
        const double begin = plan_.branches[static_cast<size_t>(by.owner)].axis.front().along;
        const bool tip = by.tissue == Tissue::kApical;
        const double back = tip ? 0.5 * glm::distance(surface_.place(i), surface_.place(j)) : 0.0;
        cell.along = std::max(by.along - back, begin);
    }
    cell.sunk = 0.5 * (a.sunk + b.sunk);
    // Where the link goes on from an apical vertex, its other end tells since when.
    const Cell& last = a.tissue == Tissue::kApical ? b : a;
    const double since = last.owner == by.owner ? last.tip_along : by.along - surface_.length(edge) * 2.0;
    cell.tip_along = apical ? by.along : 0.5 * (a.tip_along + b.tip_along);
    surface_.cells[v] = cell;
    for (const Face face : CGAL::faces_around_target(mesh.halfedge(v), mesh))
        contact_.list(face);
    changed_around(v);
    if (apical && a.tissue != b.tissue) twist(v, a.tissue == Tissue::kApical ? i : j, since);
}

void Optimiser::round_tips() {
    if (!plan_.follow) return;
    const SurfaceMesh& mesh = surface_.mesh;
    for (const Vertex v : mesh.vertices())
        if (surface_.cells[v].tissue == Tissue::kApical) round_off(v);
}

// Half as thick at each split, what a fast tip leaves behind would be a thread, or flat, without inside: it
// could not bend. So the ring around it is as thick at once as young wood is, and round. Where there is no
// room, not.
void Optimiser::round_off(Vertex apical) {
    const SurfaceMesh& mesh = surface_.mesh;
    const Cell& tip = surface_.cells[apical];
    ring_.clear();
    for (const Vertex v : CGAL::vertices_around_target(mesh.halfedge(apical), mesh)) {
        const Cell& cell = surface_.cells[v];
        if (cell.tissue != Tissue::kCambium || cell.owner != tip.owner || cell.bud >= 0) return;
        ring_.push_back(v);
    }
    DVec3 centre(0.0);
    for (const Vertex v : ring_)
        centre += surface_.place(v) / static_cast<double>(ring_.size());
    const DVec3 way = normalized_or(surface_.place(apical) - centre, DVec3(0.0));
    if (way == DVec3(0.0)) return;
    const AxisPlace axis = place_at(plan_.branches[static_cast<size_t>(tip.owner)], tip.along);
    const double young = std::min(plan_.young, axis.radius);
    const DVec3 x = any_perpendicular(way), y = glm::cross(way, x);
    // By which turn an even ring lies nearest to this one. CGAL goes about a vertex clockwise.
    const double part = -2.0 * kPi / static_cast<double>(ring_.size());
    double along_x = 0.0, along_y = 0.0, least = young;
    for (size_t i = 0; i < ring_.size(); i++) {
        const DVec3 off = surface_.place(ring_[i]) - centre;
        const double u = glm::dot(off, x), w = glm::dot(off, y);
        const SineCosine turn = portable_sine_cosine(part * static_cast<double>(i));
        along_x += u * turn.cosine + w * turn.sine;
        along_y += w * turn.cosine - u * turn.sine;
        least = std::min(least, u * u + w * w < young * young ? std::sqrt(u * u + w * w) : young);
    }
    const double length = std::sqrt(along_x * along_x + along_y * along_y);
    if (!(length > 0.0) || least > kRound * young) return;
    const DVec3 first = (along_x * x + along_y * y) / length, second = glm::cross(way, first);
    for (size_t i = 0; i < ring_.size(); i++) {
        const SineCosine turn = portable_sine_cosine(part * static_cast<double>(i));
        const DVec3 place = surface_.place(ring_[i]);
        const DVec3 to =
            centre + way * glm::dot(place - centre, way) + young * (first * turn.cosine + second * turn.sine);
        if (contact_.move(ring_[i], to, true) == Hold::kFree) changed_around(ring_[i]);
    }
}

// Equation 7: by what the tip has advanced since the link was last split. Where there is no room, not.
void Optimiser::twist(Vertex vertex, Vertex apical, double since) {
    if (plan_.twist == 0.0) return;
    const Cell& tip = surface_.cells[apical];
    const double angle = plan_.twist * std::clamp(tip.along - since, 0.0, kMostAdvance * longest_);
    const DVec3 axis = place_at(plan_.branches[static_cast<size_t>(tip.owner)], tip.along).direction;
    const DVec3 off = surface_.place(vertex) - surface_.place(apical);
    const DVec3 high = axis * glm::dot(off, axis), flat = off - high;
    const SineCosine turn = portable_sine_cosine(angle);
    const DVec3 to = surface_.place(apical) + high + flat * turn.cosine + glm::cross(axis, flat) * turn.sine;
    if (contact_.move(vertex, to, true) == Hold::kFree) changed_around(vertex);
}

size_t Optimiser::merge_short() {
    SurfaceMesh& mesh = surface_.mesh;
    short_edges_ = {};
    std::vector<std::tuple<double, uint32_t, uint32_t, Edge>> queue;
    std::sort(short_.begin(), short_.end());
    short_.erase(std::unique(short_.begin(), short_.end()), short_.end());
    std::erase_if(short_,
                  [&](Edge edge) { return mesh.is_removed(edge) || surface_.length(edge) >= shortest_; });
    for (const Edge edge : short_) {
        const double length = surface_.length(edge);
        const uint32_t a = surface_.cells[mesh.vertex(edge, 0)].id,
                       b = surface_.cells[mesh.vertex(edge, 1)].id;
        queue.emplace_back(length, std::min(a, b), std::max(a, b), edge);
    }
    std::sort(queue.begin(), queue.end());
    size_t merges = 0;
    for (const auto& [length, low, high, edge] : queue) {
        if (mesh.is_removed(edge)) continue;
        const Vertex i = mesh.vertex(edge, 0), j = mesh.vertex(edge, 1);
        const Cell &a = surface_.cells[i], &b = surface_.cells[j];
        if (surface_.length(edge) >= shortest_) continue;
        const bool stays_a = a.tissue == Tissue::kApical || a.bud >= 0;
        const bool stays_b = b.tissue == Tissue::kApical || b.bud >= 0;
        if (stays_a && stays_b) {
            short_edges_.apical++;
        } else if (surface_.length(edge) >= kNearer * glm::distance(a.previous, b.previous)) {
            short_edges_.parting++;
        } else if (!CGAL::Euler::does_satisfy_link_condition(edge, mesh)) {
            short_edges_.link++;
        } else {
            const Hold hold = try_merge(edge);
            if (hold == Hold::kFold) short_edges_.fold++;
            if (hold == Hold::kSurface || hold == Hold::kObstacle) short_edges_.contact++;
            if (hold == Hold::kFree) merges++;
        }
    }
    short_edges_.unexplained = merges;
    return merges;
}

// Table 2.
Hold Optimiser::try_merge(Edge edge) {
    SurfaceMesh& mesh = surface_.mesh;
    const Halfedge h = mesh.halfedge(edge);
    const Vertex i = mesh.source(h), j = mesh.target(h);  // j stays
    const Cell a = surface_.cells[i], b = surface_.cells[j];
    Cell cell = b;
    DVec3 place = 0.5 * (surface_.place(i) + surface_.place(j));
    const auto weight = [](const Cell& c) {
        return c.tissue == Tissue::kApical ? 3 : c.bud >= 0 ? 2 : c.tissue == Tissue::kCambium ? 1 : 0;
    };
    if (weight(a) != weight(b)) {
        const bool first = weight(a) > weight(b);
        cell = first ? a : b;
        if (weight(a) >= 2 || weight(b) >= 2 || a.tissue != b.tissue) place = surface_.place(first ? i : j);
    } else {
        cell = nearer_tip(a.owner, b.owner) ? a : b;
        if (a.owner == b.owner) cell.along = 0.5 * (a.along + b.along);
        cell.excess = 0.5 * (a.excess + b.excess);
        cell.sunk = 0.5 * (a.sunk + b.sunk);
        cell.previous = 0.5 * (a.previous + b.previous);
        cell.id = std::min(a.id, b.id);
    }
    cell.centre = a.centre || b.centre;
    cell.touched = std::max(a.touched, b.touched);
    change_.clear();
    change_.moved = j;
    change_.to = place;
    change_.sudden = true;
    for (const Vertex end : {i, j})
        for (const Face face : CGAL::faces_around_target(mesh.halfedge(end), mesh)) {
            if (face == mesh.face(h) || face == mesh.face(mesh.opposite(h))) {
                if (end == j) change_.replaced.push_back(face);
                continue;
            }
            std::array<Vertex, 3> made;
            Vertex corners[3];
            surface_.corners(face, corners);
            for (size_t k = 0; k < 3; k++)
                made[k] = corners[k] == i ? j : corners[k];
            DVec3 p[3];
            for (size_t k = 0; k < 3; k++)
                p[k] = made[k] == j ? place : surface_.place(made[k]);
            const DVec3 normal = normalized_or(glm::cross(p[1] - p[0], p[2] - p[0]), DVec3(0.0));
            if (glm::dot(normal, surface_.faces[face].normal) < kKeepsSide) return Hold::kFold;
            change_.made.push_back(made);
            change_.replaced.push_back(face);
        }
    const Hold hold = contact_.check(change_);
    if (hold != Hold::kFree) return hold;
    for (const Face face : change_.replaced)
        contact_.unlist(face);
    const auto went_with = [&](Halfedge side) {  // edges that two become one of
        return surface_.links[mesh.edge(mesh.next(side))] || surface_.links[mesh.edge(mesh.prev(side))];
    };
    const bool link = went_with(h), other_link = went_with(mesh.opposite(h));
    const Vertex opposite = mesh.target(mesh.next(h)),
                 other_opposite = mesh.target(mesh.next(mesh.opposite(h)));
    const Vertex kept = CGAL::Euler::collapse_edge(edge, mesh);
    mesh.point(kept) = place;
    surface_.cells[kept] = cell;
    surface_.links[mesh.edge(mesh.halfedge(kept, opposite))] = link;
    surface_.links[mesh.edge(mesh.halfedge(kept, other_opposite))] = other_link;
    for (const Face face : CGAL::faces_around_target(mesh.halfedge(kept), mesh))
        contact_.list(face);
    changed_around(kept);
    merged_.emplace_back(kept == j ? i : j, kept);
    return Hold::kFree;
}

void Optimiser::flip_all() {
    const SurfaceMesh& mesh = surface_.mesh;
    std::vector<std::vector<Edge>> found((mesh.num_edges() + kGrain - 1) / kGrain);
    parallel_for(mesh.num_edges(), kGrain, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; i++) {
            const Edge edge(static_cast<uint32_t>(i));
            if (!mesh.is_removed(edge) && may_flip(edge)) found[begin / kGrain].push_back(edge);
        }
    });
    for (const std::vector<Edge>& edges : found)
        for (const Edge edge : edges)
            if (may_flip(edge)) try_flip(edge);
}

// Where the angles opposite to it are more than half a round together, and it lies in the plane.
bool Optimiser::may_flip(Edge edge) const {
    const SurfaceMesh& mesh = surface_.mesh;
    if (surface_.links[edge]) return false;
    const Halfedge h = mesh.halfedge(edge), o = mesh.opposite(h);
    const Corner a = corner(surface_, h), b = corner(surface_, o);
    if (a.cosine >= 0.0 && b.cosine >= 0.0) return false;
    // The sine of the sum.
    if (a.sine * b.cosine + a.cosine * b.sine >= -kBetter * a.lengths * b.lengths) return false;
    return glm::dot(surface_.faces[mesh.face(h)].normal, surface_.faces[mesh.face(o)].normal) >= kFlat;
}

// Towards Delaunay, where it changes no shape.
bool Optimiser::try_flip(Edge edge) {
    SurfaceMesh& mesh = surface_.mesh;
    const Halfedge h = mesh.halfedge(edge), o = mesh.opposite(h);
    const Face f = mesh.face(h), g = mesh.face(o);
    const Vertex i = mesh.source(h), j = mesh.target(h);
    const Vertex x = mesh.target(mesh.next(h)), y = mesh.target(mesh.next(o));
    const double length = glm::distance(surface_.place(x), surface_.place(y));
    if (length > longest_ || length < shortest_) return false;
    if (mesh.halfedge(x, y) != SurfaceMesh::null_halfedge()) return false;
    if (mesh.degree(i) <= 3 || mesh.degree(j) <= 3) return false;
    change_.clear();
    change_.sudden = true;
    change_.made = {{x, y, j}, {y, x, i}};
    change_.replaced = {f, g};
    for (const std::array<Vertex, 3>& made : change_.made) {
        const DVec3 p[3] = {surface_.place(made[0]), surface_.place(made[1]), surface_.place(made[2])};
        const DVec3 normal = normalized_or(glm::cross(p[1] - p[0], p[2] - p[0]), DVec3(0.0));
        if (glm::dot(normal, surface_.faces[f].normal) < kFlat ||
            glm::dot(normal, surface_.faces[g].normal) < kFlat)
            return false;
    }
    if (contact_.check(change_) != Hold::kFree) return false;
    contact_.unlist(f);
    contact_.unlist(g);
    CGAL::Euler::flip_edge(h, mesh);
    contact_.list(f);
    contact_.list(g);
    for (const Vertex v : {i, j, x, y})
        contact_.look_again(v);
    return true;
}

}  // namespace treerec::growth
