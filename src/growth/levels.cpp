// By half-edge collapses, the cheapest first: what goes is where its planes can spare it most (Garland and
// Heckbert, "Surface Simplification Using Quadric Error Metrics", 1997, sections 3 to 5).
#include "growth/levels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <queue>

#include "geometry/parallel.h"
#include "geometry/portable_math.h"
#include "geometry/triangle.h"
#include "growth/face_grid.h"
#include "growth/grow_bark.h"

namespace treerec::growth {

namespace {

constexpr double kEven = 1e-3;        // of an edge's square: what a collapse along it costs in a plane
constexpr double kLeastCosine = 0.3;  // between a triangle's normals before and after
constexpr double kLeastShape = 0.05;  // of twice a triangle's area over its longest edge's square
constexpr double kDeepest = 1.0;      // of its branch's radius: a vertex comes off its planes so far at most
constexpr float kMostRound = 0.36f;   // that a triangle may span of its branch's circumference
constexpr size_t kCheckEvery = 1024;  // collapses

constexpr size_t kTogether = 512;     // vertices
constexpr double kFarthest = 1024.0;  // mean triangles: what is that far away is not looked for

constexpr uint32_t kNone = UINT32_MAX;

// Weighted squared distances to planes, about an origin: p'Ap + 2b'p + c.
struct Quadric {
    double xx = 0.0, xy = 0.0, xz = 0.0, yy = 0.0, yz = 0.0, zz = 0.0;
    DVec3 b{0.0};
    double c = 0.0;

    void add_plane(const DVec3& n, const DVec3& at, double weight) {
        const double d = -glm::dot(n, at);
        xx += weight * n.x * n.x;
        xy += weight * n.x * n.y;
        xz += weight * n.x * n.z;
        yy += weight * n.y * n.y;
        yz += weight * n.y * n.z;
        zz += weight * n.z * n.z;
        b += weight * d * n;
        c += weight * d * d;
    }
    void add(const Quadric& other) {
        xx += other.xx;
        xy += other.xy;
        xz += other.xz;
        yy += other.yy;
        yz += other.yz;
        zz += other.zz;
        b += other.b;
        c += other.c;
    }
    double at(const DVec3& p) const {
        const DVec3 a(xx * p.x + xy * p.y + xz * p.z, xy * p.x + yy * p.y + yz * p.z,
                      xz * p.x + yz * p.y + zz * p.z);
        return std::max(glm::dot(p, a) + 2.0 * glm::dot(b, p) + c, 0.0);
    }
};

using Corners = std::array<uint32_t, 3>;

class Decimator {
  public:
    explicit Decimator(const GrownBark& bark)
        : bark_(bark),
          quadrics_(bark.vertices.size()),
          areas_(bark.vertices.size(), 0.0),
          around_(bark.vertices.size()),
          rim_(bark.vertices.size(), false),
          stays_(bark.vertices.size(), false),
          target_(bark.vertices.size(), kNone),
          version_(bark.vertices.size(), 0) {
        origin_ = DVec3(bark.vertices.front().position);
        for (const GrownBark::Vertex& vertex : bark.vertices)
            places_.push_back(DVec3(vertex.position) - origin_);
        for (size_t i = 0; i + 2 < bark.indices.size(); i += 3) {
            const Corners corners{bark.indices[i], bark.indices[i + 1], bark.indices[i + 2]};
            for (const uint32_t v : corners)
                around_[v].push_back(static_cast<uint32_t>(faces_.size()));
            faces_.push_back(corners);
        }
        keep_tips();
        for (const Corners& face : faces_)
            weigh(face);
        for (const Corners& face : faces_)
            guard_rim(face);
    }

    // What goes and what it becomes part of, in that order.
    std::vector<std::pair<uint32_t, uint32_t>> run(const Progress* progress) {
        std::vector<std::pair<uint32_t, uint32_t>> gone;
        for (uint32_t v = 0; v < places_.size(); v++)
            offer(v);
        std::vector<uint32_t> near;
        while (!heap_.empty()) {
            const Offer best = heap_.top();
            heap_.pop();
            if (best.version != version_[best.vertex]) continue;
            const uint32_t v = best.vertex, to = target_[v];
            if (!may_go(v, to)) {  // since what lies farther has changed
                offer(v);
                continue;
            }
            if (gone.size() % kCheckEvery == 0 && progress) progress->check();
            gone.emplace_back(v, to);
            collapse(v, to);
            near = neighbours(to);
            near.push_back(to);
            for (const uint32_t other : near)
                offer(other);
        }
        return gone;
    }

  private:
    struct Offer {
        double cost;
        uint32_t vertex, version;
        bool operator<(const Offer& other) const {  // the top of the heap is the largest
            return cost != other.cost ? cost > other.cost : vertex > other.vertex;
        }
    };

    bool decayed(uint32_t v) const { return bark_.vertices[v].decayed; }
    // Twice its area, along its normal.
    DVec3 doubled(const DVec3& a, const DVec3& b, const DVec3& c) const { return glm::cross(b - a, c - a); }
    DVec3 doubled(const Corners& f) const { return doubled(places_[f[0]], places_[f[1]], places_[f[2]]); }

    // Tubes go on from there.
    void keep_tips() {
        std::vector<uint32_t> tips(bark_.branches.size(), kNone);
        for (uint32_t v = 0; v < places_.size(); v++) {
            uint32_t& tip = tips[static_cast<size_t>(bark_.vertices[v].branch)];
            if (tip == kNone || bark_.vertices[v].along > bark_.vertices[tip].along) tip = v;
        }
        for (const uint32_t tip : tips)
            if (tip != kNone) stays_[tip] = true;
    }

    void weigh(const Corners& face) {
        const DVec3 cross = doubled(face);
        const double area = 0.5 * glm::length(cross);
        if (!(area > 0.0)) return;
        for (const uint32_t v : face) {
            quadrics_[v].add_plane(cross / (2.0 * area), places_[face[0]], area);
            areas_[v] += area;
        }
    }

    // Where bark meets wood its line is worth as much as the surface.
    void guard_rim(const Corners& face) {
        const bool wood = decayed(face[0]) || decayed(face[1]) || decayed(face[2]);
        if (!wood) return;
        for (size_t k = 0; k < 3; k++) {
            const uint32_t a = face[k], b = face[(k + 1) % 3];
            if (decayed(a) || decayed(b)) continue;
            if (decayed(opposite(b, a))) continue;
            rim_[a] = rim_[b] = true;
            const DVec3 edge = places_[b] - places_[a];
            const DVec3 n = normalized_or(glm::cross(edge, doubled(face)), DVec3(0.0));
            for (const uint32_t v : {a, b})
                quadrics_[v].add_plane(n, places_[a], glm::dot(edge, edge));
        }
    }

    // The third corner of the triangle that goes from a to b; kNone where there is none.
    uint32_t opposite(uint32_t a, uint32_t b) const {
        for (const uint32_t f : around_[a])
            for (size_t k = 0; k < 3; k++)
                if (faces_[f][k] == a && faces_[f][(k + 1) % 3] == b) return faces_[f][(k + 2) % 3];
        return kNone;
    }

    std::vector<uint32_t> neighbours(uint32_t v) const {
        std::vector<uint32_t> found;
        for (const uint32_t f : around_[v])
            for (size_t k = 0; k < 3; k++)
                if (faces_[f][k] == v) found.push_back(faces_[f][(k + 1) % 3]);
        return found;
    }

    // Square metres by square metres; below 0 for what would change the shape too much.
    double cost(uint32_t v, uint32_t to) const {
        const DVec3 way = places_[to] - places_[v];
        const double off = quadrics_[v].at(places_[to]) + quadrics_[to].at(places_[to]);
        const double deepest = kDeepest * std::min(bark_.vertices[v].radius, bark_.vertices[to].radius);
        if (off > deepest * deepest * (areas_[v] + areas_[to])) return -1.0;
        return off + kEven * areas_[v] * glm::dot(way, way);
    }

    // The largest part of its branch's circumference that one of its edges spans.
    float round_of(const Corners& f) const {
        float most = 0.0f;
        for (size_t k = 0; k < 3; k++) {
            const GrownBark::Vertex &a = bark_.vertices[f[k]], &b = bark_.vertices[f[(k + 1) % 3]];
            if (a.branch != b.branch) return 0.0f;
            const float turn = std::abs(a.around - b.around);
            most = std::max(most, std::min(turn, 1.0f - turn));
        }
        return most;
    }

    // Whether bark would still meet wood along one line through it.
    bool keeps_rim(uint32_t v, uint32_t to) const {
        if (decayed(v) != decayed(to)) return false;
        if (!rim_[v]) return true;
        if (!rim_[to]) return false;
        size_t lines = 0;
        bool along = false;
        for (const uint32_t other : neighbours(v)) {
            if (decayed(other) || decayed(opposite(v, other)) == decayed(opposite(other, v))) continue;
            lines++;
            along |= other == to;
        }
        return along && lines == 2;
    }

    bool may_go(uint32_t v, uint32_t to) const {
        if (bark_.vertices[v].branch != bark_.vertices[to].branch || !keeps_rim(v, to)) return false;
        // The link condition (Dey, Edelsbrunner, Guha and Nekhayev 1999), on a closed surface.
        const std::vector<uint32_t> own = neighbours(v), others = neighbours(to);
        size_t shared = 0;
        for (const uint32_t other : own) {
            if (std::find(others.begin(), others.end(), other) == others.end()) continue;
            shared++;
            if (around_[other].size() <= 3) return false;
        }
        if (shared != 2) return false;
        for (const uint32_t f : around_[v]) {
            Corners moved = faces_[f];
            if (std::find(moved.begin(), moved.end(), to) != moved.end()) continue;
            const DVec3 before = doubled(moved);
            const float round = round_of(moved);
            std::replace(moved.begin(), moved.end(), v, to);
            const DVec3 after = doubled(moved);
            const double area = glm::length(after);
            if (!(glm::dot(before, after) > kLeastCosine * glm::length(before) * area)) return false;
            double longest = 0.0;
            for (size_t k = 0; k < 3; k++) {
                const DVec3 edge = places_[moved[k]] - places_[moved[(k + 1) % 3]];
                longest = std::max(longest, glm::dot(edge, edge));
            }
            if (area < kLeastShape * longest) return false;
            const float wider = round_of(moved);
            if (wider > kMostRound && wider > round) return false;
        }
        return true;
    }

    void offer(uint32_t v) {
        version_[v]++;
        target_[v] = kNone;
        if (stays_[v]) return;
        std::vector<std::pair<double, uint32_t>> ways;
        for (const uint32_t to : neighbours(v))
            if (const double price = cost(v, to); price >= 0.0) ways.emplace_back(price, to);
        std::sort(ways.begin(), ways.end());
        for (const auto& [price, to] : ways) {
            if (!may_go(v, to)) continue;
            target_[v] = to;
            heap_.push({price, v, version_[v]});
            return;
        }
    }

    void collapse(uint32_t v, uint32_t to) {
        for (const uint32_t f : around_[v]) {
            Corners& face = faces_[f];
            const bool goes = std::find(face.begin(), face.end(), to) != face.end();
            if (goes) {
                for (const uint32_t corner : face)
                    if (corner != v) std::erase(around_[corner], f);
            } else {
                std::replace(face.begin(), face.end(), v, to);
                around_[to].push_back(f);
            }
        }
        around_[v].clear();
        quadrics_[to].add(quadrics_[v]);
        areas_[to] += areas_[v];
        version_[v]++;
    }

    const GrownBark& bark_;
    DVec3 origin_{0.0};
    std::vector<DVec3> places_;  // from the origin
    std::vector<Quadric> quadrics_;
    std::vector<double> areas_;  // square metres of what became one vertex
    std::vector<Corners> faces_;
    std::vector<std::vector<uint32_t>> around_;  // faces by vertex
    std::vector<bool> rim_;                      // bark beside wood
    std::vector<bool> stays_;                    // in all levels
    std::vector<uint32_t> target_, version_;
    std::priority_queue<Offer> heap_;
};

}  // namespace

void order_levels(GrownBark& bark, const Progress* progress) {
    bark.parents.clear();
    const size_t count = bark.vertices.size();
    if (count == 0) return;
    const std::vector<std::pair<uint32_t, uint32_t>> gone = Decimator(bark).run(progress);
    std::vector<uint32_t> place(count, kNone);  // in the new order
    uint32_t last = static_cast<uint32_t>(count);
    for (const auto& [vertex, to] : gone)
        place[vertex] = --last;
    uint32_t first = 0;
    for (uint32_t& one : place)
        if (one == kNone) one = first++;
    std::vector<GrownBark::Vertex> ordered(count);
    for (size_t i = 0; i < count; i++)
        ordered[place[i]] = bark.vertices[i];
    bark.vertices = std::move(ordered);
    for (uint32_t& index : bark.indices)
        index = place[index];
    bark.parents.resize(count);
    std::iota(bark.parents.begin(), bark.parents.end(), 0u);
    for (const auto& [vertex, to] : gone)
        bark.parents[place[vertex]] = place[to];
}

}  // namespace treerec::growth

namespace treerec {

LevelError measure_level(const GrownBark& full, double level) {
    using namespace growth;
    const GrownBark lighter = full.parents.empty() ? full : lighter_bark(full, level);
    LevelError error;
    error.triangles = lighter.indices.size() / 3;
    if (error.triangles == 0 || full.vertices.empty()) return error;
    const auto place = [&](size_t face, size_t k) {
        return DVec3(lighter.vertices[lighter.indices[3 * face + k]].position);
    };
    struct Ball {
        DVec3 middle;
        double round;
    };
    std::vector<Ball> balls;
    double mean = 0.0;
    for (size_t f = 0; f < error.triangles; f++) {
        Ball ball{(place(f, 0) + place(f, 1) + place(f, 2)) / 3.0, 0.0};
        for (size_t k = 0; k < 3; k++)
            ball.round = std::max(ball.round, glm::distance(ball.middle, place(f, k)));
        mean += ball.round / static_cast<double>(error.triangles);
        balls.push_back(ball);
    }
    FaceGrid grid(4.0 * mean);
    for (size_t f = 0; f < balls.size(); f++)
        grid.add(static_cast<uint32_t>(f), balls[f].middle, balls[f].round);
    // The shown normals lean where bark touches bark.
    std::vector<DVec3> facing(full.vertices.size(), DVec3(0.0));
    for (size_t i = 0; i + 2 < full.indices.size(); i += 3) {
        const DVec3 a(full.vertices[full.indices[i]].position);
        const DVec3 doubled = glm::cross(DVec3(full.vertices[full.indices[i + 1]].position) - a,
                                         DVec3(full.vertices[full.indices[i + 2]].position) - a);
        for (size_t k = 0; k < 3; k++)
            facing[full.indices[i + k]] += doubled;
    }
    struct Found {
        double far = 0.0, out = 0.0, turn = 0.0;  // metres, metres, degrees squared
    };
    std::vector<Found> found(full.vertices.size());
    parallel_for(found.size(), kTogether, [&](size_t begin, size_t end) {
        for (size_t v = begin; v < end; v++) {
            const DVec3 p(full.vertices[v].position), own(full.vertices[v].normal);
            double nearest = -1.0;
            DVec3 way(0.0), normal(own);
            for (double reach = mean; nearest < 0.0 && reach < kFarthest * mean; reach *= 2.0)
                grid.visit(p, reach, [&](uint32_t f) {
                    const DVec3 a = place(f, 0), b = place(f, 1), c = place(f, 2);
                    if (glm::dot(glm::cross(b - a, c - a), facing[v]) <= 0.0) return;
                    const DVec3 shares = nearest_in_triangle(p, a, b, c);
                    const DVec3 off = shares.x * a + shares.y * b + shares.z * c - p;
                    const double far = glm::length(off);
                    if (far > reach || (nearest >= 0.0 && far >= nearest)) return;
                    nearest = far;
                    way = off;
                    normal = DVec3(0.0);
                    for (size_t k = 0; k < 3; k++)
                        normal += shares[static_cast<int>(k)] *
                                  DVec3(lighter.vertices[lighter.indices[3 * f + k]].normal);
                });
            const double cosine = glm::dot(own, normalized_or(normal, own));
            const double turn = portable::acos(std::clamp(cosine, -1.0, 1.0)) * 180.0 / kPi;
            found[v] = {std::max(nearest, 0.0), glm::dot(way, normalized_or(facing[v], own)), turn * turn};
        }
    });
    const double count = static_cast<double>(found.size());
    for (const Found& one : found) {
        error.mean += one.far / count;
        error.most = std::max(error.most, one.far);
        error.out += one.out / count;
        error.turn += one.turn / count;
    }
    error.turn = std::sqrt(error.turn);
    return error;
}

}  // namespace treerec
