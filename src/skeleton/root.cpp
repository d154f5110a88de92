#include "skeleton/root.h"

#include <algorithm>
#include <cmath>

#include "geometry/bounds.h"
#include "geometry/groups.h"
#include "geometry/portable_math.h"

namespace treerec {

namespace {

constexpr double kLyingRatio = 0.55;    // height over width below which there is no upright trunk
constexpr double kGroupShare = 0.002;   // of the points: a smaller group is no trunk
constexpr size_t kGroupLeast = 6;       // points
constexpr double kSlabShare = 0.006;    // of the height: the slice that counts as the base
constexpr double kStemGapShare = 0.12;  // of the height: stems further from the base are other trees

// The group of linked points of each vertex: the smallest vertex in it.
std::vector<uint32_t> linked_groups(const PointGraph& graph, const LocalScale& scale) {
    Groups groups(graph.size());
    groups.join_all([&](uint32_t v, const auto& link) {
        for (uint32_t e = graph.begin[v]; e < graph.begin[v + 1]; e++) {
            const uint32_t n = graph.neighbour[e];
            if (n > v) break;  // they ascend
            if (graph.length[e] <= edge_reach(scale, v, n)) link(n);
        }
    });
    return groups.names();
}

uint32_t farthest(const PathTree& paths, const std::vector<uint8_t>& wood) {
    uint32_t best = paths.order.front();
    for (uint32_t v = 0; v < paths.along.size(); v++)
        if (wood[v] && paths.along[v] > paths.along[best]) best = v;
    return best;
}

// Root mean square distance of the points around `centre` from their main axis: how thick this end is.
double end_width(const std::vector<Vec3>& points, const DVec3& centre, double radius) {
    DVec3 mean(0.0);
    double count = 0.0;
    for (const Vec3& p : points)
        if (glm::distance(DVec3(p), centre) < radius) {
            mean += DVec3(p);
            count += 1.0;
        }
    mean /= count;
    DMat3 covariance(0.0);
    for (const Vec3& p : points)
        if (glm::distance(DVec3(p), centre) < radius) {
            const DVec3 d = DVec3(p) - mean;
            covariance += glm::outerProduct(d, d);
        }
    // Power iteration finds the axis; what is left of the trace is the cross-section.
    DVec3 axis = glm::normalize(DVec3(1.0, 0.9, 1.1));
    for (int i = 0; i < 50; i++)
        axis = normalized_or(covariance * axis, axis);
    const double trace = covariance[0][0] + covariance[1][1] + covariance[2][2];
    return std::sqrt(std::max(0.0, trace - glm::dot(axis, covariance * axis)) / count);
}

RootGuess root_at_end(const std::vector<Vec3>& points, const std::vector<uint8_t>& wood,
                      const PointGraph& graph, const LocalScale& scale, double diagonal) {
    SubProgress silent(nullptr, 0.0, 1.0);
    const uint32_t start = static_cast<uint32_t>(std::find(wood.begin(), wood.end(), 1) - wood.begin());
    const uint32_t first = farthest(shortest_paths(graph, scale, {{start, 0.0}}, silent), wood);
    const PathTree from_first = shortest_paths(graph, scale, {{first, 0.0}}, silent);
    const uint32_t second = farthest(from_first, wood);
    const double radius = 0.04 * diagonal;
    const bool take_first =
        end_width(points, DVec3(points[first]), radius) >= end_width(points, DVec3(points[second]), radius);
    const uint32_t end = take_first ? first : second;
    const PathTree paths = take_first ? from_first : shortest_paths(graph, scale, {{second, 0.0}}, silent);
    RootGuess root;
    root.lying = true;
    // The cut face is round: all within a little of the end vertex belong to the base.
    const double slab = 0.5 * radius;
    DVec3 sum(0.0);
    for (uint32_t v = 0; v < points.size(); v++) {
        if (paths.along[v] > slab) continue;
        root.seeds.push_back({v, 0.0});
        sum += DVec3(points[v]);
    }
    if (root.seeds.empty()) {
        root.seeds.push_back({end, 0.0});
        sum = DVec3(points[end]);
    }
    root.position = sum / static_cast<double>(root.seeds.size());
    return root;
}

}  // namespace

RootGuess find_root(const std::vector<Vec3>& points, const PointGraph& graph, const LocalScale& scale) {
    const std::vector<uint32_t> group = linked_groups(graph, scale);
    std::vector<size_t> members(points.size(), 0);
    std::vector<float> heights(points.size());
    std::vector<float> lowest(points.size(), std::numeric_limits<float>::max());
    for (size_t v = 0; v < points.size(); v++) {
        heights[v] = points[v].y;
        members[group[v]]++;
        lowest[group[v]] = std::min(lowest[group[v]], heights[v]);
    }
    size_t wanted =
        std::max(kGroupLeast, static_cast<size_t>(kGroupShare * static_cast<double>(points.size())));
    wanted = std::min(wanted, *std::max_element(members.begin(), members.end()));
    std::vector<uint8_t> wood(points.size());
    Bounds bounds;
    for (size_t v = 0; v < points.size(); v++) {
        wood[v] = members[group[v]] >= wanted;
        if (wood[v]) bounds.add(DVec3(points[v]));
    }
    const DVec3 size = bounds.size();
    if (size.y < kLyingRatio * std::max(size.x, size.z))
        return root_at_end(points, wood, graph, scale, bounds.diagonal());

    size_t base_group = points.size();
    for (size_t g = 0; g < points.size(); g++)
        if (members[g] >= wanted && (base_group == points.size() || lowest[g] < lowest[base_group]))
            base_group = g;

    RootGuess root;
    const double base = lowest[base_group];
    double slab = kSlabShare * size.y;
    // The first slab that has points enough to give a centre.
    auto in_slab = [&](size_t v) { return wood[v] && heights[v] >= base && heights[v] <= base + slab; };
    DVec3 centre(0.0);
    for (int widen = 0; widen < 8; widen++, slab *= 1.5) {
        centre = DVec3(0.0);
        size_t count = 0;
        for (size_t v = 0; v < points.size(); v++)
            if (group[v] == base_group && in_slab(v)) {
                centre += DVec3(points[v]);
                count++;
            }
        if (count > 0) centre /= static_cast<double>(count);
        if (count >= kGroupLeast) break;
    }
    // The middle of a ring wider than a stem, such as a house's walls, is empty: its nearest point serves.
    const auto across = [&](size_t v) {
        return portable::hypot(points[v].x - centre.x, points[v].z - centre.z);
    };
    size_t nearest = points.size();
    for (size_t v = 0; v < points.size(); v++)
        if (in_slab(v) && (nearest == points.size() || across(v) < across(nearest))) nearest = v;
    if (across(nearest) > kStemGapShare * size.y) centre = DVec3(points[nearest]);
    centre.y = base;
    // Other stems that stand as low belong to the same root.
    DVec3 sum(0.0);
    for (size_t v = 0; v < points.size(); v++) {
        const DVec3 p(points[v]);
        if (!in_slab(v) || portable::hypot(p.x - centre.x, p.z - centre.z) > kStemGapShare * size.y) continue;
        root.seeds.push_back({static_cast<uint32_t>(v), p.y - base});
        sum += p;
    }
    root.position = sum / static_cast<double>(root.seeds.size());
    root.position.y = base;
    return root;
}

}  // namespace treerec
