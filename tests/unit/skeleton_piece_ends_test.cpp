// Wood that a scan shows between two gaps (skeleton/sampling/piece_ends.h).
#include <gtest/gtest.h>

#include <algorithm>

#include "geometry/parallel.h"
#include "skeleton/skeleton.h"
#include "skeleton_test_clouds.h"

namespace treerec {
namespace {

using test::add_cone;

// A stem with a bough that hangs down from high up, and a branch whose base is hidden. Between the branch and
// the bough lie some points here and there, nearer to each other than the branch's base is to the stem.
PointCloud hidden_base(uint64_t seed) {
    Random random(seed);
    PointCloud cloud;
    add_cone(cloud, random, {0, 0, 0}, {0, 4, 0}, 0.1, 0.06, 0.012, 0.001);
    const DVec3 bough(1.25, 2.9, 0.0);
    add_cone(cloud, random, {0.0, 3.3, 0.0}, bough, 0.02, 0.012, 0.008, 0.001);
    const DVec3 base(0.17, 1.52, 0.0), end(1.1, 2.2, 0.0);
    add_cone(cloud, random, base, end, 0.02, 0.012, 0.008, 0.001);
    for (int fleck = 1; fleck < 8; fleck++)
        for (int i = 0; i < 5; i++)
            cloud.positions.emplace_back(glm::mix(end, bough, fleck / 8.0) +
                                         0.008 * random.normal() * random.direction());
    return cloud;
}

// Metres above the ground, of the highest place on the way from the branch's middle to the root.
double highest_on_the_way(const PointCloud& cloud, const SkeletonOptions& options) {
    const Tree tree = skeletonize(cloud, options).tree;
    const auto in_cloud = [&](NodeId id) {
        return cloud.frame.to_tree(tree.frame().to_scan(tree.node(id).position));
    };
    const DVec3 middle(0.6, 1.832, 0.0);
    NodeId at = tree.root();
    for (const NodeId id : tree.depth_first())
        if (glm::distance(in_cloud(id), middle) < glm::distance(in_cloud(at), middle)) at = id;
    EXPECT_LT(glm::distance(in_cloud(at), middle), 0.15);
    double highest = 0.0;
    for (; at != kNoNode; at = tree.node(at).parent)
        highest = std::max(highest, in_cloud(at).y);
    return highest;
}

TEST(PieceEnds, ABranchHangsOnTheStemThatItPointsTo) {
    for (const uint64_t seed : {1, 2, 3, 4}) {
        const PointCloud cloud = hidden_base(seed);
        EXPECT_LT(highest_on_the_way(cloud, {}), 2.0) << seed;
        SkeletonOptions without;
        without.left_out = Pass::kPieceEnds;
        EXPECT_GT(highest_on_the_way(cloud, without), 2.6) << "there was nothing to find out, seed " << seed;
    }
}

TEST(PieceEnds, AreTheSameOnAnyNumberOfThreads) {
    const PointCloud cloud = hidden_base(5);
    std::vector<DVec3> places[2];
    for (const int threads : {1, 4}) {
        set_thread_count(threads);
        const Tree tree = skeletonize(cloud, {}).tree;
        for (const NodeId id : tree.depth_first())
            places[threads > 1].push_back(tree.node(id).position);
    }
    set_thread_count(0);
    EXPECT_EQ(places[0], places[1]);
}

}  // namespace
}  // namespace treerec
