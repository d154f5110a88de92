// Younger and older individuals of a tree's kind.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "edit/delta.h"
#include "edit/vary/vary.h"
#include "error.h"
#include "geometry/random.h"
#include "random_tree.h"
#include "synth/grow.h"
#include "tree/measure.h"

namespace treerec {
namespace {

double thinnest(const Tree& tree) {
    double least = 1e300;
    for (const NodeId id : tree.depth_first())
        least = std::min(least, tree.node(id).radius);
    return least;
}

TEST(VaryAge, OneIsTheVariantAsItWas) {
    const Tree tree = test::random_tree(4, 300);
    const VariantMaker maker(tree);
    EXPECT_TRUE(identical(maker.make(3, 0.6, 1.0).tree, maker.make(3, 0.6).tree));
    EXPECT_TRUE(identical(maker.make(3, 0.0, 1.0).tree, tree));
}

TEST(VaryAge, RefusesWhatIsNoAge) {
    const VariantMaker maker(test::random_tree(4, 30));
    for (const double age : {0.0, 0.19, 1.21, -1.0, std::nan("")})
        EXPECT_THROW(maker.make(1, 0.5, age), Error);
    EXPECT_NO_THROW(maker.make(1, 0.5, VariantMaker::kLeastAge));
    EXPECT_NO_THROW(maker.make(1, 0.5, VariantMaker::kMostAge));
}

TEST(VaryAge, SoundOnAnyTree) {
    for (uint64_t seed = 1; seed <= 200; seed++) {
        SCOPED_TRACE(seed);
        Random random(seed);
        const int nodes = 2 + static_cast<int>(random.below(300));
        const Tree tree = seed % 3 ? test::random_tree(seed, nodes) : test::wild_tree(seed, nodes);
        const VariantMaker maker(tree);
        for (int i = 0; i < 4; i++) {
            const Tree variant = maker.make(random.next(), random.uniform(), random.uniform(0.2, 1.2)).tree;
            ASSERT_EQ(variant.check().value_or("sound"), "sound");
            for (const NodeId id : variant.depth_first())
                ASSERT_TRUE(std::isfinite(variant.node(id).radius));
        }
    }
}

// By the tree's own statistics: shorter, thinner by its allometry, fewer branches; twigs as they are.
TEST(VaryAge, YoungerIsSmallerThinnerAndBearsLess) {
    for (const Habit habit : {Habit::kBroadleaf, Habit::kConifer, Habit::kPalm}) {
        const Tree tree = grow_tree({habit, 0.0, 3});
        const VariantMaker maker(tree);
        EXPECT_GE(maker.allometry(), 1.0);
        EXPECT_LE(maker.allometry(), 2.0);
        const Measurements whole = measure(tree);
        for (uint64_t seed = 1; seed <= 3; seed++) {
            SCOPED_TRACE(static_cast<int>(habit) * 100 + static_cast<int>(seed));
            double height = 0.0, length = 0.0;
            size_t nodes = 0;
            for (const double age : {0.2, 0.4, 0.7, 1.0, 1.2}) {
                const Tree variant = maker.make(seed, 0.5, age).tree;
                const Measurements now = measure(variant);
                EXPECT_GT(now.height, height) << age;
                EXPECT_GT(now.total_length, length) << age;
                EXPECT_GE(now.nodes, nodes) << age;
                const double size = 0.5 * age * (3.0 - age);
                EXPECT_NEAR(now.height / whole.height, size, 0.25 * size) << age;
                // A palm has no twigs.
                if (habit != Habit::kPalm) {
                    EXPECT_GE(thinnest(variant), 0.4 * thinnest(tree)) << age;
                }
                const double base = variant.node(variant.root()).radius / tree.node(tree.root()).radius;
                EXPECT_NEAR(base, std::pow(size, maker.allometry()), 0.3 * base) << age;
                height = now.height;
                length = now.total_length;
                nodes = now.nodes;
            }
        }
    }
}

// A day makes no other tree: what stands at both ages hardly differs, and little comes or goes.
TEST(VaryAge, ChangesSteadily) {
    const Tree tree = grow_tree({Habit::kBroadleaf, 0.0, 2});
    const VariantMaker maker(tree);
    double before = measure(maker.make(9, 0.5, 1.0).tree).total_length;
    for (double age = 0.99; age > 0.21; age -= 0.01) {
        const double now = measure(maker.make(9, 0.5, age).tree).total_length;
        EXPECT_GT(now, 0.85 * before) << age;
        EXPECT_LT(now, 1.02 * before) << age;
        before = now;
    }
}

TEST(VaryAge, LeavesThatTheScanSawGrowFewer) {
    const Tree tree = grow_tree({Habit::kBroadleaf, 8.0, 6});
    std::vector<Vec3> points;
    Random random(3);
    for (const NodeId id : tree.nodes_of_kind(NodeKind::kLeaf))
        for (int i = 0; i < 40; i++)
            points.emplace_back(tree.node(id).position + 0.25 * random.direction() * random.uniform());
    const Foliage foliage = gather_foliage(points, {});
    const VariantMaker maker(tree, foliage);
    size_t before = 0;
    for (const double age : {0.2, 0.5, 0.8, 1.0}) {
        const Foliage now = maker.make(2, 0.5, age).foliage;
        EXPECT_NO_THROW(check_foliage(now));
        EXPECT_GT(now.cells.size(), before) << age;
        before = now.cells.size();
    }
    // As densely filled: by the crown's volume.
    const double size = 0.5 * 0.5 * (3.0 - 0.5);
    const double share = static_cast<double>(maker.make(2, 0.5, 0.5).foliage.cells.size()) /
                         static_cast<double>(maker.make(2, 0.5, 1.0).foliage.cells.size());
    EXPECT_NEAR(share, size * size * size, 0.5 * size * size * size);
}

}  // namespace
}  // namespace treerec
