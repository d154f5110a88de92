// Radii by a rule (Zhang 2013, 5.4).
#include "skeleton/cylinders/radius_rules.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

#include "error.h"
#include "geometry/random.h"

namespace treerec {
namespace {

Tree random_tree(uint64_t seed) {
    Random random(seed, 41);
    Tree tree;
    tree.add_root(DVec3(0.0), 0.3, kMeasuredRadiusFlag);
    const uint32_t count = 2 + random.below(200);
    for (uint32_t i = 1; i < count; i++) {
        const NodeId parent = static_cast<NodeId>(random.below(i));
        const Node& from = tree.node(parent);
        tree.add_child(parent, from.position + DVec3(random.normal(), random.uniform(), random.normal()),
                       from.radius * random.uniform(0.4, 1.0), kMeasuredRadiusFlag);
    }
    return tree;
}

TEST(RadiusRules, DaVincisSquaresAddUpAtEveryFork) {
    for (uint64_t seed = 0; seed < 200; seed++) {
        Tree tree = random_tree(seed);
        apply_radius_rule(tree, RadiusRule::kDaVinci);
        for (const NodeId id : tree.depth_first()) {
            const Node& node = tree.node(id);
            EXPECT_FALSE(node.is_measured());
            if (node.child_count == 0) continue;
            double sum = 0.0;
            for (const NodeId child : tree.children(id))
                sum += tree.node(child).radius * tree.node(child).radius;
            EXPECT_NEAR(sum, node.radius * node.radius, 1e-12) << seed;
        }
    }
}

TEST(RadiusRules, LinearChildrenAllHaveTheSameShareOfTheirParents) {
    for (uint64_t seed = 0; seed < 200; seed++) {
        Tree tree = random_tree(seed);
        apply_radius_rule(tree, RadiusRule::kLinear);
        double share = 0.0;
        for (const NodeId id : tree.depth_first()) {
            const Node& node = tree.node(id);
            EXPECT_FALSE(node.is_measured());
            for (const NodeId child : tree.children(id)) {
                const double own = tree.node(child).radius / node.radius;
                if (node.child_count == 1) {
                    EXPECT_EQ(own, 1.0);
                } else if (tree.node(child).radius > 0.000101) {
                    EXPECT_LT(own, 1.0);
                    if (share > 0.0) {
                        EXPECT_NEAR(own, share, 1e-9) << seed;
                    }
                    share = own;
                }
            }
        }
    }
}

// What the rule says of a tree that already keeps it is the tree.
TEST(RadiusRules, KeepATreeThatFollowsThem) {
    for (const RadiusRule rule : {RadiusRule::kLinear, RadiusRule::kDaVinci}) {
        for (uint64_t seed = 0; seed < 50; seed++) {
            Tree once = random_tree(seed);
            apply_radius_rule(once, rule);
            // A stem without forks to where its thickness is taken from.
            Tree twice = once;
            apply_radius_rule(twice, rule);
            const double base = twice.node(twice.root()).radius / once.node(once.root()).radius;
            for (const NodeId id : once.depth_first())
                if (twice.node(id).radius > 0.000101 && once.node(id).radius > 0.000101) {
                    EXPECT_NEAR(twice.node(id).radius, base * once.node(id).radius, 1e-9);
                }
        }
    }
}

TEST(RadiusRules, MeasuredChangesNothingAndWordsAreRefused) {
    const Tree before = random_tree(1);
    Tree tree = before;
    apply_radius_rule(tree, RadiusRule::kMeasured);
    for (const NodeId id : tree.depth_first()) {
        EXPECT_EQ(tree.node(id).radius, before.node(id).radius);
        EXPECT_TRUE(tree.node(id).is_measured());
    }
    Tree none;
    apply_radius_rule(none, RadiusRule::kDaVinci);
    EXPECT_TRUE(none.empty());
    for (const char* word : {"measured", "linear", "davinci"})
        EXPECT_STREQ(radius_rule_name(parse_radius_rule(word)), word);
    EXPECT_THROW(parse_radius_rule("leonardo"), Error);
}

}  // namespace
}  // namespace treerec
