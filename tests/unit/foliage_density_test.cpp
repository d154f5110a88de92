#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "error.h"
#include "foliage/foliage.h"
#include "foliage/leaves.h"
#include "foliage/near_wood.h"
#include "geometry/bounds.h"
#include "geometry/parallel.h"
#include "geometry/random.h"
#include "random_tree.h"
#include "tree/branches.h"

namespace treerec {
namespace {

using Color = std::array<uint8_t, 3>;

// Points of a scan in a ball.
std::vector<Vec3> ball(const DVec3& centre, double radius, size_t count, uint64_t seed) {
    Random random(seed);
    std::vector<Vec3> points;
    for (size_t i = 0; i < count; i++)
        points.emplace_back(centre + radius * std::cbrt(random.uniform()) * random.direction());
    return points;
}

double nearest_cell(const Foliage& foliage, const DVec3& p) {
    double best = 1e9;
    for (const FoliageCell& cell : foliage.cells)
        best = std::min(best, glm::distance(foliage.centre(cell), p));
    return best;
}

TEST(Foliage, CountsEveryPointInItsCellWhateverTheOrder) {
    std::vector<Vec3> points = ball({1.0, 8.0, -2.0}, 2.0, 20000, 1);
    std::vector<Color> colors;
    for (const Vec3& p : points)
        colors.push_back({static_cast<uint8_t>(100.0F + 20.0F * p.x), 120, 40});
    const Foliage foliage = gather_foliage(points, colors);
    EXPECT_NO_THROW(check_foliage(foliage));
    EXPECT_TRUE(foliage.colored);
    size_t sum = 0;
    for (const FoliageCell& cell : foliage.cells) {
        sum += cell.points;
        EXPECT_NEAR(cell.color[0], 100.0 + 20.0 * foliage.centre(cell).x, 20.0 * foliage.edge + 1.0);
        EXPECT_EQ(cell.color[1], 120);
    }
    EXPECT_EQ(sum, points.size());
    for (const Vec3& p : points)
        ASSERT_LT(nearest_cell(foliage, DVec3(p)), 0.87 * foliage.edge);
    std::reverse(points.begin(), points.end());
    std::reverse(colors.begin(), colors.end());
    EXPECT_EQ(gather_foliage(points, colors), foliage);
}

TEST(Foliage, KnowsWhichPointsLieOutside) {
    const std::vector<Vec3> leaves = ball({1.0, 8.0, -2.0}, 2.0, 20000, 2);
    const Foliage foliage = gather_foliage(leaves, {});
    std::vector<Vec3> points;
    for (size_t i = 0; i < 5000; i++) {
        points.push_back(leaves[i]);
        points.emplace_back(0.0F, 0.001F * static_cast<float>(i), 0.0F);  // below and beside it
    }
    points.emplace_back(1e30F, 0.0F, 0.0F);
    points.emplace_back(std::nanf(""), 8.0F, -2.0F);
    std::vector<int32_t> wanted;
    for (int32_t i = 0; i < static_cast<int32_t>(points.size()); i++)
        if (i % 2 == 1 || i >= 10000) wanted.push_back(i);
    EXPECT_EQ(points_outside(foliage, points), wanted);
    EXPECT_EQ(points_outside(Foliage(), points).size(), points.size());
}

TEST(Foliage, StaysSmall) {
    for (const double size : {0.5, 20.0, 500.0}) {
        const Foliage foliage = gather_foliage(ball({0.0, size, 0.0}, size, 200000, 2), {});
        EXPECT_LE(foliage.cells.size(), kMostFoliageCells);
        EXPECT_GT(foliage.cells.size(), 2000u);
        EXPECT_FALSE(foliage.colored);
    }
    EXPECT_TRUE(gather_foliage({}, {}).empty());
    const std::vector<Vec3> one(3, Vec3(1.0F));
    EXPECT_EQ(gather_foliage(one, {}).cells.size(), 1u);
}

TEST(Foliage, DamagedOnesAreRefused) {
    const Foliage good = gather_foliage(ball({0.0, 3.0, 0.0}, 1.0, 3000, 3), {});
    const auto refused = [&](auto spoil) {
        Foliage bad = good;
        spoil(bad);
        EXPECT_THROW(check_foliage(bad), Error);
    };
    refused([](Foliage& f) { f.edge = 0.0; });
    refused([](Foliage& f) { f.edge = std::nan(""); });
    refused([](Foliage& f) { f.edge = 1e300; });
    refused([](Foliage& f) { f.origin.y = INFINITY; });
    refused([](Foliage& f) { f.cells[4].points = 0; });
    refused([](Foliage& f) { std::swap(f.cells[4], f.cells[5]); });
    refused([](Foliage& f) { f.cells[5] = f.cells[4]; });
    refused([](Foliage& f) { f.cells.resize(kMostFoliageCells + 1); });
}

TEST(NearWood, FindsTheNearestAxis) {
    for (uint64_t seed = 0; seed < 10; seed++) {
        const Tree tree = test::random_tree(seed, 300);
        const BranchList list = list_branches(tree);
        const double reach = 1.0;
        const NearWood wood(tree, list, reach, 1e9, 1e-6);
        std::vector<AxisPoint> all, axis;
        for (const Branch& branch : list.branches) {
            sample_axis(tree, list, branch, 1e-6, axis);
            all.insert(all.end(), axis.begin(), axis.end());
        }
        Random random(seed, 9);
        const Bounds bounds = tree.bounds();
        for (int i = 0; i < 300; i++) {
            DVec3 p;
            for (int k = 0; k < 3; k++)
                p[k] = random.uniform(bounds.min[k] - 1.5, bounds.max[k] + 1.5);
            double best = 1e9;
            for (const AxisPoint& a : all)
                best = std::min(best, glm::distance(a.position, p));
            const WoodSample* found = wood.nearest(p);
            if (best < reach) {
                ASSERT_NE(found, nullptr);
                // There are points between the axis's own.
                EXPECT_LE(glm::distance(found->at.position, p), best + 1e-9);
            } else if (found) {
                EXPECT_LE(glm::distance(found->at.position, p), reach);
            }
        }
    }
}

TEST(Leaves, StandWhereTheScanSawThem) {
    for (uint64_t seed = 0; seed < 6; seed++) {
        const Tree tree = test::random_tree(seed, 400);
        const NodeId tip = tree.nodes_of_kind(NodeKind::kLeaf).front();
        const Foliage foliage = gather_foliage(ball(tree.node(tip).position, 1.0, 4000, seed), {});
        const LeafRules rules = leaf_preset("generic");
        const std::vector<LeafPlacement> leaves = place_leaves(tree, rules, seed, foliage);
        ASSERT_GT(leaves.size(), 50u);
        for (const LeafPlacement& leaf : leaves)
            EXPECT_LT(nearest_cell(foliage, DVec3(leaf.position)), 2.0 * foliage.edge + 0.05);
        // Without it, and where it is not followed, the rules stand alone.
        const std::vector<LeafPlacement> plain = place_leaves(tree, rules, seed);
        LeafRules apart = rules;
        apart.follow_density = 0.0;
        const std::vector<LeafPlacement> same = place_leaves(tree, apart, seed, foliage);
        ASSERT_EQ(same.size(), plain.size());
        EXPECT_EQ(std::memcmp(same.data(), plain.data(), plain.size() * sizeof(LeafPlacement)), 0);
    }
}

TEST(Leaves, AreAsManyAsTheScanIsDense) {
    const Tree tree = test::random_tree(4, 400);
    const DVec3 place = tree.node(tree.nodes_of_kind(NodeKind::kLeaf).front()).position;
    const DVec3 aside(0.0, 0.0, 0.45);
    std::vector<Vec3> points = ball(place + aside, 0.4, 1500, 5);
    const std::vector<Vec3> dense = ball(place - aside, 0.4, 6000, 6);
    points.insert(points.end(), dense.begin(), dense.end());
    LeafRules rules = leaf_preset("generic");
    rules.internode = 0.01;  // many, for the statistics
    const std::vector<LeafPlacement> leaves = place_leaves(tree, rules, 1, gather_foliage(points, {}));
    double few = 0.0, many = 0.0;
    for (const LeafPlacement& leaf : leaves)
        (leaf.position.z > place.z ? few : many) += 1.0;
    EXPECT_GT(many, 1.8 * few);
    EXPECT_GT(few, 50.0);
}

// A whole wood that was scanned as one tree has room for tens of millions; too many to place them all.
TEST(Leaves, CoverAHugeCrownAlikeHoweverMany) {
    const Tree tree = test::random_tree(4, 400);
    const DVec3 place = tree.node(tree.nodes_of_kind(NodeKind::kLeaf).front()).position;
    const Foliage foliage = gather_foliage(ball(place, 4.0, 60000, 5), {});
    LeafRules rules = leaf_preset("generic");
    rules.leaf_area_index = 0.0;
    std::vector<double> areas;
    for (const double internode : {0.03, 0.003, 0.002}) {
        rules.internode = internode;
        const std::vector<LeafPlacement> leaves = place_leaves(tree, rules, 1, foliage);
        EXPECT_LE(leaves.size(), static_cast<size_t>(rules.maximum_leaves)) << internode;
        EXPECT_GT(leaves.size() + 3, static_cast<size_t>(rules.maximum_leaves)) << internode;
        double area = 0.0;
        for (const LeafPlacement& leaf : leaves)
            area += static_cast<double>(leaf.size) * leaf.size;
        areas.push_back(area * internode);
    }
    EXPECT_NEAR(areas[1] / areas[0], 1.0, 0.05);
    EXPECT_NEAR(areas[2] / areas[0], 1.0, 0.05);
}

TEST(Leaves, TakeTheirHueFromTheScan) {
    const Tree tree = test::random_tree(4, 400);
    const DVec3 place = tree.node(tree.nodes_of_kind(NodeKind::kLeaf).front()).position;
    const std::vector<Vec3> points = ball(place, 1.0, 8000, 7);
    std::vector<Color> colors;
    for (const Vec3& p : points)
        colors.push_back(p.x > place.x ? Color{150, 100, 30} : Color{60, 110, 40});
    const std::vector<LeafPlacement> leaves =
        place_leaves(tree, leaf_preset("generic"), 1, gather_foliage(points, colors));
    for (const LeafPlacement& leaf : leaves) {
        if (leaf.position.x > place.x + 0.3F) {
            EXPECT_GE(leaf.hue, 0.7F);
        }
        if (leaf.position.x < place.x - 0.3F) {
            EXPECT_LE(leaf.hue, 0.31F);
        }
        EXPECT_GE(leaf.hue, 0.0F);
        EXPECT_LE(leaf.hue, 1.0F);
    }
}

TEST(Leaves, FoliageFarFromWoodBearsNoneAndThreadsDoNotMatter) {
    const Tree tree = test::random_tree(2, 300);
    const Bounds bounds = tree.bounds();
    const LeafRules rules = leaf_preset("oak");
    const Foliage far = gather_foliage(ball(bounds.max + DVec3(8.0), 1.0, 3000, 8), {});
    EXPECT_TRUE(place_leaves(tree, rules, 1, far).empty());
    const Foliage around = gather_foliage(ball(bounds.centre(), 0.4 * bounds.diagonal(), 30000, 8), {});
    const std::vector<LeafPlacement> one = place_leaves(tree, rules, 1, around);
    set_thread_count(4);
    const std::vector<LeafPlacement> four = place_leaves(tree, rules, 1, around);
    set_thread_count(0);
    ASSERT_EQ(one.size(), four.size());
    EXPECT_EQ(std::memcmp(one.data(), four.data(), one.size() * sizeof(LeafPlacement)), 0);
    LeafRules few = rules;
    few.maximum_leaves = 100;
    EXPECT_LE(place_leaves(tree, few, 1, around).size(), 100u);
}

}  // namespace
}  // namespace treerec
