#include "skeleton/geodesics/root.h"

#include <algorithm>
#include <cmath>

#include "geometry/bounds.h"
#include "geometry/circle_fit.h"
#include "geometry/portable_math.h"
#include "skeleton/cylinders/base_end.h"

namespace treerec {

namespace {

constexpr double kLyingRatio = 0.55;    // height over width below which there may be no upright trunk
constexpr double kUpright = 0.7;        // the least sine of such a trunk's slope at its base,
constexpr double kStemBaseShare = 0.1;  // and of the height: how far up the base may be
constexpr double kFaceShare = 0.02;     // of the diagonal: what belongs to a branch's cut face
constexpr double kGroupShare = 0.002;   // of the points: a smaller group is no trunk
constexpr size_t kGroupLeast = 6;       // points
constexpr double kSlabShare = 0.006;    // of the height: the slice that counts as the base
constexpr double kStemBaseReach =
    0.03;  // of the height: what lies so far from a known base belongs to its stem,
constexpr double kStemBaseAbove = 0.1;  // and so far above or below
constexpr double kStemGapShare = 0.12;  // of the height: stems further from the base are other trees

constexpr double kWidestStump = 1.5;    // radius, of the height
constexpr double kStumpSlab = 0.05;     // of the height: the lowest bark
constexpr double kStumpRough = 0.08;    // of its radius
constexpr double kStumpCoverage = 0.6;  // of the circle
constexpr double kStumpInside = 0.1;    // of the points
constexpr double kStumpReach = 1.3;     // radii

// The cut face is round: all within a little of the end belong to the base.
RootGuess root_at_end(const std::vector<Vec3>& points, const std::vector<uint8_t>& wood,
                      const PointGraph& graph, const LocalScale& scale, const DVec3& end, double slab,
                      Progress& progress) {
    const auto off = [&](uint32_t v) { return glm::distance(DVec3(points[v]), end); };
    uint32_t nearest = static_cast<uint32_t>(std::find(wood.begin(), wood.end(), 1) - wood.begin());
    for (uint32_t v = nearest; v < points.size(); v++)
        if (wood[v] && off(v) < off(nearest)) nearest = v;
    const PathTree paths = shortest_paths(graph, scale, {{nearest, 0.0}}, progress);
    RootGuess root;
    root.lying = true;
    DVec3 sum(0.0);
    for (uint32_t v = 0; v < points.size(); v++) {
        if (paths.along[v] > slab) continue;
        root.seeds.push_back({v, 0.0});
        sum += DVec3(points[v]);
    }
    root.position = sum / static_cast<double>(root.seeds.size());
    return root;
}

// The bark of a trunk that was cut off low, or scanned that far: wide for its height, but round.
std::optional<CircleFit> find_stump(const std::vector<Vec3>& points, const std::vector<uint8_t>& wood,
                                    double base, double height) {
    std::vector<DVec2> low;
    for (size_t v = 0; v < points.size(); v++)
        if (wood[v] && points[v].y <= base + kStumpSlab * height) low.emplace_back(points[v].x, points[v].z);
    const std::optional<CircleFit> circle = fit_circle(low, kWidestStump * height, Random(1));
    if (!circle || circle->radius < kStemGapShare * height || circle->spread > kStumpRough * circle->radius ||
        circle->coverage < kStumpCoverage || circle->inside > kStumpInside)
        return std::nullopt;
    return circle;
}

// The lowest slab of the stem that stands there; without seeds where none does.
RootGuess root_at_base(const std::vector<Vec3>& points, const std::vector<uint8_t>& wood,
                       const DVec3& stem_base, double height) {
    const auto beside = [&](size_t v) {
        return wood[v] && std::abs(points[v].y - stem_base.y) < kStemBaseAbove * height &&
               portable::hypot(points[v].x - stem_base.x, points[v].z - stem_base.z) <
                   kStemBaseReach * height;
    };
    RootGuess root;
    std::vector<float> heights;
    for (size_t v = 0; v < points.size(); v++)
        if (beside(v)) heights.push_back(points[v].y);
    if (heights.size() < kGroupLeast) return root;
    std::nth_element(heights.begin(), heights.begin() + kGroupLeast - 1, heights.end());
    const double base = *std::min_element(heights.begin(), heights.begin() + kGroupLeast);
    const double top = std::max<double>(base + kSlabShare * height, heights[kGroupLeast - 1]);
    DVec3 sum(0.0);
    for (size_t v = 0; v < points.size(); v++) {
        if (!beside(v) || points[v].y > top) continue;
        root.seeds.push_back({static_cast<uint32_t>(v), points[v].y - base});
        sum += DVec3(points[v]);
    }
    root.position = sum / static_cast<double>(root.seeds.size());
    root.position.y = base;
    return root;
}

}  // namespace

RootGuess find_root(const std::vector<Vec3>& points, const PointGraph& graph, const LocalScale& scale,
                    const std::optional<DVec3>& stem_base, Progress& progress, PassSet left_out) {
    const std::vector<uint32_t> group = pieces_of(graph, scale);
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
    if (stem_base) {
        RootGuess root = root_at_base(points, wood, *stem_base, size.y);
        if (!root.seeds.empty()) return root;
    }
    if (size.y < kLyingRatio * std::max(size.x, size.z)) {
        std::vector<Vec3> of_wood;
        for (size_t v = 0; v < points.size(); v++)
            if (wood[v]) of_wood.push_back(points[v]);
        const BaseEnd base = find_base_end(of_wood, progress, left_out);
        // A spreading tree is wider than high, too.
        const bool stands =
            base.direction.y > kUpright && base.position.y < bounds.min.y + kStemBaseShare * size.y;
        if (!stands)
            return root_at_end(points, wood, graph, scale, base.position, kFaceShare * bounds.diagonal(),
                               progress);
    }

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
    double reach = kStemGapShare * size.y;
    if (const std::optional<CircleFit> stump = find_stump(points, wood, base, size.y)) {
        centre = DVec3(stump->centre.x, base, stump->centre.y);
        reach = kStumpReach * stump->radius;
        slab = std::max(slab, kStumpSlab * size.y);
    } else if (across(nearest) > reach) {
        centre = DVec3(points[nearest]);
    }
    centre.y = base;
    // Other stems that stand as low belong to the same root.
    DVec3 sum(0.0);
    for (size_t v = 0; v < points.size(); v++) {
        const DVec3 p(points[v]);
        if (!in_slab(v) || portable::hypot(p.x - centre.x, p.z - centre.z) > reach) continue;
        root.seeds.push_back({static_cast<uint32_t>(v), p.y - base});
        sum += p;
    }
    root.position = sum / static_cast<double>(root.seeds.size());
    root.position.y = base;
    return root;
}

double extent_from(const std::vector<Vec3>& points, const DVec3& root) {
    double extent = 0.0;
    for (const Vec3& p : points)
        extent = std::max(extent, glm::distance(DVec3(p), root));
    return extent;
}

}  // namespace treerec
