#include "sketch/repair.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "sketch/clean.h"

namespace treerec {

namespace {

constexpr double kStep = 3.0;      // pixels, of the points that density is counted in
constexpr double kUnseen = 3.0;    // pixels: a smaller change is no repair
constexpr double kContact = 1e-6;  // pixels: on the trunk

// The direction in which the branch comes to its end at line[0]: from the middle of the farther half of its
// last `reach` pixels to that of the nearer half.
DVec2 tail_direction(const FlatLine& line, const std::vector<double>& arcs, double reach) {
    const double part = std::min(std::max(0.25 * arcs.back(), 9.0), reach);
    constexpr int kSamples = 12;
    DVec2 near(0.0), far(0.0);
    for (int k = 0; k < kSamples; k++)
        (k < kSamples / 2 ? near : far) += point_at(line, arcs, part * k / (kSamples - 1));
    return unit_or(near - far, unit_or(line.front() - line.back(), DVec2(0.0, -1.0)));
}

// Puts `head` before what the line has beyond `arc`.
FlatLine from_arc(const FlatLine& line, const std::vector<double>& arcs, double arc, const FlatLine& head) {
    FlatLine rest = head;
    const auto add = [&](const DVec2& p) {
        if (rest.empty() || glm::length(p - rest.back()) > kContact) rest.push_back(p);
    };
    add(point_at(line, arcs, arc));
    for (size_t i = 0; i < line.size(); i++)
        if (arcs[i] > arc) add(line[i]);
    return rest;
}

// The step behind the turn of a hook from one step to another; 0: it is a loop.
int turn_of_hook(const FlatLine& even, int from, int to) {
    const DVec2 a = even[static_cast<size_t>(from)], b = even[static_cast<size_t>(to)];
    const double length = kStep * (to - from);
    const FlatLine piece(even.begin() + from, even.begin() + to + 1);
    if (glm::length(b - a) < 0.25 * length && std::abs(polygon_area(piece)) > 0.035 * length * length)
        return 0;
    int turn = from;
    double farthest = 0.0;
    for (int i = from; i <= to; i++) {
        const DVec2 p = even[static_cast<size_t>(i)];
        const double far = glm::length(p - a) + glm::length(p - b);
        if (far > farthest) {
            farthest = far;
            turn = i;
        }
    }
    return std::min(turn + 1, to);
}

// Whether there was a hook or a loop. taken: gets more by what the branch lost to it.
bool mend_cluster(FlatLine& line, double& taken, const RepairOptions& options) {
    // Windows of so many steps.
    constexpr std::array<int, 7> kWindows = {4, 6, 8, 11, 15, 20, 26};
    const std::vector<double> arcs = line_arcs(line);
    const double length = arcs.back();
    const double reach = std::min(options.cluster_share * length, options.cluster_reach);
    const int last = static_cast<int>(0.6 * length / kStep);
    const int steps = std::min(last, static_cast<int>(reach / kStep) + kWindows.back());
    if (steps < kWindows[0]) return false;
    FlatLine even;
    for (int i = 0; i <= steps; i++)
        even.push_back(point_at(line, arcs, kStep * i));
    // The whole stroke's L / N, measured as the windows' l / n is: what shakes everywhere is dense nowhere.
    double coarse = 0.0;
    const int pieces = std::max(1, static_cast<int>(length / (4.0 * kStep)));
    for (int k = 0; k < std::min(pieces, 200); k++) {
        const double from = length * k / pieces, to = length * (k + 1) / pieces;
        coarse += glm::length(point_at(line, arcs, to) - point_at(line, arcs, from)) / (to - from);
    }
    const double whole = coarse / std::min(pieces, 200);
    double best = 0.0;
    int from = 0, to = 0;
    for (int i = 0; i * kStep <= reach; i++)
        for (const int window : kWindows) {
            if (i + window > steps) break;
            const double span =
                glm::length(even[static_cast<size_t>(i + window)] - even[static_cast<size_t>(i)]);
            const double density = window * kStep / std::max(span, 0.1 * window * kStep) * whole;
            if (density < options.relative_density) continue;
            // Of a hook, pieces of all lengths around its turn are as dense: the longest is all of it.
            const double score = density * std::sqrt(static_cast<double>(window));
            if (score > best) {
                best = score;
                from = i;
                to = i + window;
            }
        }
    if (to == 0) return false;
    const DVec2 centroid = line_centroid(even, static_cast<size_t>(from), static_cast<size_t>(to) + 1);
    // A short rest before it belongs to it.
    if (from > to - from) {
        FlatLine head;
        for (size_t i = 0; i < line.size() && arcs[i] < from * kStep; i++)
            head.push_back(line[i]);
        head.push_back(centroid);
        line = from_arc(line, arcs, to * kStep, head);
        return true;
    }
    // What comes back from a hook's turn is the branch already; what comes back around a loop is not.
    const int turn = turn_of_hook(even, from, to);
    FlatLine rest = from_arc(line, arcs, (turn > 0 ? turn : to) * kStep, {});
    const std::vector<double> rest_arcs = line_arcs(rest);
    const DVec2 way = tail_direction(rest, rest_arcs, options.tail);
    const double beyond = glm::dot(centroid - rest[0], way);
    if (beyond > kContact) rest.insert(rest.begin(), rest[0] + beyond * way);
    if (turn == 0) taken += 0.5 * (to - from) * kStep - std::max(0.0, beyond);
    line = rest;
    return true;
}

double radius_at(const DrawnLine& trunk, const LinePlace& place) {
    if (trunk.radii.empty()) return 0.0;
    const double a = trunk.radii[place.segment];
    const double b = trunk.radii[std::min(place.segment + 1, trunk.radii.size() - 1)];
    return a + place.along * (b - a);
}

// Whether the trunk was crossed.
bool mend_crossing(MendedBranch& branch, const DrawnLine& trunk, const RepairOptions& options) {
    const std::vector<double> arcs = line_arcs(branch.line);
    const double length = arcs.back();
    double cut = 0.0, beyond = 0.0;  // the last crossing in the tail's half, the first one in the tip's
    for (const LinePlace& place : crossings(branch.line, trunk.points)) {
        const double arc = arc_of(place, arcs);
        if (arc <= 0.5 * length)
            cut = std::max(cut, arc);
        else if (beyond == 0.0 && arc < length - kContact)
            beyond = arc;
    }
    if (cut <= kContact) {
        // Where the tail is on the trunk, the branch only comes by it again.
        if (beyond == 0.0 || nearest_on_line(trunk.points, branch.line[0]).distance < kUnseen) return false;
        std::reverse(branch.line.begin(), branch.line.end());
        branch.repairs.push_back(StrokeRepair::kReversed);
        return mend_crossing(branch, trunk, options);
    }
    if (cut > options.other_side * length && branch.other_side.empty()) {
        FlatLine other = branch.line;
        std::reverse(other.begin(), other.end());
        branch.other_side = from_arc(other, line_arcs(other), length - cut, {});
    }
    branch.line = from_arc(branch.line, arcs, cut, {});
    if (cut > kUnseen) branch.repairs.push_back(StrokeRepair::kCrossing);
    return true;
}

bool mend_gap(MendedBranch& branch, const DrawnLine& trunk, double taken, const RepairOptions& options) {
    const LinePlace nearest = nearest_on_line(trunk.points, branch.line[0]);
    if (nearest.distance <= kContact) return false;
    const std::vector<double> arcs = line_arcs(branch.line);
    const double radius = radius_at(trunk, nearest);
    // A branch that ends at the drawn side of a trunk has no gap, and the way to its middle is no extension;
    // nor is the way back over what a hook took.
    const double far = options.gap_share * arcs.back() + 1.5 * radius + std::max(0.0, taken);
    const DVec2 way = tail_direction(branch.line, arcs, options.tail);
    const std::optional<LinePlace> hit = first_hit(branch.line[0], branch.line[0] + far * way, trunk.points);
    const DVec2 joined = hit ? hit->point : nearest.point;
    const double bridged = glm::length(joined - branch.line[0]);
    if (bridged > kContact) {
        FlatLine head = fill_line({joined, branch.line[0]}, std::max(kMostSpacing, bridged / 500.0),
                                  kMostSpacing, nullptr);
        head.insert(head.end(), branch.line.begin() + 1, branch.line.end());
        branch.line = head;
    } else {
        branch.line[0] = joined;
    }
    const double seen = std::max(0.0, bridged - radius);
    branch.bridged += seen;
    if (seen > kUnseen) branch.repairs.push_back(StrokeRepair::kGap);
    return true;
}

}  // namespace

bool is_reversed(const FlatLine& line, const FlatLine& trunk) {
    const double front = nearest_on_line(trunk, line.front()).distance;
    const double back = nearest_on_line(trunk, line.back()).distance;
    const double near = 0.15 * line_length(line) + 10.0;
    if (front < near && back < near) return line.back().y < line.front().y;
    return back < front;
}

MendedBranch mend_branch(FlatLine line, const DrawnLine& trunk, const RepairOptions& options) {
    MendedBranch branch;
    branch.line = std::move(line);
    double taken = 0.0;
    for (int pass = 0; pass < 4 && branch.line.size() > 2 && mend_cluster(branch.line, taken, options);
         pass++)
        if (pass == 0) branch.repairs.push_back(StrokeRepair::kHook);
    for (int pass = 0; pass < 4; pass++) {
        bool changed = mend_crossing(branch, trunk, options);
        changed = mend_gap(branch, trunk, taken, options) || changed;
        if (!changed) break;
    }
    branch.attach = nearest_on_line(trunk.points, branch.line[0]);
    branch.line[0] = branch.attach.point;
    return branch;
}

}  // namespace treerec
