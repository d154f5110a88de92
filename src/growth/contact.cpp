#include "growth/contact.h"

#include <CGAL/boost/graph/iterator.h>

#include <algorithm>
#include <cmath>

#include "geometry/parallel.h"
#include "growth/triangle_tests.h"

namespace treerec::growth {

namespace {

constexpr double kCell = 2.5;    // of the longest edge
constexpr double kReach = 0.5;   // of the longest edge
constexpr double kMargin = 0.1;  // of the longest edge
constexpr double kGap = 1e-3;    // of the longest edge
// Of the reach, squared: twice the area of the least face.
constexpr double kLeastFace = 1e-7;
constexpr double kSameSide =
    0.5;  // cosine to a patch's normal up to which a face of its sheet need not look again
constexpr size_t kGrain = 256;

double volume(const DVec3& a, const DVec3& b, const DVec3& c, const DVec3& d) {
    return glm::dot(glm::cross(b - a, c - a), d - a);
}

}  // namespace

Contact::Contact(Surface& surface, double longest, const Obstacles* obstacles)
    : surface_(surface),
      obstacles_(obstacles && !obstacles->empty() ? obstacles : nullptr),
      grid_(kCell * longest),
      reach_(kReach * longest),
      margin_(kMargin * longest),
      gap_(kGap * longest),
      outlook_(surface, grid_, obstacles_, reach_, kLeastFace * reach_ * reach_) {}

void Contact::list_all() {
    for (const Face face : surface_.mesh.faces())
        list(face);
}

bool Contact::holds(Face face) const {
    const FaceCell& cell = surface_.faces[face];
    Vertex v[3];
    surface_.corners(face, v);
    return std::all_of(v, v + 3, [&](Vertex corner) {
        const DVec3 off = surface_.place(corner) - cell.middle;
        return glm::dot(off, off) <= cell.round * cell.round;
    });
}

void Contact::list(Face face, const DVec3& normal) {
    FaceCell& cell = surface_.faces[face];
    cell.normal = normal;
    surface_.measure(face);
    if (cell.listed && holds(face)) return;
    if (cell.listed) grid_.remove(face, cell.middle);
    Vertex v[3];
    surface_.corners(face, v);
    cell.middle = (surface_.place(v[0]) + surface_.place(v[1]) + surface_.place(v[2])) / 3.0;
    cell.round = 0.0;
    for (const Vertex corner : v)
        cell.round = std::max(cell.round, glm::distance(surface_.place(corner), cell.middle));
    cell.round += margin_;
    cell.listed = true;
    grid_.add(face, cell.middle, cell.round);
}

void Contact::unlist(Face face) {
    FaceCell& cell = surface_.faces[face];
    if (!cell.listed) return;
    grid_.remove(face, cell.middle);
    cell.listed = false;
}

void Contact::advance(double most) {
    most_ = most;
    odometer_ += most;
}

void Contact::look_ahead() {
    const SurfaceMesh& mesh = surface_.mesh;
    parallel_for(mesh.num_vertices(), kGrain, [&](size_t begin, size_t end) {
        std::unique_ptr<Outlook::Scratch> scratch;
        {
            const std::lock_guard lock(scratches_mutex_);
            if (!scratches_.empty()) {
                scratch = std::move(scratches_.back());
                scratches_.pop_back();
            }
        }
        if (!scratch) scratch = std::make_unique<Outlook::Scratch>();
        for (size_t i = begin; i < end; i++) {
            const Vertex v(static_cast<uint32_t>(i));
            if (mesh.is_removed(v)) continue;
            Cell& cell = surface_.cells[v];
            if (cell.tissue == Tissue::kApical || cell.velocity == DVec3(0.0)) continue;
            if (cell.flat_until < odometer_)
                cell.flat_until = odometer_ - most_ + outlook_.flat(v, most_, *scratch);
            if (cell.safe_until < odometer_) cell.safe_until = until(outlook_.clear(v, most_, *scratch));
        }
        const std::lock_guard lock(scratches_mutex_);
        scratches_.push_back(std::move(scratch));
    });
    // Tips move by more than the odometer tells.
    for (const Vertex v : mesh.vertices())
        if (surface_.cells[v].tissue == Tissue::kApical)
            for (const Vertex other : CGAL::vertices_around_target(mesh.halfedge(v), mesh))
                for (const Vertex near : CGAL::vertices_around_target(mesh.halfedge(other), mesh))
                    surface_.cells[near].flat_until = -1.0;
}

void Contact::follow() {
    const SurfaceMesh& mesh = surface_.mesh;
    std::vector<std::vector<Face>> gone((mesh.num_faces() + kGrain - 1) / kGrain);
    parallel_for(mesh.num_faces(), kGrain, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; i++) {
            const Face face(static_cast<uint32_t>(i));
            if (mesh.is_removed(face)) continue;
            surface_.faces[face].normal = surface_.normal_of(face);
            surface_.measure(face);
            if (!holds(face)) gone[begin / kGrain].push_back(face);
        }
    });
    for (const std::vector<Face>& faces : gone)
        for (const Face face : faces)
            list(face, surface_.faces[face].normal);
}

void Contact::look_again(Vertex vertex) {
    surface_.cells[vertex].safe_until = -1.0;
    surface_.cells[vertex].flat_until = -1.0;
    for (const Vertex other : CGAL::vertices_around_target(surface_.mesh.halfedge(vertex), surface_.mesh))
        surface_.cells[other].flat_until = -1.0;
}

void Contact::look_again_around(Vertex vertex) {
    look_again(vertex);
    for (const Vertex other : CGAL::vertices_around_target(surface_.mesh.halfedge(vertex), surface_.mesh))
        look_again(other);
}

Hold Contact::move(Vertex vertex, const DVec3& to, bool sudden) {
    SurfaceMesh& mesh = surface_.mesh;
    moving_.clear();
    moving_.moved = vertex;
    moving_.to = to;
    moving_.swept = true;
    moving_.sudden = sudden || surface_.cells[vertex].tissue == Tissue::kApical;
    const Halfedge first = mesh.halfedge(vertex);
    Halfedge h = first;
    do {
        moving_.made.push_back({vertex, mesh.target(mesh.next(h)), mesh.source(h)});
        moving_.replaced.push_back(mesh.face(h));
        h = mesh.opposite(mesh.next(h));
    } while (h != first);
    const Hold hold = check(moving_);
    if (hold != Hold::kFree) return hold;
    mesh.point(vertex) = to;
    for (size_t i = 0; i < moving_.replaced.size(); i++)
        list(moving_.replaced[i], normals_[i]);
    return Hold::kFree;
}

Hold Contact::check(const Change& change) {
    normals_.clear();
    for (const std::array<Vertex, 3>& made : change.made) {
        const DVec3 a = place(change, made[0]), b = place(change, made[1]), c = place(change, made[2]);
        const DVec3 across = glm::cross(b - a, c - a);
        const double area = glm::length(across);
        if (!(area > kLeastFace * reach_ * reach_)) return Hold::kFold;
        normals_.push_back(across / area);
    }
    stamp_++;
    for (const Face face : change.replaced)
        surface_.faces[face].stamp = stamp_;
    near_.clear();
    const SurfaceMesh& mesh = surface_.mesh;
    for (const std::array<Vertex, 3>& made : change.made)
        for (const Vertex corner : made) {
            // Of a vertex's own faces, each corner is the second of one.
            if (corner == change.moved || (change.swept && corner != made[1])) continue;
            const Halfedge first = mesh.halfedge(corner);
            if (first == SurfaceMesh::null_halfedge()) continue;  // about to be put in
            Halfedge h = first;
            do {
                const Face face = mesh.face(h);
                if (surface_.faces[face].stamp != stamp_) {
                    surface_.faces[face].stamp = stamp_;
                    near_.push_back(face);
                }
                h = mesh.opposite(mesh.next(h));
            } while (h != first);
        }
    const Hold hold = check_near(change, normals_);
    if (hold != Hold::kFree) return hold;
    if (!change.sudden && change.swept && surface_.cells[change.moved].safe_until >= odometer_)
        return Hold::kFree;
    const Hold far = check_far(change);
    if (far == Hold::kFree && change.sudden) warn_others();
    return far;
}

// Of a change that is to be made: who is near it may not be safe as long as it thought.
void Contact::warn_others() {
    DVec3 mean(0.0);
    for (const DVec3& normal : normals_)
        mean += normal;
    mean = normalized_or(mean, DVec3(0.0));
    for (size_t i = 0; i < found_.size(); i++) {
        const FaceCell& cell = surface_.faces[found_[i]];
        const bool sheet = cell.stamp == stamp_;
        if (sheet && glm::dot(cell.normal, mean) > kSameSide) continue;
        Vertex corners[3];
        surface_.corners(found_[i], corners);
        for (const Vertex corner : corners) {
            double& safe = surface_.cells[corner].safe_until;
            safe = std::min(safe, until(distances_[i]));
        }
    }
}

Hold Contact::check_near(const Change& change, const std::vector<DVec3>& normals) {
    DVec3 mean(0.0);
    for (const DVec3& normal : normals)
        mean += normal;
    mean = normalized_or(mean, DVec3(0.0));
    // A patch that stands above one plane all over.
    const auto graph = [&](const DVec3& normal) { return glm::dot(normal, mean) > kGraph; };
    if (std::all_of(normals.begin(), normals.end(), graph) &&
        std::all_of(near_.begin(), near_.end(), [&](Face f) { return graph(surface_.faces[f].normal); }))
        return Hold::kFree;
    for (size_t a = 0; a < change.made.size(); a++)
        for (size_t b = a + 1; b < change.made.size(); b++)
            if (made_meet(change, a, b, normals)) return Hold::kFold;
    for (size_t a = 0; a < change.made.size(); a++)
        for (const Face face : near_)
            if (pair_meets(change, change.made[a], normals[a], face)) return Hold::kFold;
    return Hold::kFree;
}

namespace {

// Faces by their corners; shared: how many, the shared ones first in both.
struct Pair {
    DVec3 p[3], q[3];
    int shared = 0;
};

template <typename PlaceP, typename PlaceQ>
Pair match(const std::array<Vertex, 3>& a, const std::array<Vertex, 3>& b, PlaceP place_a, PlaceQ place_b) {
    Pair pair;
    bool a_used[3] = {}, b_used[3] = {};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            if (!b_used[j] && !a_used[i] && a[i] == b[j]) {
                a_used[i] = b_used[j] = true;
                pair.p[pair.shared] = place_a(a[i]);
                pair.q[pair.shared] = place_b(b[j]);
                pair.shared++;
            }
    int at_p = pair.shared, at_q = pair.shared;
    for (int i = 0; i < 3; i++) {
        if (!a_used[i]) pair.p[at_p++] = place_a(a[i]);
        if (!b_used[i]) pair.q[at_q++] = place_b(b[i]);
    }
    return pair;
}

bool corner_meets(const Pair& pair) {
    const DVec3 p_edge[2] = {pair.p[1], pair.p[2]}, q_edge[2] = {pair.q[1], pair.q[2]};
    return segment_meets_triangle(q_edge, pair.p, kTouch) || segment_meets_triangle(p_edge, pair.q, kTouch);
}

}  // namespace

bool Contact::made_meet(const Change& change, size_t a, size_t b, const std::vector<DVec3>& normals) {
    const auto at = [&](Vertex v) { return place(change, v); };
    const Pair pair = match(change.made[a], change.made[b], at, at);
    if (pair.shared == 2) return glm::dot(normals[a], normals[b]) < kFold;
    if (pair.shared == 1) return corner_meets(pair);
    return pair.shared == 3 || triangles_meet(pair.p, pair.q, kTouch);
}

bool Contact::pair_meets(const Change& change, const std::array<Vertex, 3>& made, const DVec3& normal,
                         Face face) {
    std::array<Vertex, 3> other;
    Vertex corners[3];
    surface_.corners(face, corners);
    std::copy(corners, corners + 3, other.begin());
    const auto now = [&](Vertex v) { return place(change, v); };
    const auto still = [&](Vertex v) { return surface_.place(v); };
    const Pair pair = match(made, other, now, still);
    if (pair.shared == 3) return true;
    if (pair.shared == 2) {
        const double cosine = glm::dot(normal, surface_.faces[face].normal);
        if (cosine < kFold) return true;
        if (!change.swept) return false;
        // Through one another: both faces' far corners lie near one plane and change sides.
        if (cosine > 0.0) return false;
        const DVec3 before = surface_.place(change.moved);
        if (glm::distance(change.to, pair.p[2]) > 0.0) return false;
        return volume(pair.p[0], pair.p[1], pair.q[2], before) *
                   volume(pair.p[0], pair.p[1], pair.q[2], pair.p[2]) <
               0.0;
    }
    Box p, q;
    for (int i = 0; i < 3; i++) {
        p.take(pair.p[i]);
        q.take(pair.q[i]);
    }
    if (!p.grown(kTouch).meets(q)) return false;
    return pair.shared == 1 ? corner_meets(pair) : triangles_meet(pair.p, pair.q, kTouch);
}

// Of the faces found, those that go on from the patch and stand above the same plane as it can't come down on
// it before some fold is seen nearer by: they get the next stamp.
void Contact::leave_own_sheet() {
    const uint32_t far = stamp_++;
    DVec3 mean(0.0);
    for (const DVec3& normal : normals_)
        mean += normal;
    mean = normalized_or(mean, DVec3(0.0));
    for (const DVec3& normal : normals_)
        if (glm::dot(normal, mean) <= kGraph) return;
    const SurfaceMesh& mesh = surface_.mesh;
    sheet_ = near_;
    while (!sheet_.empty()) {
        Halfedge h = mesh.halfedge(sheet_.back());
        sheet_.pop_back();
        for (int side = 0; side < 3; side++, h = mesh.next(h)) {
            const Face next = mesh.face(mesh.opposite(h));
            FaceCell& cell = surface_.faces[next];
            if (cell.stamp != far || glm::dot(cell.normal, mean) <= kGraph) continue;
            cell.stamp = stamp_;
            sheet_.push_back(next);
        }
    }
}

Hold Contact::check_far(const Change& change) {
    Box swept;
    for (const std::array<Vertex, 3>& made : change.made)
        for (const Vertex corner : made)
            swept.take(place(change, corner));
    if (change.swept) swept.take(surface_.place(change.moved));
    const DVec3 middle =
        change.moved == SurfaceMesh::null_vertex() ? 0.5 * (swept.low + swept.high) : change.to;
    double round = change.swept ? glm::distance(surface_.place(change.moved), middle) : 0.0;
    for (const std::array<Vertex, 3>& made : change.made)
        for (const Vertex corner : made)
            round = std::max(round, glm::distance(place(change, corner), middle));
    double nearest = reach_;
    found_.clear();
    distances_.clear();
    close_.clear();
    const uint32_t far = ++stamp_;
    grid_.visit(middle, round + reach_, [&](uint32_t item) {
        const Face face(item);
        FaceCell& cell = surface_.faces[face];
        if (cell.stamp >= far - 1) return;
        const double distance = surface_.least_distance(face, swept, middle, round);
        if (distance >= reach_) return;
        cell.stamp = far;
        found_.push_back(face);
        distances_.push_back(distance);
        if (distance > gap_) return;
        Vertex corners[3];
        surface_.corners(face, corners);
        close_.push_back(
            {cell.box, {surface_.place(corners[0]), surface_.place(corners[1]), surface_.place(corners[2])}});
    });
    leave_own_sheet();
    for (size_t i = 0; i < found_.size(); i++)
        if (surface_.faces[found_[i]].stamp == far) nearest = std::min(nearest, distances_[i]);
    if (obstacles_) nearest = std::min(nearest, obstacles_->distance(swept, reach_));
    if (change.swept && !change.sudden) surface_.cells[change.moved].safe_until = until(nearest);
    if (!close_.empty() || obstacles_) return check_close(change);
    return Hold::kFree;
}

bool Contact::meets_obstacle(const DVec3 (&triangle)[3]) {
    if (!obstacles_) return false;
    const int32_t met = obstacles_->meets(triangle, gap_);
    if (met >= 0) touched_ = met;
    return met >= 0;
}

// Exactly, for what may lie as near as that.
Hold Contact::check_close(const Change& change) {
    const auto meets = [&](const DVec3(&p)[3]) {
        Box box;
        for (const DVec3& corner : p)
            box.take(corner);
        box = box.grown(gap_);
        return std::any_of(close_.begin(), close_.end(), [&](const Close& other) {
            return other.box.meets(box) && triangles_meet(p, other.corners, gap_);
        });
    };
    const DVec3 before = change.swept ? surface_.place(change.moved) : DVec3(0.0);
    for (const std::array<Vertex, 3>& made : change.made) {
        const DVec3 p[3] = {place(change, made[0]), place(change, made[1]), place(change, made[2])};
        if (meets(p)) return Hold::kSurface;
        if (meets_obstacle(p)) return Hold::kObstacle;
        if (!change.swept) continue;
        // Walls of what the face sweeps: between its place now and then.
        const DVec3 wall[3] = {before, change.to, p[1]};
        if (meets(wall)) return Hold::kSurface;
        if (meets_obstacle(wall)) return Hold::kObstacle;
    }
    return Hold::kFree;
}

}  // namespace treerec::growth
