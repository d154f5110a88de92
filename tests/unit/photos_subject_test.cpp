// The stem that photos were taken around.
#include <gtest/gtest.h>

#include <cmath>

#include "geometry/random.h"
#include "photos/subject_stem.h"
#include "scan/stems/lone_trunk.h"
#include "skeleton/skeleton.h"

namespace treerec {
namespace {

const DVec3 kUp(0, 1, 0);

// A stem that leans and narrows from the base to `top`, rough as bark is, on uneven ground, in a bench of
// slats.
std::vector<DVec3> trunk_in_a_bench(Random& random, double top) {
    std::vector<DVec3> points;
    for (int i = 0; i < 12000; i++) {
        const double y = random.uniform() * top, angle = random.uniform() * 2.0 * kPi;
        const double radius =
            (0.45 - 0.05 * y) * (1.0 + 0.03 * std::sin(9.0 * angle)) + 0.01 * random.normal();
        points.emplace_back(0.1 * y + radius * std::sin(angle), y, radius * std::cos(angle));
    }
    for (int i = 0; i < 5000; i++) {
        const double away = 0.6 + 0.5 * random.uniform(), angle = random.uniform() * 2.0 * kPi;
        const double y = random.uniform() < 0.7 ? 0.5 : 0.5 * random.uniform();
        points.emplace_back(away * std::sin(angle), y, away * std::cos(angle));
    }
    for (int i = 0; i < 4000; i++)
        points.emplace_back(3.0 * random.normal(), 0.02 * random.normal(), 3.0 * random.normal());
    return points;
}

TEST(SubjectStem, IsFoundWhateverStandsAroundIt) {
    for (uint64_t seed = 1; seed <= 5; seed++) {
        Random random(seed);
        const std::vector<DVec3> points = trunk_in_a_bench(random, 2.4);
        const auto stem = find_subject_stem(points, {0.1, 1.0, -0.1}, kUp);
        ASSERT_TRUE(stem) << seed;
        for (const SubjectRing& ring : stem->rings) {
            const double y = ring.height + 1.0;
            EXPECT_NEAR(ring.radius, 0.45 - 0.05 * y, 0.03) << y;
            const DVec3 place = stem->subject + ring.centre.x * stem->side + ring.centre.y * stem->other;
            EXPECT_NEAR(place.x, 0.1 * y, 0.03);
            EXPECT_NEAR(place.z, 0.0, 0.03);
        }
        EXPECT_TRUE(stem->has({0.3, 1.0, 0.2}, 0.1));
        EXPECT_FALSE(stem->has({0.9, 0.5, 0.0}, 0.3));
        EXPECT_TRUE(stem->has({0.24, 2.41, 0.2}, 0.1));  // on above the highest ring
        EXPECT_FALSE(stem->has({0.24, 3.4, 0.2}, 0.3));
    }
}

TEST(SubjectStem, IsNoneWhereACrownShows) {
    Random random(2);
    std::vector<DVec3> points = trunk_in_a_bench(random, 2.4);
    for (int i = 0; i < 20000; i++)
        points.push_back(DVec3(0.2, 3.6, 0.0) + 1.3 * std::cbrt(random.uniform()) * random.direction());
    EXPECT_FALSE(find_subject_stem(points, {0.0, 1.5, 0.0}, kUp));
}

// A spruce's stem shows up to its top, and is no trunk alone.
TEST(SubjectStem, IsNoneWhereItBearsBranches) {
    Random random(5);
    std::vector<DVec3> points = trunk_in_a_bench(random, 2.4);
    for (int branch = 0; branch < 12; branch++) {
        const double angle = branch * 2.4, y = 1.0 + 0.11 * branch;
        for (int i = 0; i < 300; i++) {
            const double away = 0.4 + 1.1 * random.uniform();
            points.push_back(DVec3(away * std::sin(angle), y - 0.1 * away, away * std::cos(angle)) +
                             0.03 * random.direction());
        }
    }
    EXPECT_FALSE(find_subject_stem(points, {0.1, 1.2, 0.0}, kUp));
}

TEST(SubjectStem, IsNoneWhereNothingIsRound) {
    Random random(3);
    std::vector<DVec3> points;
    for (int i = 0; i < 20000; i++)
        points.emplace_back(random.normal(), random.normal(), random.normal());
    EXPECT_FALSE(find_subject_stem(points, {0, 0, 0}, kUp));
    EXPECT_FALSE(find_subject_stem({}, {0, 0, 0}, kUp));
    // A stem that stands beside what the photos were taken of.
    std::vector<DVec3> beside = trunk_in_a_bench(random, 2.4);
    for (DVec3& p : beside)
        p.x += 2.0;
    EXPECT_FALSE(find_subject_stem(beside, {0, 1.0, 0}, kUp));
}

// A trunk that is known to be one is followed by its sections, however high, and not along its bark.
TEST(TrunkAlone, IsOneStem) {
    Random random(4);
    PointCloud cloud;
    for (const DVec3& p : trunk_in_a_bench(random, 5.0))
        if (std::hypot(p.x - 0.1 * p.y, p.z) < 0.6) cloud.positions.emplace_back(p);
    SkeletonOptions options;
    options.trunk_alone = true;
    const Tree tree = skeletonize(cloud, options).tree;
    EXPECT_EQ(tree.nodes_of_kind(NodeKind::kLeaf).size(), 1U);
    double low = 0.0, high = 0.0;
    for (NodeId id = 0; id < tree.id_end(); id++) {
        if (!tree.contains(id)) continue;
        const DVec3 p = tree.frame().to_scan(tree.node(id).position);
        low = std::min(low, p.y);
        high = std::max(high, p.y);
        if (p.y <= 0.7 || p.y >= 4.8) continue;
        EXPECT_NEAR(tree.node(id).radius, 0.45 - 0.05 * p.y, 0.03) << p.y;
    }
    EXPECT_LT(low, 0.2);
    EXPECT_GT(high, 4.7);
}

}  // namespace
}  // namespace treerec
