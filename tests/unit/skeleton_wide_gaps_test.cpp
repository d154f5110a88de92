#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "cases.h"
#include "skeleton/skeleton.h"
#include "skeleton_test_clouds.h"

namespace treerec {
namespace {

using test::add_bend;
using test::add_cone;

constexpr double kForkHeight = 0.9;

// A point of a stem that leans out of the fork, by direction and height.
DVec3 on_stem(double turn, double height) {
    const double out = 0.45 * (height - kForkHeight);
    return {out * std::cos(turn), height, out * std::sin(turn)};
}

// Three stems out of one fork with a slab cut out of them. Above it, boughs from stem to stem touch; and a
// low bough ends right below one that hangs down, where the gap is the narrowest.
PointCloud cut_tree(uint64_t seed, double from, double to) {
    Random random(seed);
    PointCloud whole;
    const DVec3 fork(0.0, kForkHeight, 0.0);
    add_cone(whole, random, {0, 0, 0}, fork, 0.12, 0.11, 0.015, 0.002);
    for (const double turn : {0.0, 2.1, 4.2}) {
        add_cone(whole, random, fork, on_stem(turn, 4.5), 0.06, 0.03, 0.012, 0.001);
        add_cone(whole, random, on_stem(turn, 3.2), on_stem(turn + 2.1, 3.6), 0.015, 0.01, 0.01, 0.001);
    }
    const DVec3 low(1.6, from - 0.02, 0.3);
    add_cone(whole, random, {0.0, 0.8, 0.0}, low, 0.03, 0.012, 0.01, 0.001);
    add_bend(whole, random, {on_stem(0.0, 3.0), {1.8, 2.6, 0.3}, low + DVec3(0.1, 0.7 * (to - from), 0.0)},
             0.025, 0.01, 0.01, 0.001);
    PointCloud cloud;
    cloud.frame = whole.frame;
    for (const Vec3& p : whole.positions)
        if (p.y < from || p.y > to || p.x > 1.4F) cloud.positions.push_back(p);
    return cloud;
}

// The way from the node next to a place down to the root, metres.
double way_down(const Tree& tree, const PointCloud& cloud, const DVec3& place) {
    const auto off = [&](NodeId id) {
        return glm::distance(cloud.frame.to_tree(tree.frame().to_scan(tree.node(id).position)), place);
    };
    NodeId nearest = tree.root();
    for (NodeId id : tree.depth_first())
        if (off(id) < off(nearest)) nearest = id;
    EXPECT_LT(off(nearest), 0.2);
    double way = 0.0;
    for (NodeId id = nearest; id != tree.root(); id = tree.node(id).parent)
        way += glm::distance(tree.node(id).position, tree.node(tree.node(id).parent).position);
    return way;
}

// to: metres, where the slab ends that is cut out of the stems.
void expect_stems_on_their_stumps(const PointCloud& cloud, double to, const std::string& what) {
    const SkeletonResult result = skeletonize(cloud, {});
    for (const double turn : {0.0, 2.1, 4.2}) {
        const DVec3 base = on_stem(turn, to + 0.15);
        const double straight = kForkHeight + glm::distance(base, DVec3(0.0, kForkHeight, 0.0));
        EXPECT_LT(way_down(result.tree, cloud, base), 1.25 * straight)
            << what << ", the stem towards " << turn;
    }
}

TEST(WideGaps, EveryStemStandsOnItsOwnStump) {
    for (int seed = 1; seed <= test::repeats(3); seed++)
        for (const double width : {0.3, 0.45, 0.6}) {
            const double from = 1.25, to = from + width;
            expect_stems_on_their_stumps(
                cut_tree(static_cast<uint64_t>(seed), from, to), to,
                "seed " + std::to_string(seed) + ", a gap of " + std::to_string(width) + " m");
        }
}

// All hangs on a gap in the trunk, which its one stem crosses; the stems' own comes after it.
TEST(WideGaps, AGapInTheTrunkHidesNoneAboveIt) {
    for (const uint64_t seed : {1, 2, 3})
        for (const double width : {0.3, 0.45, 0.6}) {
            const double from = 1.25, to = from + width;
            const PointCloud whole = cut_tree(seed, from, to);
            PointCloud cloud;
            cloud.frame = whole.frame;
            for (const Vec3& p : whole.positions)
                if (p.y < 0.3F || p.y > 0.55F || p.x > 1.4F) cloud.positions.push_back(p);
            expect_stems_on_their_stumps(
                cloud, to,
                "seed " + std::to_string(seed) + ", gaps of 0.25 and " + std::to_string(width) + " m");
        }
}

}  // namespace
}  // namespace treerec
