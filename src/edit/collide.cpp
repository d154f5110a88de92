#include "edit/collide.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <tuple>

#include "edit/graft/scion.h"
#include "error.h"
#include "geometry/portable_math.h"

namespace treerec {

namespace {

constexpr double kMostCells = 1 << 17;
constexpr double kMostCellsEach = 256.0;   // per capsule: stout wood visits them all
constexpr double kTaper = 1.6;             // how much thicker a segment may start than it ends
constexpr double kCellsPerCapsule = 64.0;  // at most, on average
constexpr size_t kRunLength = 64;
constexpr int kMostPieces = 1 << 10;  // of one segment

using Capsule = StandingWood::Segment;

Bounds bounds_of(const Capsule& capsule) {
    Bounds box;
    box.add(capsule.a, capsule.ra);
    box.add(capsule.b, capsule.rb);
    return box;
}

bool overlap(const Bounds& a, const Bounds& b) {
    return glm::all(glm::lessThanEqual(a.min, b.max)) && glm::all(glm::lessThanEqual(b.min, a.max));
}

// Where two segments are nearest, 0..1 along each (Ericson, Real-Time Collision Detection, 2005, 5.1.9).
std::pair<double, double> nearest(const Capsule& p, const Capsule& q) {
    const DVec3 d1 = p.b - p.a;
    const DVec3 d2 = q.b - q.a;
    const DVec3 r = p.a - q.a;
    const double a = glm::dot(d1, d1);
    const double e = glm::dot(d2, d2);
    const double f = glm::dot(d2, r);
    if (a <= 0.0 && e <= 0.0) return {0.0, 0.0};
    if (a <= 0.0) return {0.0, std::clamp(f / e, 0.0, 1.0)};
    const double c = glm::dot(d1, r);
    if (e <= 0.0) return {std::clamp(-c / a, 0.0, 1.0), 0.0};
    const double b = glm::dot(d1, d2);
    const double determinant = a * e - b * b;
    double s = determinant > 1e-12 * a * e ? std::clamp((b * f - c * e) / determinant, 0.0, 1.0) : 0.0;
    double t = (b * s + f) / e;
    if (t < 0.0) {
        t = 0.0;
        s = std::clamp(-c / a, 0.0, 1.0);
    } else if (t > 1.0) {
        t = 1.0;
        s = std::clamp((b - c) / a, 0.0, 1.0);
    }
    return {s, t};
}

// The capsules of the new wood, by the cells of a box about them that they touch.
class CapsuleGrid {
  public:
    explicit CapsuleGrid(const std::vector<Capsule>& capsules, double clearance) {
        double length = 0.0;
        double thick = 0.0;
        for (const Capsule& capsule : capsules) {
            const Bounds box = bounds_of(capsule);
            box_.add(box.min - clearance);
            box_.add(box.max + clearance);
            length += glm::distance(capsule.a, capsule.b);
            thick += capsule.ra + capsule.rb;
        }
        const DVec3 size = glm::max(box_.size(), DVec3(1e-9));
        const double count = static_cast<double>(capsules.size());
        const double most = std::min(kMostCells, kMostCellsEach * (count + 1.0));
        cell_ = std::max({length / count, thick / count + clearance,
                          portable::cbrt(size.x * size.y * size.z / most) * 1.1,
                          std::max({size.x, size.y, size.z}) / 256.0});
        // A flat box can still have too many cells, and stout wood can lie in too many of them.
        for (;; cell_ *= 1.5) {
            double cells = 1.0;
            for (int axis = 0; axis < 3; axis++) {
                count_[axis] = static_cast<int>(size[axis] / cell_) + 1;
                cells *= count_[axis];
            }
            if (cells > most) continue;
            double touched = 0.0;
            for (const Capsule& capsule : capsules) {
                const double across = 2.0 * (std::max(capsule.ra, capsule.rb) + clearance) / cell_ + 2.0;
                const double along = glm::distance(capsule.a, capsule.b) / cell_ + 1.0;
                touched += std::min(cells, along * across * across);
            }
            if (!(touched > kCellsPerCapsule * count) || cells <= 1.0) break;
        }
        begin_.assign(static_cast<size_t>(count_[0]) * count_[1] * count_[2] + 1, 0);
        for (const Capsule& capsule : capsules)
            for_cells(capsule, clearance, [&](size_t c) { begin_[c + 1]++; });
        for (size_t c = 1; c < begin_.size(); c++)
            begin_[c] += begin_[c - 1];
        items_.resize(begin_.back());
        std::vector<uint32_t> next(begin_.begin(), begin_.end() - 1);
        for (size_t i = 0; i < capsules.size(); i++)
            for_cells(capsules[i], clearance,
                      [&](size_t c) { items_[next[c]++] = static_cast<uint32_t>(i); });
    }

    const Bounds& box() const { return box_; }

    // Calls visit(index of a capsule) for every one that shares a cell with `capsule`, some several times.
    template <typename Visit>
    void for_near(const Capsule& capsule, const Visit& visit) const {
        for_cells(capsule, 0.0, [&](size_t c) {
            for (uint32_t i = begin_[c]; i < begin_[c + 1]; i++)
                visit(items_[i]);
        });
    }

  private:
    // Piece by piece, so that a long slanting segment does not count to every cell of the box about it.
    template <typename Body>
    void for_cells(const Capsule& capsule, double margin, const Body& body) const {
        // Only the stretch within the box matters.
        double from = 0.0;
        double to = 1.0;
        const DVec3 way = capsule.b - capsule.a;
        const double reach = std::max(capsule.ra, capsule.rb) + margin;
        for (int axis = 0; axis < 3; axis++) {
            if (std::abs(way[axis]) < 1e-300) continue;
            const double t0 = (box_.min[axis] - reach - capsule.a[axis]) / way[axis];
            const double t1 = (box_.max[axis] + reach - capsule.a[axis]) / way[axis];
            from = std::max(from, std::min(t0, t1));
            to = std::min(to, std::max(t0, t1));
        }
        if (from > to) return;
        const double length = glm::length(way) * (to - from);
        // What is no number, of wood of absurd size, counts as most.
        const double wanted = length / std::max(cell_, reach);
        const int pieces = wanted < kMostPieces ? static_cast<int>(wanted) + 1 : kMostPieces;
        for (int i = 0; i < pieces; i++) {
            const DVec3 a = capsule.a + way * (from + (to - from) * i / pieces);
            const DVec3 b = capsule.a + way * (from + (to - from) * (i + 1) / pieces);
            int low[3], high[3];
            for (int axis = 0; axis < 3; axis++) {
                low[axis] = index(std::min(a[axis], b[axis]) - reach, axis);
                high[axis] = index(std::max(a[axis], b[axis]) + reach, axis);
            }
            for (int x = low[0]; x <= high[0]; x++)
                for (int y = low[1]; y <= high[1]; y++)
                    for (int z = low[2]; z <= high[2]; z++)
                        body((static_cast<size_t>(x) * count_[1] + y) * count_[2] + z);
        }
    }

    int index(double at, int axis) const {
        const double i = (at - box_.min[axis]) / cell_;
        if (!(i > 0.0)) return 0;
        return i < count_[axis] ? static_cast<int>(i) : count_[axis] - 1;
    }

    Bounds box_;
    double cell_ = 1.0;
    std::array<int, 3> count_{1, 1, 1};
    std::vector<uint32_t> begin_;
    std::vector<uint32_t> items_;
};

// The segment that ends at `id`; not for the root.
Capsule capsule_of(const Tree& tree, NodeId id) {
    const Node& node = tree.node(id);
    const Node& parent = tree.node(node.parent);
    // A branch that leaves stouter wood begins about as thick as it goes on.
    const double from = std::min(parent.radius, kTaper * node.radius);
    return {parent.position, node.position, from, node.radius, id};
}

std::vector<Capsule> capsules_of(const Tree& tree, const std::vector<NodeId>& ids) {
    std::vector<Capsule> capsules;
    capsules.reserve(ids.size());
    for (NodeId id : ids)
        if (tree.node(id).parent != kNoNode) capsules.push_back(capsule_of(tree, id));
    return capsules;
}

std::vector<Collision> collide(const StandingWood& standing, const std::vector<Capsule>& grafted,
                               const CollisionOptions& options, const std::vector<uint8_t>* skip,
                               const Progress* progress) {
    std::vector<Collision> found;
    if (grafted.empty()) return found;
    const CapsuleGrid grid(grafted, options.clearance);
    std::vector<NodeId> seen(grafted.size(), kNoNode);  // the last segment that it was tried with
    for (const StandingWood::Run& run : standing.runs()) {
        if (found.size() > options.most || !overlap(run.box, grid.box())) continue;
        if (progress) progress->check();
        for (const Capsule& other : run.segments) {
            if ((skip && (*skip)[other.id]) || !overlap(bounds_of(other), grid.box())) continue;
            if (found.size() > options.most) break;
            grid.for_near(other, [&](uint32_t g) {
                if (seen[g] == other.id) return;
                seen[g] = other.id;
                const Capsule& mine = grafted[g];
                const auto [s, t] = nearest(mine, other);
                const DVec3 p = mine.a + (mine.b - mine.a) * s;
                const DVec3 q = other.a + (other.b - other.a) * t;
                const double radii = mine.ra + (mine.rb - mine.ra) * s + other.ra + (other.rb - other.ra) * t;
                const double reach = radii + options.clearance;
                const DVec3 gap = p - q;
                if (!(glm::dot(gap, gap) < reach * reach)) return;
                const double depth = reach - glm::length(gap);
                if (depth <= 0.0 || glm::distance(p, options.joint) <= options.joint_reach) return;
                found.push_back({mine.id, other.id, depth, 0.5 * (p + q)});
            });
        }
    }
    std::sort(found.begin(), found.end(), [](const Collision& a, const Collision& b) {
        return std::tie(a.grafted, a.other) < std::tie(b.grafted, b.other);
    });
    return found;
}

}  // namespace

double joint_reach(const Tree& tree, NodeId joint, NodeId own_child, double own, const DVec3& away,
                   double clearance) {
    const Node& host = tree.node(joint);
    // Two cylinders whose axes part at this angle touch no longer at this distance.
    double sine = 1.0;
    const auto parts_from = [&](const DVec3& way) {
        if (glm::dot(way, away) > 0.0) sine = std::min(sine, glm::length(glm::cross(way, away)));
    };
    if (host.parent != kNoNode) parts_from(-direction_at(tree, joint));
    for (NodeId child : tree.children(joint))
        if (child != own_child)
            parts_from(normalized_or(tree.node(child).position - host.position, DVec3(0.0)));
    return 1.2 * (host.radius + own + clearance) / std::max(sine, 0.25);
}

StandingWood::StandingWood(const Tree& tree) {
    runs_.reserve(tree.size() / kRunLength + 1);
    for (NodeId id : tree.depth_first())
        if (tree.node(id).parent != kNoNode) add(capsule_of(tree, id));
}

StandingWood::StandingWood(const Tree& tree, const Bounds& within) {
    for (NodeId id = 0; id < tree.id_end(); id++) {
        if (!tree.contains(id) || tree.node(id).parent == kNoNode) continue;
        const Capsule capsule = capsule_of(tree, id);
        if (overlap(bounds_of(capsule), within)) add(capsule);
    }
}

void StandingWood::add(const Segment& segment) {
    if (runs_.empty() || runs_.back().segments.size() == kRunLength) {
        runs_.emplace_back();
        runs_.back().segments.reserve(kRunLength);
    }
    const Bounds box = bounds_of(segment);
    runs_.back().segments.push_back(segment);
    runs_.back().box.add(box.min);
    runs_.back().box.add(box.max);
}

void StandingWood::add(const Tree& tree, const std::vector<NodeId>& ids) {
    for (NodeId id : ids)
        add(capsule_of(tree, id));
}

std::vector<Collision> find_collisions(const StandingWood& standing, const Tree& wood,
                                       const CollisionOptions& options, const Progress* progress) {
    return collide(standing, capsules_of(wood, wood.depth_first()), options, nullptr, progress);
}

std::vector<Collision> find_collisions(const Tree& tree, NodeId child, double clearance,
                                       const Progress* progress) {
    if (!tree.contains(child)) throw Error("There is no node " + std::to_string(child) + " in this tree.");
    if (!(clearance >= 0.0) || !std::isfinite(clearance))
        throw Error("The clearance must be a length in metres that is not negative.");
    const NodeId joint = tree.node(child).parent;
    if (joint == kNoNode) return {};
    const std::vector<NodeId> above = tree.depth_first(child);
    std::vector<uint8_t> skip(static_cast<size_t>(tree.id_end()), 0);
    for (NodeId id : above)
        skip[id] = 1;
    const Node& host = tree.node(joint);
    const double own = std::min(tree.node(child).radius, host.radius);
    const DVec3 away = normalized_or(tree.node(child).position - host.position, direction_at(tree, joint));
    CollisionOptions options;
    options.clearance = clearance;
    options.joint = host.position;
    options.joint_reach = joint_reach(tree, joint, child, own, away, clearance);
    return collide(StandingWood(tree), capsules_of(tree, above), options, &skip, progress);
}

}  // namespace treerec
