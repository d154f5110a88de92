// Twigs that grow at once are those that grow one after another.
#include "skeleton/twigs/twig_growth.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "geometry/random.h"

namespace treerec {
namespace {

constexpr int kStations = 400;  // of a pole, 5 cm apart

// Random shoots and stray points around a pole, and the pole itself.
std::vector<Vec3> thickets(Random& random) {
    std::vector<Vec3> points;
    for (int i = 0; i < kStations; i++)
        points.emplace_back(0.05, 0.05 * i, 0.0);
    const int shoots = 40 + static_cast<int>(random.below(60));
    for (int shoot = 0; shoot < shoots; shoot++) {
        const DVec3 way(random.normal(), random.normal(), random.normal());
        DVec3 p(0.05, 0.05 * kStations * random.uniform(), 0.0);
        const int steps = 3 + static_cast<int>(random.below(40));
        for (int i = 0; i < steps; i++) {
            p += 0.03 * normalized_or(way, DVec3(1, 0, 0)) +
                 0.008 * DVec3(random.normal(), random.normal(), random.normal());
            points.emplace_back(p);
        }
    }
    return points;
}

TEST(TwigGrowth, AtOnceGivesWhatOneByOneGives) {
    Random random(5);
    size_t twigs = 0;
    size_t on_twigs = 0;
    for (int trial = 0; trial < 25; trial++) {
        const std::vector<Vec3> points = thickets(random);
        SubProgress progress(nullptr, 0.0, 1.0);
        const PointGraph graph = neighbour_graph(points, progress);
        const LocalScale scale = local_scale(graph, 0.01);
        const PathTree paths = shortest_paths(graph, scale, {{0, 0.0}}, progress);
        std::vector<std::vector<Station>> axes(1);
        for (int i = 0; i < kStations; i++) {
            Station station;
            station.position = DVec3(0.0, 0.05 * i, 0.0);
            station.radius = 0.05;
            axes[0].push_back(station);
        }
        TwigOptions options;
        TwigField one{points, graph, scale, paths, options, axes};
        one.branch.assign(points.size(), -1);
        one.station.assign(points.size(), 0);
        one.outside.assign(points.size(), 0.0f);
        one.surface.assign(points.size(), 0.05f);
        one.nearest.assign(points.size(), -1);
        std::vector<uint64_t> tips;
        std::vector<float> length(points.size(), 0.0f);
        for (const uint32_t v : paths.order) {
            const float across = std::sqrt(points[v].x * points[v].x + points[v].z * points[v].z);
            one.outside[v] = across - 0.05f;
            if (across < 0.06f) {
                one.branch[v] = 0;
                one.station[v] = std::clamp(static_cast<int>(points[v].y / 0.05f), 0, kStations - 1);
            } else if (paths.parent[v] >= 0) {
                length[v] = length[static_cast<size_t>(paths.parent[v])] + paths.step[v];
                tips.push_back(farthest_first(length[v], v));
            }
        }
        TwigField all = one;
        const GrownTwigs expected = grow_one_by_one(one, tips, progress);
        const GrownTwigs grown = grow_twigs(all, tips, progress);
        ASSERT_EQ(grown.tips, expected.tips);
        EXPECT_TRUE(std::is_sorted(grown.tips.begin(), grown.tips.end()));
        for (size_t t = 0; t < expected.branches.size(); t++) {
            EXPECT_EQ(grown.branches[t].parent, expected.branches[t].parent);
            EXPECT_EQ(grown.branches[t].attach, expected.branches[t].attach);
            ASSERT_EQ(grown.axes[t].size(), expected.axes[t].size());
            for (size_t i = 0; i < grown.axes[t].size(); i++) {
                EXPECT_EQ(grown.axes[t][i].position, expected.axes[t][i].position);
                EXPECT_EQ(grown.axes[t][i].radius, expected.axes[t][i].radius);
            }
        }
        EXPECT_EQ(all.branch, one.branch);
        EXPECT_EQ(all.station, one.station);
        twigs += grown.branches.size();
        for (const SkeletonBranch& branch : grown.branches)
            on_twigs += branch.parent > 0 ? 1 : 0;
    }
    EXPECT_GT(twigs, 500u);
    EXPECT_GT(on_twigs, 50u);
}

}  // namespace
}  // namespace treerec
