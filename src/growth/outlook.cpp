#include "growth/outlook.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "growth/triangle_tests.h"

namespace treerec::growth {

namespace {

constexpr uint32_t kRing = 1, kNear = 2, kFound = 3, kSheet = 4;  // above Scratch::stamp
constexpr double kLeft = 0.3;  // share of its area that a face keeps at least while it can't fold over

}  // namespace

// The faces around the vertex, and those that touch them. Their mean normal.
DVec3 Outlook::gather(Vertex vertex, Scratch& scratch) const {
    const SurfaceMesh& mesh = surface_.mesh;
    if (scratch.stamps.size() < mesh.num_faces()) scratch.stamps.resize(mesh.num_faces(), 0);
    if (scratch.stamp > std::numeric_limits<uint32_t>::max() - 2 * kSheet) {
        std::fill(scratch.stamps.begin(), scratch.stamps.end(), 0);
        scratch.stamp = 0;
    }
    scratch.stamp += kSheet;
    scratch.ring.clear();
    scratch.near.clear();
    DVec3 mean(0.0);
    const Halfedge first = mesh.halfedge(vertex);
    Halfedge h = first;
    do {
        const Face face = mesh.face(h);
        scratch.stamps[face] = scratch.stamp + kRing;
        scratch.ring.push_back(face);
        mean += surface_.faces[face].normal;
        h = mesh.opposite(mesh.next(h));
    } while (h != first);
    do {
        const Halfedge begin = mesh.opposite(h);
        Halfedge other = begin;
        do {
            const Face face = mesh.face(other);
            if (scratch.stamps[face] <= scratch.stamp) {
                scratch.stamps[face] = scratch.stamp + kNear;
                scratch.near.push_back(face);
            }
            other = mesh.opposite(mesh.next(other));
        } while (other != begin);
        h = mesh.opposite(mesh.next(h));
    } while (h != first);
    return normalized_or(mean, DVec3(0.0));
}

// With corners that move by d at most, a face's cross product of edges a and b becomes another one by no more
// than D = 2 d (|a| + |b|) + 4 d^2: its cosine to the mean stays above kGraph while D is below
// |a x b| (cosine - kGraph) / (1 + kGraph).
double Outlook::flat(Vertex vertex, Scratch& scratch) const {
    const DVec3 mean = gather(vertex, scratch);
    double room = reach_;
    for (const std::vector<Face>* faces : {&scratch.ring, &scratch.near})
        for (const Face face : *faces) {
            Vertex v[3];
            surface_.corners(face, v);
            const DVec3 a = surface_.place(v[1]) - surface_.place(v[0]),
                        b = surface_.place(v[2]) - surface_.place(v[0]);
            const DVec3 across = glm::cross(a, b);
            const double area = glm::length(across);
            const double spare = (glm::dot(across, mean) - kGraph * area) / (1.0 + kGraph);
            if (!(spare > 0.0 && kLeft * area > least_)) return -1.0;
            const double around = glm::length(a) + glm::length(b);
            room = std::min(room, 0.25 * (std::sqrt(around * around + 4.0 * spare) - around));
        }
    return room;
}

// Metres from the ring to a face, where that is less than `most`. Boxes say little of thin wood, round which
// a ring reaches.
double Outlook::apart(const Scratch& scratch, Face face, double most) const {
    Vertex v[3];
    surface_.corners(face, v);
    const DVec3 q[3] = {surface_.place(v[0]), surface_.place(v[1]), surface_.place(v[2])};
    const Box box = surface_.box(face);
    for (const Face own : scratch.ring) {
        if (surface_.box(own).distance(box) >= most) continue;
        surface_.corners(own, v);
        const DVec3 p[3] = {surface_.place(v[0]), surface_.place(v[1]), surface_.place(v[2])};
        most = std::min(most, triangles_apart(p, q));
    }
    return most;
}

double Outlook::clear(Vertex vertex, Scratch& scratch) const {
    const DVec3 mean = gather(vertex, scratch);
    const DVec3 middle = surface_.place(vertex);
    Box patch;
    double round = 0.0;
    bool graph = true;
    for (const Face face : scratch.ring) {
        Vertex v[3];
        surface_.corners(face, v);
        for (const Vertex corner : v) {
            patch.take(surface_.place(corner));
            round = std::max(round, glm::distance(surface_.place(corner), middle));
        }
        graph &= glm::dot(surface_.faces[face].normal, mean) > kGraph;
    }
    scratch.found.clear();
    scratch.distances.clear();
    const uint32_t found = scratch.stamp + kFound, sheet = scratch.stamp + kSheet;
    grid_.visit(middle, round + reach_, [&](uint32_t item) {
        const Face face(item);
        if (scratch.stamps[face] > scratch.stamp) return;
        const double distance = surface_.least_distance(face, patch, middle, round);
        if (distance >= reach_) return;
        scratch.stamps[face] = found;
        scratch.found.push_back(face);
        scratch.distances.push_back(distance);
    });
    if (graph) {  // as Contact::leave_own_sheet
        const SurfaceMesh& mesh = surface_.mesh;
        scratch.sheet = scratch.near;
        while (!scratch.sheet.empty()) {
            Halfedge h = mesh.halfedge(scratch.sheet.back());
            scratch.sheet.pop_back();
            for (int side = 0; side < 3; side++, h = mesh.next(h)) {
                const Face next = mesh.face(mesh.opposite(h));
                if (scratch.stamps[next] != found || glm::dot(surface_.faces[next].normal, mean) <= kGraph)
                    continue;
                scratch.stamps[next] = sheet;
                scratch.sheet.push_back(next);
            }
        }
    }
    double nearest = reach_;
    for (size_t i = 0; i < scratch.found.size(); i++)
        if (scratch.stamps[scratch.found[i]] == found && scratch.distances[i] < nearest)
            nearest =
                std::min(nearest, std::max(scratch.distances[i], apart(scratch, scratch.found[i], nearest)));
    if (obstacles_) nearest = std::min(nearest, obstacles_->distance(patch, reach_));
    return nearest;
}

}  // namespace treerec::growth
