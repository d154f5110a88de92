// AdTree's own way to a skeleton, over the edges of the Delaunay triangulation.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "error.h"
#include "fidelity/score.h"
#include "geometry/random.h"
#include "skeleton/delaunay/initial_skeleton.h"
#include "skeleton/delaunay/simplify.h"
#include "skeleton/delaunay/triangulate.h"
#include "skeleton/delaunay/trunk_cylinder.h"
#include "skeleton/skeleton.h"
#include "synth/grow.h"
#include "synth/scan.h"
#include "tree/measure.h"

namespace treerec {
namespace {

constexpr SpanningTreeKind kKinds[] = {SpanningTreeKind::kShortestPaths, SpanningTreeKind::kMinimum};

SkeletonOptions by(SpanningTreeKind kind) {
    SkeletonOptions options;
    options.method = SkeletonMethod::kDelaunay;
    options.spanning_tree = kind;
    return options;
}

std::vector<Vec3> random_points(uint64_t seed, int count) {
    Random random(seed);
    std::vector<Vec3> points;
    for (int i = 0; i < count; i++)
        points.emplace_back(random.uniform(-1, 1), random.uniform(0, 3), random.uniform(-1, 1));
    return points;
}

// Points on wood from `from` to `to`, which narrows to `last` of its radius.
std::vector<Vec3> bark(const DVec3& from, const DVec3& to, double radius, int count, uint64_t seed,
                       double last = 1.0) {
    Random random(seed);
    const DVec3 axis = glm::normalize(to - from), u = any_perpendicular(axis), v = glm::cross(axis, u);
    std::vector<Vec3> points;
    for (int i = 0; i < count; i++) {
        const double turn = random.uniform(0.0, 2.0 * kPi);
        const double at = random.uniform();
        points.emplace_back(from + at * (to - from) +
                            radius * (1.0 + at * (last - 1.0)) * (std::cos(turn) * u + std::sin(turn) * v));
    }
    return points;
}

PointCloud cloud_of(std::vector<Vec3> points) {
    PointCloud cloud;
    cloud.positions = std::move(points);
    return cloud;
}

// Its edges are what the definition says: a tetrahedron's sphere is empty, so no other point lies in the
// smallest ball of every nearest pair.
TEST(Delaunay, HasEveryNearestNeighbourAndIsConnected) {
    Progress progress;
    for (const uint64_t seed : {1, 2, 3}) {
        const std::vector<Vec3> points = random_points(seed, 300);
        const PointGraph graph = delaunay_graph(points, progress);
        ASSERT_EQ(graph.size(), points.size());
        for (uint32_t v = 0; v < points.size(); v++) {
            uint32_t nearest = v == 0 ? 1 : 0;
            for (uint32_t n = 0; n < points.size(); n++)
                if (n != v && glm::distance(points[n], points[v]) < glm::distance(points[nearest], points[v]))
                    nearest = n;
            EXPECT_TRUE(find_edge(graph, {v, nearest}).has_value());
        }
        for (const SpanningTreeKind kind : kKinds)
            EXPECT_EQ(spanning_tree(graph, 0, kind, progress).order.size(), points.size());
    }
}

TEST(Delaunay, ItsMinimumSpanningTreeIsThatOfAllPairs) {
    Progress progress;
    const std::vector<Vec3> points = random_points(7, 200);
    const PathTree tree =
        spanning_tree(delaunay_graph(points, progress), 0, SpanningTreeKind::kMinimum, progress);
    double length = 0.0;
    for (const float step : tree.step)
        length += step;
    // Prim's over the complete graph.
    std::vector<float> off(points.size(), 1e9F);
    std::vector<uint8_t> in(points.size(), 0);
    double least = 0.0;
    off[0] = 0.0F;
    for (size_t round = 0; round < points.size(); round++) {
        size_t v = points.size();
        for (size_t n = 0; n < points.size(); n++)
            if (!in[n] && (v == points.size() || off[n] < off[v])) v = n;
        in[v] = 1;
        least += off[v];
        for (size_t n = 0; n < points.size(); n++)
            off[n] = std::min(off[n], glm::distance(points[n], points[v]));
    }
    EXPECT_NEAR(length, least, 1e-4 * least);
}

TEST(Delaunay, MeasuresALeaningTrunk) {
    Progress progress;
    const DVec3 way = glm::normalize(DVec3(0.3, 1.0, -0.2));
    for (const double radius : {0.04, 0.1, 0.25}) {
        const std::vector<Vec3> points = bark(DVec3(0.0), 8.0 * way, radius, 4000, 5);
        for (const SpanningTreeKind kind : kKinds) {
            const InitialSkeleton skeleton = initial_skeleton(points, DVec3(0.0), kind, progress);
            const auto trunk = fit_trunk_cylinder(points, skeleton, true, 1);
            ASSERT_TRUE(trunk.has_value());
            EXPECT_TRUE(trunk->measured);
            EXPECT_NEAR(trunk->radius, radius, 0.01 * radius);
            EXPECT_GT(std::abs(glm::dot(trunk->axis, way)), std::cos(0.02));
            EXPECT_FALSE(fit_trunk_cylinder(points, skeleton, false, 1)->measured);
        }
    }
}

TEST(Delaunay, ThinsOutwardsByAllometry) {
    TrunkCylinder trunk;
    trunk.radius = 0.2;
    trunk.reach = 10.0;
    EXPECT_DOUBLE_EQ(allometric_radius(trunk, 10.0), 0.2);
    EXPECT_NEAR(allometric_radius(trunk, 5.0), 0.2 * std::pow(0.5, 1.1), 1e-9);
    EXPECT_DOUBLE_EQ(allometric_radius(trunk, 0.0), 0.001);
}

// A stem and one branch that taper: both are found to their ends, and as thick as they are.
TEST(Delaunay, FollowsAStemAndABranch) {
    std::vector<Vec3> points = bark(DVec3(0.0), DVec3(0, 5, 0), 0.1, 12000, 3, 0.1);
    const std::vector<Vec3> branch = bark(DVec3(0, 2, 0), DVec3(2, 4, 0), 0.05, 4000, 4, 0.1);
    points.insert(points.end(), branch.begin(), branch.end());
    for (const SpanningTreeKind kind : kKinds) {
        const SkeletonResult made = skeletonize(cloud_of(points), by(kind));
        ASSERT_EQ(made.tree.check(), std::nullopt);
        bool top = false, tip = false;
        for (const NodeId id : made.tree.nodes_of_kind(NodeKind::kLeaf)) {
            const DVec3 place = made.tree.frame().to_scan(made.tree.node(id).position);
            top = top || glm::distance(place, DVec3(0, 5, 0)) < 0.1;
            tip = tip || glm::distance(place, DVec3(2, 4, 0)) < 0.1;
        }
        EXPECT_TRUE(top && tip);
        EXPECT_NEAR(measure(made.tree).height, 5.0, 0.1);
        EXPECT_NEAR(measure(made.tree).dbh, 0.2 * (1.0 - 0.9 * 1.3 / 5.0), 0.04);
        EXPECT_GT(made.raw.size(), 5000U);
    }
}

// Grown trees, whose every branch is known: not as near as our own way, but near.
TEST(Delaunay, FindsMostOfAGrownTree) {
    for (const Habit habit : {Habit::kBroadleaf, Habit::kConifer}) {
        const Tree truth = grow_tree({habit, 0.0, 3});
        VirtualScanOptions options = scan_options_for(habit);
        options.seed = 3;
        const PointCloud cloud = scan_tree(truth, options).cloud;
        for (const SpanningTreeKind kind : kKinds) {
            const SkeletonResult made = skeletonize(cloud, by(kind));
            ASSERT_EQ(made.tree.check(), std::nullopt);
            const SkeletonScore score = score_skeleton(made.tree, truth);
            EXPECT_GT(score.by_distance[2].f, 0.75) << spanning_tree_kind_name(kind);
        }
    }
}

// The same tree for any order of the points, and whatever map they stand on.
TEST(Delaunay, IsTheSameEachTime) {
    const Tree truth = grow_tree({Habit::kBroadleaf, 4.0, 5});
    VirtualScanOptions scanning = scan_options_for(Habit::kBroadleaf);
    scanning.points = 8000;
    std::vector<Vec3> points = scan_tree(truth, scanning).cloud.positions;
    std::vector<Vec3> turned(points.rbegin(), points.rend());
    turned.insert(turned.end(), points.begin(), points.begin() + 500);  // some of them twice
    for (const SpanningTreeKind kind : kKinds) {
        const SkeletonResult a = skeletonize(cloud_of(points), by(kind));
        const SkeletonResult b = skeletonize(cloud_of(turned), by(kind));
        ASSERT_EQ(a.tree.size(), b.tree.size());
        for (NodeId id = 0; id < a.tree.id_end(); id++) {
            EXPECT_EQ(a.tree.node(id).position, b.tree.node(id).position);
            EXPECT_EQ(a.tree.node(id).radius, b.tree.node(id).radius);
        }
    }
}

// A tree or a sentence.
TEST(Delaunay, OddCloudsGetATreeOrASentence) {
    std::vector<std::vector<Vec3>> clouds = {{}, {Vec3(0), Vec3(0, 1, 0)}};
    for (int kind = 0; kind < 7; kind++) {
        std::vector<Vec3> points;
        for (int i = 0; i < 400; i++) {
            const float t = 0.01F * static_cast<float>(i), s = 0.1F * static_cast<float>(i % 20);
            if (kind == 0) points.emplace_back(0, t, 0);                             // on a line
            if (kind == 1) points.emplace_back(s, 0.1F * (i / 20), 0);               // on a plane
            if (kind == 2) points.emplace_back(0.5F, 0.5F, 0.5F);                    // one place
            if (kind == 3) points.emplace_back(s, 0.1F * (i / 20), 0.1F * (i % 7));  // a lattice: cospherical
            if (kind == 4)
                points.emplace_back(400000.0F + s, 5000000.0F + t, 0.5F * (i % 3));  // a map, rounded
            if (kind == 5) points.emplace_back(std::cos(t), 1.0F + std::sin(t) * s, std::sin(7 * t));
            if (kind == 6 && i < 11) points.emplace_back(s * s, t, 0.1F * (i % 3));
        }
        clouds.push_back(points);
    }
    for (size_t c = 0; c < clouds.size(); c++)
        for (const SpanningTreeKind kind : kKinds) {
            SCOPED_TRACE(c);
            try {
                const SkeletonResult made = skeletonize(cloud_of(clouds[c]), by(kind));
                EXPECT_EQ(made.tree.check(), std::nullopt);
                EXPECT_GE(made.tree.size(), 1U);
            } catch (const Error& error) {
                EXPECT_GT(std::string(error.what()).size(), 20U);
            }
        }
    Progress progress;
    EXPECT_THROW(delaunay_graph({Vec3(0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(1, 1, 0)}, progress), Error);
}

TEST(Delaunay, StopsWhenItIsAskedTo) {
    struct Stopped : Progress {
        bool cancelled() const override { return true; }
    } stopped;
    EXPECT_THROW(delaunay_graph(random_points(1, 50), stopped), Cancelled);
    EXPECT_THROW(skeletonize(cloud_of(random_points(1, 500)), by(SpanningTreeKind::kMinimum), &stopped),
                 Cancelled);
}

TEST(Delaunay, ItsWordsAreReadAndWritten) {
    EXPECT_EQ(parse_skeleton_method("delaunay"), SkeletonMethod::kDelaunay);
    EXPECT_EQ(parse_skeleton_method("geodesic"), SkeletonMethod::kGeodesic);
    for (const SpanningTreeKind kind : kKinds)
        EXPECT_EQ(parse_spanning_tree_kind(spanning_tree_kind_name(kind)), kind);
    EXPECT_THROW(parse_spanning_tree_kind("shortest"), Error);
}

}  // namespace
}  // namespace treerec
