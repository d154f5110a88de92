#include "mesh/capsules.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "error.h"
#include "geometry/segment.h"
#include "random_tree.h"
#include "tree/trunk.h"

using namespace treerec;

namespace {

// How far wood of at least this radius is from the nearest capsule's surface, on average along its length.
double mean_error(const Tree& tree, const std::vector<Capsule>& capsules, double minimum_radius) {
    double error = 0.0;
    double length = 0.0;
    for (const NodeId id : tree.depth_first()) {
        const Node& node = tree.node(id);
        if (node.parent == kNoNode || node.radius < minimum_radius) continue;
        const DVec3 middle = 0.5 * (node.position + tree.node(node.parent).position);
        const double step = glm::distance(node.position, tree.node(node.parent).position);
        double nearest = HUGE_VAL;
        for (const Capsule& capsule : capsules) {
            const double off = distance_to_segment(middle, capsule.from, capsule.to);
            nearest = std::min(nearest, off + std::abs(capsule.radius - node.radius));
        }
        error += nearest * step;
        length += step;
    }
    return length > 0.0 ? error / length : 0.0;
}

}  // namespace

TEST(Capsules, AStraightStemIsOne) {
    Tree tree;
    NodeId id = tree.add_root({0, 0, 0}, 0.1);
    for (int i = 1; i <= 20; ++i)
        id = tree.add_child(id, {0, 0.25 * i, 0}, 0.1);
    const std::vector<Capsule> capsules = fit_capsules(tree);
    ASSERT_EQ(capsules.size(), 1u);
    EXPECT_EQ(capsules[0].from, DVec3(0, 0, 0));
    EXPECT_EQ(capsules[0].to, DVec3(0, 5, 0));
    EXPECT_NEAR(capsules[0].radius, 0.1, 1e-12);
    EXPECT_EQ(capsules[0].node, id);
}

TEST(Capsules, ABendIsPartedWhereItBends) {
    Tree tree;
    NodeId id = tree.add_root({0, 0, 0}, 0.1);
    for (int i = 1; i <= 10; ++i)
        id = tree.add_child(id, {0, 0.3 * i, 0}, 0.1);
    for (int i = 1; i <= 10; ++i)
        id = tree.add_child(id, {0.3 * i, 3, 0}, 0.1);
    const std::vector<Capsule> capsules = fit_capsules(tree);
    ASSERT_EQ(capsules.size(), 2u);
    EXPECT_EQ(capsules[0].to, DVec3(0, 3, 0));
    EXPECT_EQ(capsules[1].from, DVec3(0, 3, 0));
    EXPECT_EQ(capsules[1].to, DVec3(3, 3, 0));
}

TEST(Capsules, AConeGetsThinner) {
    Tree tree;
    NodeId id = tree.add_root({0, 0, 0}, 0.5);
    for (int i = 1; i <= 40; ++i)
        id = tree.add_child(id, {0, 0.25 * i, 0}, 0.5 - 0.01 * i);
    CapsuleOptions options;
    options.maximum = 4;
    const std::vector<Capsule> capsules = fit_capsules(tree, options);
    ASSERT_EQ(capsules.size(), 4u);
    for (size_t i = 1; i < capsules.size(); ++i) {
        EXPECT_EQ(capsules[i].from, capsules[i - 1].to);
        EXPECT_LT(capsules[i].radius, capsules[i - 1].radius);
    }
}

TEST(Capsules, NothingStout) {
    Tree tree;
    const NodeId root = tree.add_root({0, 0, 0}, 0.1);
    EXPECT_TRUE(fit_capsules(tree).empty());
    tree.add_child(root, {0, 1, 0}, 0.01);
    EXPECT_TRUE(fit_capsules(tree).empty());
    EXPECT_TRUE(fit_capsules(Tree()).empty());
    CapsuleOptions options;
    options.maximum = 0;
    EXPECT_THROW(fit_capsules(tree, options), Error);
    options.maximum = 1;
    options.minimum_radius = std::nan("");
    EXPECT_THROW(fit_capsules(tree, options), Error);
}

TEST(Capsules, MoreFitBetter) {
    for (uint64_t seed = 1; seed <= 40; ++seed) {
        const Tree tree = test::random_tree(seed, 400);
        CapsuleOptions options;
        double largest = 0.0;
        for (const NodeId id : tree.depth_first())
            largest = std::max(largest, tree.node(id).radius);
        options.minimum_radius = 0.3 * largest;
        double before = HUGE_VAL;
        // No capsule tapers, so where radii jump from node to node the rest stays.
        double jumps = 0.0;
        double length = 0.0;
        for (const NodeId id : tree.depth_first()) {
            const Node& node = tree.node(id);
            if (node.parent == kNoNode || node.radius < options.minimum_radius) continue;
            const double step = glm::distance(node.position, tree.node(node.parent).position);
            jumps += 0.5 * std::abs(node.radius - tree.node(node.parent).radius) * step;
            length += step;
        }
        for (const int maximum : {1, 8, 64, 4096}) {
            options.maximum = maximum;
            const std::vector<Capsule> capsules = fit_capsules(tree, options);
            ASSERT_LE(int(capsules.size()), maximum);
            ASSERT_FALSE(capsules.empty()) << seed;
            for (const Capsule& capsule : capsules) {
                ASSERT_GE(capsule.radius, options.minimum_radius - 1e-12);
                ASSERT_LE(capsule.radius, largest + 1e-12);
                ASSERT_EQ(capsule.to, tree.node(capsule.node).position);
            }
            const double error = mean_error(tree, capsules, options.minimum_radius);
            // Greedy: a step makes its own wood better, and may bring other wood a capsule that lay nearer.
            EXPECT_LE(error, before * 1.02 + 1e-9) << seed << ", " << maximum;
            before = error;
        }
        EXPECT_LT(before, options.tolerance + jumps / length) << seed;
    }
}
