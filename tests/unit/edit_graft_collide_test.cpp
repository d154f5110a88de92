// Collisions of grafted wood, against every pair tried one by one; twigs on either side of a view.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "edit/collide.h"
#include "edit/graft/graft.h"
#include "edit/graft/scion.h"
#include "edit/graft/twig.h"
#include "error.h"
#include "random_tree.h"

namespace treerec {
namespace {

// How deep two tapered segments overlap, by trying places along both.
double sampled_depth(const DVec3& a, const DVec3& b, double ra, double rb, const DVec3& c, const DVec3& d,
                     double rc, double rd) {
    double deepest = -1e9;
    for (int i = 0; i <= 60; i++)
        for (int j = 0; j <= 60; j++) {
            const double s = i / 60.0;
            const double t = j / 60.0;
            deepest = std::max(deepest, ra + (rb - ra) * s + rc + (rd - rc) * t -
                                            glm::distance(a + (b - a) * s, c + (d - c) * t));
        }
    return deepest;
}

double start_radius(const Tree& tree, NodeId id) {
    return std::min(tree.node(tree.node(id).parent).radius, 1.6 * tree.node(id).radius);
}

TEST(EditGraftCollide, FindsWhatTryingEveryPairFinds) {
    size_t found = 0;
    for (uint64_t seed = 0; seed < 24; seed++) {
        const bool wild = seed % 3 == 0;
        const Tree tree = wild ? test::wild_tree(seed, 40) : test::random_tree(seed, 60);
        Tree wood = wild ? test::wild_tree(seed + 99, 30) : test::random_tree(seed + 99, 40, 5.0);
        Random random(seed);
        for (NodeId id : wood.depth_first())
            wood.set_position(id, wood.node(id).position + DVec3(random.uniform(-0.2, 0.2), 1.0, 0.3));
        CollisionOptions options;
        options.clearance = seed % 2 ? 0.05 : 0.0;
        std::map<std::pair<NodeId, NodeId>, double> collisions;
        std::pair<NodeId, NodeId> last{-1, -1};
        for (const Collision& one : find_collisions(StandingWood(tree), wood, options)) {
            const std::pair<NodeId, NodeId> key{one.grafted, one.other};
            EXPECT_LT(last, key);
            last = key;
            EXPECT_GT(one.depth, 0.0);
            collisions[key] = one.depth;
        }
        found += collisions.size();
        for (NodeId mine : wood.depth_first()) {
            if (wood.node(mine).parent == kNoNode) continue;
            for (NodeId other : tree.depth_first()) {
                if (tree.node(other).parent == kNoNode) continue;
                const DVec3 a = wood.node(wood.node(mine).parent).position;
                const DVec3 b = wood.node(mine).position;
                const DVec3 c = tree.node(tree.node(other).parent).position;
                const DVec3 d = tree.node(other).position;
                const double ra = start_radius(wood, mine), rb = wood.node(mine).radius;
                const double rc = start_radius(tree, other), rd = tree.node(other).radius;
                const double depth = sampled_depth(a, b, ra, rb, c, d, rc, rd) + options.clearance;
                const bool listed = collisions.count({mine, other}) > 0;
                // Between two samples the axes come nearer, and where they are nearest tapers may not be.
                const double taper = std::abs(ra - rb) + std::abs(rc - rd);
                const double slack = (glm::distance(a, b) + glm::distance(c, d)) / 60.0 + taper;
                const bool sure = depth > taper + 1e-9 || depth < -slack;
                EXPECT_TRUE(!sure || listed == (depth > 0.0)) << seed << " " << mine << " " << other;
            }
        }
    }
    EXPECT_GT(found, 80u);
}

TEST(EditGraftCollide, ABarWhereTheGraftGoesIsFoundAndAvoided) {
    Tree tree;
    tree.add_root({0, 0, 0}, 0.05);
    const NodeId host = tree.add_child(0, {0, 1, 0}, 0.05);
    const NodeId arm = tree.add_child(0, {1, 0.5, 0}, 0.03);
    const NodeId up = tree.add_child(arm, {1, 1.5, 0}, 0.03);
    const NodeId bar = tree.add_child(up, {0.2, 1.5, 0}, 0.03);
    // Goes up, with an arm of its own into the bar.
    Tree scion;
    scion.add_root({0, 0, 0}, 0.05);
    scion.add_child(0, {0, 0.5, 0}, 0.04);
    const NodeId branch = scion.add_child(1, {0.5, 0.5, 0}, 0.03);
    Tree hit = tree;
    GraftOptions options;
    const GraftResult first = graft(hit, host, scion, options);
    ASSERT_EQ(first.collisions.size(), 1u);
    EXPECT_EQ(first.collisions[0].other, bar);
    EXPECT_EQ(first.collisions[0].grafted, first.added[static_cast<size_t>(branch - 1)]);
    EXPECT_NEAR(first.collisions[0].place.y, 1.5, 1e-9);
    EXPECT_GT(first.collisions[0].depth, 0.05);
    // The check of what stands finds the same.
    const std::vector<Collision> later = find_collisions(hit, first.added[0], 0.0);
    ASSERT_EQ(later.size(), 1u);
    EXPECT_EQ(later[0].other, bar);
    Tree missed = tree;
    options.tries = 30;
    const GraftResult second = graft(missed, host, scion, options);
    EXPECT_TRUE(second.collisions.empty());
    EXPECT_GT(second.tries, 1);
    EXPECT_NE(second.spin, 0.0);
    EXPECT_TRUE(find_collisions(missed, second.added[0], 0.0).empty());
}

TEST(EditGraftCollide, TheJointIsNoCollision) {
    for (uint64_t seed = 0; seed < 100; seed++) {
        Tree tree;
        tree.add_root({0, 0, 0}, 0.1);
        const NodeId host = tree.add_child(0, {0, 1, 0}, 0.1);
        tree.add_child(host, {0, 2, 0}, 0.09);
        Tree scion;
        scion.add_root({0, 0, 0}, 0.05);
        scion.add_child(0, {0, 0.1, 0}, 0.05);
        scion.add_child(1, {0, 1, 0}, 0.04);
        GraftOptions options;
        options.aim = GraftAim::kLean;
        options.seed = seed;
        options.lean = 20.0 + static_cast<double>(seed);
        EXPECT_TRUE(graft(tree, host, scion, options).collisions.empty()) << options.lean;
    }
}

TEST(EditGraftCollide, RefusesBadInput) {
    const Tree tree = test::random_tree(1, 30);
    EXPECT_THROW(find_collisions(tree, 1000, 0.0), Error);
    EXPECT_THROW(find_collisions(tree, 1, -1.0), Error);
    EXPECT_TRUE(find_collisions(tree, tree.root(), 0.0).empty());
}

TEST(EditGraftTwig, RightIsRightOfTheView) {
    Random random(6);
    for (int i = 0; i < 500; i++) {
        Tree tree = test::random_tree(static_cast<uint64_t>(i % 20), 60);
        const std::vector<NodeId> all = tree.depth_first();
        const NodeId node = all[random.below(static_cast<uint32_t>(all.size()))];
        TwigOptions options;
        options.view = random.direction();
        if (glm::length(glm::cross(options.view, options.up)) < 0.05) continue;
        const DVec3 right = glm::normalize(glm::cross(options.view, options.up));
        const DVec3 at = tree.node(node).position;
        DVec3 along = direction_at(tree, node);
        for (NodeId child : tree.children(node)) {
            along = glm::normalize(tree.node(child).position - at);
            break;
        }
        const size_t before = tree.size();
        Tree other = tree;
        const NodeId twig = make_twig(tree, node, options);
        options.side = TwigSide::kLeft;
        const NodeId left = make_twig(other, node, options);
        ASSERT_EQ(tree.check(), std::nullopt);
        EXPECT_EQ(tree.size(), before + 1);
        const DVec3 to_right = glm::normalize(tree.node(twig).position - at);
        const DVec3 to_left = glm::normalize(other.node(left).position - at);
        // Square to the view but for the share of the branch's own direction.
        const DVec3 side = glm::normalize(to_right - to_left);
        EXPECT_LT(std::abs(glm::dot(side, options.view)), 1e-6);
        EXPECT_LT(std::abs(glm::dot(side, along)), 1e-6);
        EXPECT_GT(glm::dot(side, right), -0.2 - 1e-9);
        EXPECT_NEAR(glm::dot(to_right, along), 0.3 / std::sqrt(1.09), 1e-6);
        EXPECT_LE(tree.node(twig).radius, tree.node(node).radius);
        EXPECT_GT(glm::distance(tree.node(twig).position, at), tree.node(node).radius);
    }
}

TEST(EditGraftTwig, StandsWhereATreeIsSeenFromTheFront) {
    Tree tree;
    tree.add_root({0, 0, 0}, 0.01);
    const NodeId middle = tree.add_child(0, {0, 1, 0}, 0.01);
    tree.add_child(middle, {0, 2, 0}, 0.01);
    TwigOptions options;
    const NodeId twig = make_twig(tree, middle, options);  // seen from +Z, so right is +X
    const DVec3 way = tree.node(twig).position - DVec3(0, 1, 0);
    EXPECT_NEAR(glm::length(way), 0.6, 1e-12);
    EXPECT_NEAR(tree.node(twig).radius, 0.008, 1e-12);
    EXPECT_LT(glm::length(glm::normalize(way) - glm::normalize(DVec3(1, 0.3, 0))), 1e-12);
    // A branch that hangs has its right on the right of the picture too.
    Tree hanging;
    hanging.add_root({0, 2, 0}, 0.01);
    hanging.add_child(0, {0, 1, 0}, 0.01);
    EXPECT_GT(hanging.node(make_twig(hanging, 0, options)).position.x, 0.3);
    // Seen end on.
    Tree away;
    away.add_root({0, 0, 0}, 0.01);
    away.add_child(0, {0, 0, -1}, 0.01);
    EXPECT_GT(away.node(make_twig(away, 0, options)).position.x, 0.3);
}

TEST(EditGraftTwig, GoesWhereItIsToldAsLongAndThickAsAsked) {
    Tree tree;
    tree.add_root({1, 2, 3}, 0.3);
    tree.add_child(0, {1, 2.02, 3}, 0.3);
    TwigOptions options;
    options.direction = DVec3(0, 0, -5);
    options.length = 0.25;
    options.radius = 0.9;  // not thicker than its host
    const NodeId twig = make_twig(tree, 0, options);
    EXPECT_LT(glm::length(tree.node(twig).position - DVec3(1, 2, 2.75)), 1e-12);
    EXPECT_EQ(tree.node(twig).radius, 0.3);
    // What suits a stout stem with short segments: out of the bark, and no second stem.
    TwigOptions usual;
    const NodeId second = make_twig(tree, 0, usual);
    EXPECT_GT(glm::distance(tree.node(second).position, tree.node(0).position), 0.4);
    EXPECT_LT(tree.node(second).radius, 0.1);
    usual.direction = DVec3(0.0);
    EXPECT_THROW(make_twig(tree, 0, usual), Error);
    usual.direction.reset();
    usual.view = DVec3(0, 1, 0);
    EXPECT_THROW(make_twig(tree, 0, usual), Error);
    usual.view = DVec3(NAN, 1, 0);
    EXPECT_THROW(make_twig(tree, 0, usual), Error);
    EXPECT_THROW(make_twig(tree, 99, {}), Error);
    TwigOptions bad;
    bad.length = -1;
    EXPECT_THROW(make_twig(tree, 0, bad), Error);
    bad.length = 0;
    bad.radius = INFINITY;
    EXPECT_THROW(make_twig(tree, 0, bad), Error);
    EXPECT_EQ(tree.size(), 4u);
}

TEST(EditTwig, IsAsLongAndThickAsAlgorithm5Prints) {
    for (uint64_t seed = 1; seed <= 300; seed++) {
        Random random(seed);
        Tree tree = test::random_tree(seed, 60);
        const std::vector<NodeId> ids = tree.depth_first();
        const NodeId node = ids[random.below(static_cast<uint32_t>(ids.size()))];
        TwigOptions options;
        options.as_printed = true;
        options.direction = random.direction();
        const NodeId child = tree.node(node).first_child;
        if (child == kNoNode) {
            EXPECT_THROW(make_twig(tree, node, options), Error);
            options.length = 0.1;
            EXPECT_NO_THROW(make_twig(tree, node, options));
            continue;
        }
        const double segment = glm::distance(tree.node(node).position, tree.node(child).position);
        const NodeId twig = make_twig(tree, node, options);
        EXPECT_NEAR(glm::distance(tree.node(twig).position, tree.node(node).position), 0.6 * segment, 1e-12);
        EXPECT_EQ(tree.node(twig).radius, 0.8 * tree.node(node).radius);
    }
}

}  // namespace
}  // namespace treerec
