#include "sketch/branch_depth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "error.h"
#include "geometry/capsule_tree.h"
#include "geometry/portable_math.h"
#include "sketch/branch_plane.h"
#include "tree/wood_segments.h"

namespace treerec {

namespace {

constexpr double kFringe = 2.0;    // tolerances, as of unexplained points
constexpr double kCell = 0.08;     // metres of depth that a group of points may have
constexpr size_t kMostGroups = 8;  // at a sample
constexpr size_t kFarthest = 14;   // samples from one stop to the next
constexpr double kEnough = 2.5;    // points that are two thirds of all support
constexpr double kFree = 0.15;     // metres between stops that need no points
constexpr double kLook = 0.09;     // metres: points so near a leap support it
constexpr double kAir = 4.0;       // per metre of a leap without
constexpr double kSkip = 0.12;     // per sample without a stop
constexpr double kSagitta = 0.06;  // metres off the line between its neighbours: costs a half
constexpr double kFreeBend = 35.0 * kPi / 180.0;
constexpr double kBend = 10.0 * kPi / 180.0;  // beyond it: costs one
constexpr double kLeast = 2.5;                // score of a path that is one
constexpr size_t kLeastStops = 4;

struct Group {
    size_t sample;
    DVec3 place;  // tree space
    double support;
};

// The line's nearest sample, and how many pixels away the line is there.
std::pair<size_t, double> nearest_sample(const std::vector<DVec2>& line, const DVec2& p) {
    double best = std::numeric_limits<double>::max();
    size_t at = 0;
    for (size_t i = 0; i < line.size(); i++) {
        const DVec2 d = p - line[i];
        if (glm::dot(d, d) >= best) continue;
        best = glm::dot(d, d);
        at = i;
    }
    const DVec2 way = line[std::min(at + 1, line.size() - 1)] - line[at > 0 ? at - 1 : 0];
    const double length = glm::length(way);
    const DVec2 d = p - line[at];
    // Beyond its ends it goes no farther.
    const double across = length > 0.0 ? std::abs(way.x * d.y - way.y * d.x) / length : glm::length(d);
    const double along = length > 0.0 ? std::abs(glm::dot(way, d)) / length : 0.0;
    const bool end = at == 0 || at + 1 == line.size();
    return {at, end ? portable::hypot(across, along) : across};
}

double angle_between(const DVec3& a, const DVec3& b) {
    return portable::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

double bend_cost(const DVec3& a, const DVec3& b, const DVec3& c) {
    const DVec3 ab = b - a, bc = c - b, ac = c - a;
    const double chord = glm::length(ac);
    const double sagitta = chord > 1e-9 ? glm::length(glm::cross(ab, ac)) / chord : glm::length(ab);
    const double beyond = std::max(0.0, angle_between(ab, bc) - kFreeBend) / kBend;
    return 0.5 * (sagitta / kSagitta) * (sagitta / kSagitta) + beyond;
}

std::vector<Group> groups_of(const std::vector<Vec3>& points, const PinholeView& view,
                             const std::vector<DVec2>& line, double jitter) {
    struct Seen {
        double depth;
        DVec3 place;
        double weight;
    };
    std::vector<std::vector<Seen>> by_sample(line.size());
    for (const Vec3& p : points) {
        const auto pixel = view.project(DVec3(p));
        if (!pixel) continue;
        const auto [at, apart] = nearest_sample(line, *pixel);
        const double weight = portable::exp(-0.5 * (apart / jitter) * (apart / jitter));
        by_sample[at].push_back({-into_camera(view, DVec3(p)).z, DVec3(p), weight});
    }
    std::vector<Group> groups;
    for (size_t i = 1; i < line.size(); i++) {
        std::vector<Seen>& seen = by_sample[i];
        std::stable_sort(seen.begin(), seen.end(),
                         [](const Seen& a, const Seen& b) { return a.depth < b.depth; });
        std::vector<Group> here;
        for (size_t begin = 0; begin < seen.size();) {
            DVec3 sum(0.0);
            double weights = 0.0;
            size_t end = begin;
            for (; end < seen.size() && seen[end].depth - seen[begin].depth <= kCell; end++) {
                sum += seen[end].place * seen[end].weight;
                weights += seen[end].weight;
            }
            if (weights > 0.02) here.push_back({i, sum / weights, 1.0 - portable::exp(-weights / kEnough)});
            begin = end;
        }
        std::stable_sort(here.begin(), here.end(),
                         [](const Group& a, const Group& b) { return a.support > b.support; });
        if (here.size() > kMostGroups) here.resize(kMostGroups);
        groups.insert(groups.end(), here.begin(), here.end());
    }
    return groups;
}

// Metres of the leap that have no points near them.
double air_between(const PointTree& points, const DVec3& from, const DVec3& to) {
    const double length = glm::distance(from, to);
    if (length <= kFree) return 0.0;
    const int steps = std::min(40, static_cast<int>(std::ceil(length / kFree)));
    int missing = 0;
    for (int i = 1; i < steps; i++) {
        const DVec3 at = from + (to - from) * (static_cast<double>(i) / steps);
        uint32_t index = 0;
        float square = 0.0F;
        const bool near = points.nearest(Vec3(at), 1, &index, &square) > 0 && square < kLook * kLook;
        missing += near ? 0 : 1;
    }
    return length * missing / steps;
}

}  // namespace

std::vector<Vec3> points_beside(const Tree& tree, const PointCloud& cloud, const std::vector<uint8_t>& wood,
                                const PinholeView& view, const std::vector<DVec2>& line, double reach,
                                double tolerance, const Progress* progress) {
    if (!wood.empty() && wood.size() != cloud.size())
        throw Error("There must be one mark of wood for each of the cloud's points.");
    DVec2 low = line[0], high = line[0];
    for (const DVec2& p : line) {
        low = glm::min(low, p - reach);
        high = glm::max(high, p + reach);
    }
    const bool as_it_is = cloud.frame == tree.frame();
    const CapsuleTree bark(wood_segments(tree));
    const double clear = kFringe * tolerance;
    std::vector<Vec3> points;
    int32_t hint = -1;
    for (size_t i = 0; i < cloud.size(); i++) {
        if (progress && (i & 0xfff) == 0) progress->check();
        if (!wood.empty() && wood[i] == 0) continue;
        const DVec3 p = as_it_is ? DVec3(cloud.positions[i])
                                 : tree.frame().to_tree(cloud.frame.to_scan(DVec3(cloud.positions[i])));
        if (!is_finite(p)) continue;
        const auto pixel = view.project(p);
        if (!pixel || pixel->x < low.x || pixel->y < low.y || pixel->x > high.x || pixel->y > high.y)
            continue;
        if (nearest_sample(line, *pixel).second > reach) continue;
        if (!bark.empty()) {
            const CapsuleTree::Hit axis = bark.nearest_axis(p, hint);
            hint = axis.segment;
            if (axis.distance <= bark.segment(axis.segment).radius + clear) continue;
            int32_t nearest = hint;
            if (bark.surface_distance(p, nearest) <= clear) continue;
        }
        points.emplace_back(p);
    }
    std::sort(points.begin(), points.end(), [](const Vec3& a, const Vec3& b) {
        return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
    });
    return points;
}

BranchPath find_path(const std::vector<Vec3>& points, const PinholeView& view, const std::vector<DVec2>& line,
                     const DVec3& joint, double jitter, const Progress* progress) {
    BranchPath path;
    if (points.size() < kLeastStops) return path;
    const PointTree near(points);
    std::vector<Group> groups{{0, joint, 0.0}};
    const std::vector<Group> found = groups_of(points, view, line, jitter);
    groups.insert(groups.end(), found.begin(), found.end());

    // A step from one group to another; steps into the same group lie together, ordered by sample.
    struct Step {
        uint32_t from, to;
        double cost;          // of the leap and the samples that it skips, less the support of `to`
        double best = 0.0;    // the least cost of a way that ends with it
        int32_t before = -1;  // the step before it on that way; -1: it leaves the joint
    };
    std::vector<Step> steps;
    std::vector<size_t> begin(groups.size() + 1, 0);
    size_t first = 0;
    int32_t last = -1;
    double least = 0.0;
    for (uint32_t to = 0; to < groups.size(); to++) {
        begin[to] = steps.size();
        if (to == 0) continue;
        if (progress) progress->check();
        const Group& there = groups[to];
        while (groups[first].sample + kFarthest < there.sample)
            first++;
        for (uint32_t from = static_cast<uint32_t>(first); from < to; from++) {
            const Group& here = groups[from];
            if (here.sample >= there.sample) break;
            // A group that no way leads to.
            if (from != 0 && begin[from] == begin[from + 1]) continue;
            Step step{from, to, 0.0};
            step.cost = kSkip * static_cast<double>(there.sample - here.sample - 1) +
                        kAir * air_between(near, here.place, there.place) - there.support;
            if (from == 0) {
                step.best = step.cost;
            } else {
                step.best = std::numeric_limits<double>::max();
                for (size_t s = begin[from]; s < begin[from + 1]; s++) {
                    const double cost = steps[s].best + step.cost +
                                        bend_cost(groups[steps[s].from].place, here.place, there.place);
                    if (cost >= step.best) continue;
                    step.best = cost;
                    step.before = static_cast<int32_t>(s);
                }
            }
            if (step.best < least) {
                least = step.best;
                last = static_cast<int32_t>(steps.size());
            }
            steps.push_back(step);
        }
        begin[to + 1] = steps.size();
    }
    if (-least < kLeast) return path;
    for (int32_t s = last; s >= 0; s = steps[static_cast<size_t>(s)].before) {
        const Group& group = groups[steps[static_cast<size_t>(s)].to];
        path.stops.push_back({group.sample, group.place});
    }
    std::reverse(path.stops.begin(), path.stops.end());
    if (path.stops.size() < kLeastStops)
        path.stops.clear();
    else
        path.score = -least;
    return path;
}

}  // namespace treerec
