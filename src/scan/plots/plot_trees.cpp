#include "scan/plots/plot_trees.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "geometry/circle_fit.h"
#include "geometry/quantile.h"
#include "scan/cleaning/clean_cloud.h"
#include "scan/stems/tree_heights.h"

namespace treerec {

namespace {

constexpr double kBorder = 1.0;     // metres: so far outside of the core a stem is kept for the time being
constexpr double kSamePlace = 0.6;  // metres between two feet that are one tree's, as in stem_rules.h
constexpr size_t kFewestPoints = 200;
constexpr size_t kFewPoints = 3000;     // below them the shape is a guess
constexpr double kWidestCrown = 0.45;   // of the height, as in separate_trees.cpp
constexpr double kWidestFoot = 0.12;    // of the height: what is wider is no single stem
constexpr double kBreastHeight = 1.3;   // metres
constexpr double kBreastSlice = 0.12;   // metres to either side
constexpr double kWidestStem = 1.0;     // metres, its radius
constexpr double kLeastCoverage = 0.4;  // of the circle
constexpr double kMostInside = 0.15;    // of the points: wood hides what is in it
constexpr double kEdge = 0.25;          // metres: a crown that comes so close to the scan's edge is cut by it

double distance(const DVec3& a, const DVec3& b) {
    return std::sqrt((a.x - b.x) * (a.x - b.x) + (a.z - b.z) * (a.z - b.z));
}

// A circle through what is seen of a stem around one height above its foot; whatever the points' order.
std::optional<CircleFit> stem_circle(const PointCloud& cloud, const std::vector<uint32_t>& of_tree,
                                     const DVec3& foot, double height, double reach) {
    std::vector<DVec2> section;
    for (const uint32_t i : of_tree) {
        const DVec3 p(cloud.positions[i]);
        if (std::abs(p.y - foot.y - height) <= kBreastSlice && distance(p, foot) <= reach)
            section.emplace_back(p.x, p.z);
    }
    std::sort(section.begin(), section.end(),
              [](const DVec2& a, const DVec2& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
    const std::optional<CircleFit> circle = fit_circle(section, kWidestStem, Random(1));
    constexpr double kSharp = 0.03, kSharpShare = 0.03;  // metres; of the radius
    if (!circle || circle->coverage < kLeastCoverage || circle->inside > kMostInside ||
        circle->spread > kSharp + kSharpShare * circle->radius)
        return std::nullopt;
    return circle;
}

// Of two sections that show one stem, or 0: among leaves and shrubs circles are found too, but not twice the
// same.
double dbh_within(const PointCloud& cloud, const std::vector<uint32_t>& of_tree, const DVec3& foot,
                  double reach) {
    std::vector<CircleFit> circles;
    for (const double height : {kBreastHeight, kBreastHeight - 0.3, kBreastHeight + 0.3})
        if (const auto circle = stem_circle(cloud, of_tree, foot, height, reach)) circles.push_back(*circle);
    for (size_t a = 0; a < circles.size(); a++)
        for (size_t b = a + 1; b < circles.size(); b++) {
            const double radius = 0.5 * (circles[a].radius + circles[b].radius);
            if (std::abs(circles[a].radius - circles[b].radius) < 0.2 * radius &&
                glm::distance(circles[a].centre, circles[b].centre) < 0.05 + 0.3 * radius)
                return a == 0 ? 2.0 * circles[0].radius : 2.0 * radius;
        }
    return 0.0;
}

// Near the foot first, where fewer branches are in the way.
double measure_dbh(const PointCloud& cloud, const std::vector<uint32_t>& of_tree, const DVec3& foot) {
    for (const double reach : {0.4, 0.8, 1.5})
        if (const double dbh = dbh_within(cloud, of_tree, foot, reach); dbh > 0.0) return dbh;
    return 0.0;
}

// Where nothing but one tree stands: its foot, and the points near enough to be its. False where there is no
// single stem.
bool stand_alone(const PointCloud& cloud, std::vector<uint32_t>& of_tree, DVec3& foot) {
    std::vector<Vec3> points;
    for (const uint32_t i : of_tree)
        points.push_back(cloud.positions[i]);
    const TreeHeights heights(points);
    std::vector<float> x, z;
    for (const Vec3& p : points)
        if (heights.of(p) < TreeHeights::kFootTop / 3.0) {
            x.push_back(p.x);
            z.push_back(p.z);
        }
    if (x.size() < 10) return false;
    const auto middle = [](std::vector<float>& values, double& spread) {
        spread = static_cast<double>(quantile(values, 0.8) - quantile(values, 0.2));
        return static_cast<double>(quantile(values, 0.5));
    };
    double spread_x = 0.0, spread_z = 0.0;
    foot.x = middle(x, spread_x);
    foot.z = middle(z, spread_z);
    std::vector<float> y;
    for (const Vec3& p : points)
        y.push_back(p.y);
    foot.y = quantile(y, 0.002);
    std::erase_if(of_tree, [&](uint32_t i) {
        return distance(DVec3(cloud.positions[i]), foot) > kWidestCrown * heights.metres();
    });
    return std::max(spread_x, spread_z) < kWidestFoot * heights.metres();
}

void add_warnings(PlotTree& tree, const Range& x, const Range& z, const TileCore& plot, bool alone) {
    if (tree.points < kFewPoints) tree.warnings.emplace_back("few points");
    if (tree.dbh == 0.0) tree.warnings.emplace_back("no round stem is seen at breast height");
    if (x.low < plot.x.low + kEdge || x.high > plot.x.high - kEdge || z.low < plot.z.low + kEdge ||
        z.high > plot.z.high - kEdge)
        tree.warnings.emplace_back("it reaches the edge of the scan");
    if (alone) tree.warnings.emplace_back("it stands alone, and all around it was taken for its own");
}

}  // namespace

TileTrees find_tile_trees(const PointCloud& cloud, const TileCore& core, const TileCore& plot,
                          double least_height, Progress* progress) {
    TileTrees found;
    if (cloud.size() < kFewestPoints) return found;
    PickReport pick;
    PointCloud places;
    places.frame = cloud.frame;
    places.positions = cloud.positions;
    const std::vector<uint32_t> labels = label_plot(std::move(places), {}, pick, progress);
    std::vector<std::vector<uint32_t>> of_tree(std::max<size_t>(1, pick.trees.size()));
    for (uint32_t i = 0; i < labels.size(); i++) {
        if (labels[i] == kOnGround)
            found.ground.push_back(i);
        else if (labels[i] != kNoTree)
            of_tree[labels[i]].push_back(i);
    }
    for (size_t t = 0; t < of_tree.size(); t++) {
        if (progress) progress->check();
        if (of_tree[t].size() < kFewestPoints) continue;
        const bool alone = pick.trees.empty();
        PlotTree tree;
        if (!alone)
            tree.foot = cloud.frame.to_tree(pick.trees[t].foot);
        else if (!stand_alone(cloud, of_tree[t], tree.foot))
            continue;
        tree.depth = core.depth(tree.foot.x, tree.foot.z);
        if (tree.depth < -kBorder) continue;
        std::vector<float> x, y, z;
        for (const uint32_t i : of_tree[t]) {
            x.push_back(cloud.positions[i].x);
            y.push_back(cloud.positions[i].y);
            z.push_back(cloud.positions[i].z);
        }
        const auto range = [](const std::vector<float>& values) {
            const auto [low, high] = std::minmax_element(values.begin(), values.end());
            return Range{static_cast<double>(*low), static_cast<double>(*high)};
        };
        tree.height = static_cast<double>(quantile(y, 0.9995)) - tree.foot.y;
        if (tree.height < least_height) continue;
        tree.points = of_tree[t].size();
        tree.dbh = measure_dbh(cloud, of_tree[t], tree.foot);
        add_warnings(tree, range(x), range(z), plot, alone);
        found.trees.push_back(std::move(tree));
        found.points.push_back(std::move(of_tree[t]));
    }
    return found;
}

std::vector<size_t> choose_plot_trees(const std::vector<PlotTree>& trees) {
    std::vector<size_t> deepest(trees.size());
    std::iota(deepest.begin(), deepest.end(), size_t{0});
    std::stable_sort(deepest.begin(), deepest.end(),
                     [&](size_t a, size_t b) { return trees[a].depth > trees[b].depth; });
    std::vector<size_t> chosen;
    std::vector<uint8_t> met(trees.size());
    for (const size_t t : deepest) {
        if (met[t]) continue;
        bool twice = false;
        for (size_t other = 0; other < trees.size(); other++)
            if (trees[other].tile != trees[t].tile && !met[other] &&
                distance(trees[other].foot, trees[t].foot) < kSamePlace) {
                met[other] = 1;
                twice = true;
            }
        // Outside of its core the tile that holds it sees better, and has found none there.
        if (trees[t].depth >= 0.0 || twice) chosen.push_back(t);
    }
    std::sort(chosen.begin(), chosen.end(), [&](size_t a, size_t b) {
        const DVec3 &p = trees[a].foot, &q = trees[b].foot;
        return p.x != q.x ? p.x < q.x : p.z < q.z;
    });
    return chosen;
}

}  // namespace treerec
