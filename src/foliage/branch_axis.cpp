#include "foliage/branch_axis.h"

#include <algorithm>

#include "geometry/portable_math.h"

namespace treerec {

namespace {

constexpr double kBendPerPoint = 0.14;  // radians
constexpr int kMostPieces = 8;
constexpr double kTwigRadius = 0.015;  // metres; below it nobody sees how a twig leaves another

struct Knot {
    DVec3 position;
    double radius;
    double way;  // metres of chords up to it
};

// Direction at the knot between two chords: nearer to that of the shorter, as a circle through the knots has.
DVec3 direction_between(const DVec3& before, double before_length, const DVec3& after, double after_length) {
    return normalized_or(before * after_length + after * before_length, after);
}

// How a branch leaves its parent. A stout one first goes the parent's way and then bends off, as branches of
// a fork do; a thin one grows straight out.
struct Departure {
    DVec3 direction{0.0};
    double share = 0.0;  // how much of `direction` the branch takes, 0..1
    double reach = 0.0;  // metres: how far it is felt
};

Departure departure_of(const Tree& tree, const BranchList& list, const Branch& branch) {
    Departure departure;
    if (branch.attach == kNoNode) return departure;
    const Node& attach = tree.node(branch.attach);
    if (attach.parent == kNoNode || attach.radius < kTwigRadius) return departure;
    departure.direction =
        normalized_or(attach.position - tree.node(attach.parent).position, DVec3(0.0, 1.0, 0.0));
    const double stoutness = tree.node(list.nodes[branch.begin]).radius / attach.radius;
    const DVec3 own = tree.node(list.nodes[branch.begin]).position - attach.position;
    const double agreement = glm::dot(departure.direction, normalized_or(own, departure.direction));
    departure.share = glm::smoothstep(0.25, 0.7, stoutness) * glm::smoothstep(-0.1, 0.5, agreement);
    departure.reach = 4.0 * attach.radius;
    return departure;
}

// Into how many pieces a stretch is cut that bends by two angles, of which these are the cosines. Most often
// bounds of the angles tell: an angle over its chord is 1 + c^2 / 24 + 3 c^4 / 640 + ...
int pieces_of(double before, double after) {
    const auto pieces = [](double bend) {
        return std::clamp(static_cast<int>(std::ceil(bend / kBendPerPoint)), 1, kMostPieces);
    };
    before = std::clamp(before, -1.0, 1.0);
    after = std::clamp(after, -1.0, 1.0);
    const double a = std::sqrt(2.0 * (1.0 - before)), b = std::sqrt(2.0 * (1.0 - after));
    if (std::max(a, b) <= 1.0) {
        const double a3 = a * a * a, b3 = b * b * b;
        const double least = a + b + (a3 + b3) / 24.0;
        const double most = least + 0.006 * (a3 * a * a + b3 * b * b);
        const int fewest = pieces(least * (1.0 - 1e-9));
        if (fewest == pieces(most * (1.0 + 1e-9))) return fewest;
    }
    return pieces(portable::acos(before) + portable::acos(after));
}

}  // namespace

void sample_axis(const Tree& tree, const BranchList& list, const Branch& branch, double least,
                 std::vector<AxisPoint>& points) {
    points.clear();
    const std::span<const NodeId> nodes = list.nodes_of(branch);
    const Departure departure = departure_of(tree, list, branch);
    // The bend of a stout branch needs room: the first knot lies out of the parent's wood.
    double room = 0.3 * departure.share * departure.reach;
    const NodeId start = branch.attach != kNoNode ? branch.attach : nodes[0];
    size_t next_node = branch.attach != kNoNode ? 0 : 1;
    Knot from{tree.node(start).position, tree.node(nodes[0]).radius, 0.0}, to{};
    const DVec3 tip = tree.node(nodes.back()).position;
    // Of the last node looked at, knot or not.
    double way = 0.0;
    DVec3 before = from.position;
    const auto next_knot = [&](const Knot& last_knot, Knot& knot) {
        while (next_node < nodes.size()) {
            const Node& node = tree.node(nodes[next_node++]);
            way += glm::distance(node.position, before);
            before = node.position;
            const double apart = std::max({0.25 * std::min(last_knot.radius, node.radius), room, least});
            const bool last = next_node == nodes.size();
            if (glm::distance(node.position, last_knot.position) <= (last ? least : apart)) continue;
            // Just below the tip, the tip stands for both.
            if (!last && glm::distance(node.position, tip) <= apart) continue;
            knot = {node.position, node.radius, way};
            room = 0.0;
            return true;
        }
        return false;
    };

    if (!next_knot(from, to)) return;
    DVec3 chord = to.position - from.position;
    double length = glm::length(chord);
    chord /= length;
    DVec3 start_direction = chord;
    double along = 0.0;
    bool first = true;
    while (true) {
        Knot beyond{};
        const bool more = next_knot(to, beyond);
        DVec3 next_chord = chord;
        double next_length = length;
        if (more) {
            next_chord = beyond.position - to.position;
            next_length = glm::length(next_chord);
            next_chord /= next_length;
        }
        DVec3 end_direction = more ? direction_between(chord, length, next_chord, next_length)
                                   : normalized_or(1.5 * chord - 0.5 * start_direction, chord);
        if (first) start_direction = normalized_or(1.5 * chord - 0.5 * end_direction, chord);
        double start_speed = length;
        if (first) {
            start_direction = normalized_or(
                start_direction + (departure.direction - start_direction) * departure.share, chord);
            start_speed += (std::min(length, departure.reach) - length) * departure.share;
            points.push_back({from.position, start_direction, from.radius, 0.0});
        }
        first = false;
        const int pieces = pieces_of(glm::dot(start_direction, chord), glm::dot(chord, end_direction));
        for (int i = 1; i <= pieces; i++) {
            AxisPoint point{to.position, end_direction, to.radius, 0.0, to.way};
            if (i < pieces) {
                const double t = static_cast<double>(i) / pieces, t2 = t * t, t3 = t2 * t;
                const DVec3 m0 = start_direction * start_speed, m1 = end_direction * length;
                point.position = (2.0 * t3 - 3.0 * t2 + 1.0) * from.position + (t3 - 2.0 * t2 + t) * m0 +
                                 (3.0 * t2 - 2.0 * t3) * to.position + (t3 - t2) * m1;
                point.direction =
                    normalized_or((6.0 * t2 - 6.0 * t) * (from.position - to.position) +
                                      (3.0 * t2 - 4.0 * t + 1.0) * m0 + (3.0 * t2 - 2.0 * t) * m1,
                                  chord);
                point.radius = from.radius + (to.radius - from.radius) * t;
                point.way = from.way + (to.way - from.way) * t;
            }
            const double step = glm::distance(point.position, points.back().position);
            if (step <= 0.5 * least) continue;
            along += step;
            point.along = along;
            points.push_back(point);
        }
        if (!more) break;
        from = to;
        to = beyond;
        chord = next_chord;
        length = next_length;
        start_direction = end_direction;
    }
    if (points.size() < 2) points.clear();
}

AxisPoint axis_at(const std::vector<AxisPoint>& points, double along, size_t& hint) {
    hint = std::min(hint, points.size() - 2);
    while (hint > 0 && points[hint].along > along)
        hint--;
    while (hint + 2 < points.size() && points[hint + 1].along < along)
        hint++;
    const AxisPoint& a = points[hint];
    const AxisPoint& b = points[hint + 1];
    const double t = std::clamp((along - a.along) / (b.along - a.along), 0.0, 1.0);
    return {a.position + (b.position - a.position) * t,
            normalized_or(a.direction + (b.direction - a.direction) * t, a.direction),
            a.radius + (b.radius - a.radius) * t, a.along + (b.along - a.along) * t,
            a.way + (b.way - a.way) * t};
}

}  // namespace treerec
