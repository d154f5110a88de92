#include "growth/outlook.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "growth/triangle_tests.h"

namespace treerec::growth {

namespace {

constexpr uint32_t kRing = 1, kNear = 2, kFound = 3, kSheet = 4;  // above Scratch::stamp
constexpr double kLeft = 0.3;        // share of its area that a face keeps at least while it can't fold over
constexpr double kLooksAhead = 6.0;  // steps for which distances need be exact
constexpr double kNoJoint = std::numeric_limits<double>::max();
constexpr int kTilts = 4;  // of a plane between two faces, to the one that leaves most room

// With corners that move by d at most, a face's cross product of edges a and b becomes another one by no more
// than D = 2 d (|a| + |b|) + 4 d^2: that d, metres, with which D is `spare`.
double way_of(double around, double spare) {
    return 0.25 * (std::sqrt(around * around + 4.0 * spare) - around);
}

// Metres that all corners may move until two faces with a common edge may fold onto one another. Their
// normals turn by asin(D / |a x b|) at most: each may take half of the angle that is left.
double hinge_room(const Outlook::Scratch::Triangle& p, const Outlook::Scratch::Triangle& q) {
    const double cosine = std::clamp(glm::dot(p.normal, q.normal), -1.0, 1.0);
    if (cosine <= kFold) return -1.0;
    const double half_fold[2] = {std::sqrt(0.5 * (1.0 + kFold)), std::sqrt(0.5 * (1.0 - kFold))};
    const double half[2] = {std::sqrt(0.5 * (1.0 + cosine)), std::sqrt(0.5 * (1.0 - cosine))};
    const double sine = std::min(half_fold[1] * half[0] - half_fold[0] * half[1], 1.0 - kLeft);
    return std::min(way_of(p.around, p.area * sine), way_of(q.around, q.area * sine));
}

// Until two faces with one common corner may meet elsewhere, where some plane through it lies between them.
// Half of the metres from it to the others, where that is not `enough`: Frank and Wolfe's way to the point of
// their hull nearest to the corner.
double corner_room(const DVec3 (&off)[4], double enough) {
    DVec3 across = 0.25 * (off[0] + off[1] + off[2] + off[3]);
    double room = -1.0;
    for (int tilt = 0; tilt < kTilts && room < enough; tilt++) {
        const double length = glm::length(across);
        if (!(length > 0.0)) break;
        int nearest = 0;
        double least = glm::dot(off[0], across);
        for (int k = 1; k < 4; k++) {
            const double d = glm::dot(off[k], across);
            if (d >= least) continue;
            least = d;
            nearest = k;
        }
        room = std::max(room, 0.5 * least / length);
        const DVec3 way = off[nearest] - across;
        const double square = glm::dot(way, way);
        if (!(square > 0.0)) break;
        across += way * std::clamp(-glm::dot(across, way) / square, 0.0, 1.0);
    }
    return room - kTouch;
}

// Metres between two sets along a unit vector; negative where they overlap.
double along(const DVec3& unit, const DVec3 (&p)[3], const DVec3 (&q)[3]) {
    const double a[3] = {glm::dot(unit, p[0]), glm::dot(unit, p[1]), glm::dot(unit, p[2])};
    const double b[3] = {glm::dot(unit, q[0]), glm::dot(unit, q[1]), glm::dot(unit, q[2])};
    return std::max(std::min({a[0], a[1], a[2]}) - std::max({b[0], b[1], b[2]}),
                    std::min({b[0], b[1], b[2]}) - std::max({a[0], a[1], a[2]}));
}

// Metres between two faces, at most `most`; never more than it is, and exact only below `enough`.
double least_apart(const Outlook::Scratch::Triangle& p, const Outlook::Scratch::Triangle& q, double enough,
                   double most) {
    enough = std::min(enough, most);
    double widest = along(p.normal, p.corners, q.corners);
    if (widest < enough) widest = std::max(widest, along(q.normal, p.corners, q.corners));
    if (widest < enough) {
        const DVec3 way =
            q.corners[0] + q.corners[1] + q.corners[2] - p.corners[0] - p.corners[1] - p.corners[2];
        widest = std::max(widest, along(normalized_or(way, DVec3(0.0)), p.corners, q.corners));
    }
    if (widest < enough) widest = std::max(widest, triangles_apart(p.corners, q.corners, enough));
    return std::min(widest, most);
}

// Metres that all corners may move until two faces with one or two common corners may meet elsewhere, or fold
// onto one another, exact below `enough`; none: a very large number.
double joint_room(const Outlook::Scratch::Triangle& p, const Outlook::Scratch::Triangle& q, double enough) {
    int at_p[3] = {}, at_q[3] = {}, shared = 0;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            if (p.vertices[i] == q.vertices[j]) {
                at_p[shared] = i;
                at_q[shared++] = j;
                break;
            }
    if (shared == 0) return kNoJoint;
    if (shared == 1) {
        const DVec3& at = p.corners[at_p[0]];
        return corner_room({p.corners[(at_p[0] + 1) % 3] - at, p.corners[(at_p[0] + 2) % 3] - at,
                            at - q.corners[(at_q[0] + 1) % 3], at - q.corners[(at_q[0] + 2) % 3]},
                           enough);
    }
    return shared == 2 ? hinge_room(p, q) : -1.0;
}

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

// A face's cosine to the mean stays above kGraph while D is below |a x b| (cosine - kGraph) / (1 + kGraph).
double Outlook::flat(Vertex vertex, double step, Scratch& scratch) const {
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
            if (!(kLeft * area > least_)) return -1.0;
            const double spare = (glm::dot(across, mean) - kGraph * area) / (1.0 + kGraph);
            if (!(spare > 0.0)) return flat_by_pairs(step, scratch);
            room = std::min(room, way_of(glm::length(a) + glm::length(b), spare));
        }
    return room;
}

// On thin wood a ring's neighbours face all ways; then each pair of faces is asked how long it stays apart.
double Outlook::flat_by_pairs(double step, Scratch& scratch) const {
    scratch.triangles.clear();
    for (const std::vector<Face>* faces : {&scratch.ring, &scratch.near})
        for (const Face face : *faces) {
            Scratch::Triangle& one = scratch.triangles.emplace_back(triangle(face));
            const DVec3 a = one.corners[1] - one.corners[0], b = one.corners[2] - one.corners[0];
            one.area = glm::length(glm::cross(a, b));
            if (!(kLeft * one.area > least_)) return -1.0;
            one.around = glm::length(a) + glm::length(b);
        }
    double room = std::min(kLooksAhead * step, reach_);
    const size_t ring = scratch.ring.size(), all = scratch.triangles.size();
    std::vector<std::pair<uint32_t, uint32_t>>& far = scratch.pairs;
    far.clear();
    for (size_t i = 0; i < ring; i++)
        for (size_t j = i + 1; j < all; j++) {
            const double joint = joint_room(scratch.triangles[i], scratch.triangles[j], room + kTouch);
            if (joint == kNoJoint) far.emplace_back(i, j);
            room = std::min(room, joint);
            if (room < step) return -1.0;
        }
    for (const auto& [i, j] : far) {
        const double apart = 2.0 * room + kTouch;
        room = 0.5 * (least_apart(scratch.triangles[i], scratch.triangles[j], apart, apart) - kTouch);
        if (room < step) return -1.0;
    }
    return room;
}

Outlook::Scratch::Triangle Outlook::triangle(Face face) const {
    Scratch::Triangle one;
    surface_.corners(face, one.vertices);
    for (int k = 0; k < 3; k++)
        one.corners[k] = surface_.place(one.vertices[k]);
    one.normal = surface_.faces[face].normal;
    one.area = one.around = 0.0;
    return one;
}

// Metres from the ring to a face, where that is less than `most`; exact below `enough`. Boxes say little of
// thin wood, round which a ring reaches.
double Outlook::apart(const Scratch& scratch, Face face, double enough, double most) const {
    const Box& box = surface_.faces[face].box;
    const Scratch::Triangle other = triangle(face);
    for (size_t i = 0; i < scratch.ring.size(); i++)
        if (surface_.faces[scratch.ring[i]].box.distance(box) < most)
            most = least_apart(scratch.triangles[i], other, enough, most);
    return most;
}

double Outlook::clear(Vertex vertex, double step, Scratch& scratch) const {
    const DVec3 mean = gather(vertex, scratch);
    const DVec3 middle = surface_.place(vertex);
    Box patch;
    double round = 0.0;
    bool graph = true;
    scratch.triangles.clear();
    for (const Face face : scratch.ring)
        scratch.triangles.push_back(triangle(face));
    for (const Scratch::Triangle& one : scratch.triangles)
        for (const DVec3& corner : one.corners) {
            patch.take(corner);
            round = std::max(round, glm::distance(corner, middle));
        }
    for (const Face face : scratch.ring)
        graph &= glm::dot(surface_.faces[face].normal, mean) > kGraph;
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
    const double enough = 2.0 * kLooksAhead * step;
    for (size_t i = 0; i < scratch.found.size(); i++)
        if (scratch.stamps[scratch.found[i]] == found && scratch.distances[i] < nearest)
            nearest = std::min(
                nearest, std::max(scratch.distances[i], apart(scratch, scratch.found[i], enough, nearest)));
    if (obstacles_) nearest = std::min(nearest, obstacles_->distance(patch, reach_));
    return nearest;
}

}  // namespace treerec::growth
