// Shaping: what moves, what stays, by how much.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "edit/commands/address.h"
#include "edit/delta.h"
#include "edit/move.h"
#include "edit/select.h"
#include "edit/smooth.h"
#include "edit/vary/sag.h"
#include "random_tree.h"
#include "tree/branches.h"

namespace treerec {
namespace {

using test::random_tree;
using test::wild_tree;

// A row of nodes along +X, `step` apart, on a stem of one segment.
Tree bough(int nodes, double step, double radius) {
    Tree tree;
    NodeId at = tree.add_root({0, 0, 0}, 0.1);
    at = tree.add_child(at, {0, 1, 0}, 0.1);
    for (int i = 1; i <= nodes; i++)
        at = tree.add_child(at, {i * step, 1, 0}, radius);
    return tree;
}

double length_of(const Tree& tree) {
    return subtree_lengths(tree)[tree.root()];
}

void expect_near(const DVec3& a, const DVec3& b, double tolerance, const std::string& what) {
    EXPECT_LE(glm::distance(a, b), tolerance) << what;
}

TEST(EditSmooth, RadiiBecomeEvenAndEndsStay) {
    for (uint64_t seed = 1; seed <= 30; seed++) {
        Tree tree = random_tree(seed, 300);
        Random random(seed);
        for (const NodeId id : tree.depth_first())
            tree.set_radius(id, tree.node(id).radius * random.uniform(0.5, 1.5));
        tree.set_flag(tree.node(tree.root()).first_child, kMeasuredRadiusFlag, true);
        const Tree before = tree;
        smooth_radii(tree, select(tree, "all").ids, {0.5, 20}, false, false);
        const BranchList list = list_branches(before);
        double rough_before = 0.0, rough_after = 0.0;
        for (const Branch& branch : list.branches) {
            const auto chain = list.nodes_of(branch);
            EXPECT_EQ(tree.node(chain.front()).radius, before.node(chain.front()).radius);
            EXPECT_EQ(tree.node(chain.back()).radius, before.node(chain.back()).radius);
            for (size_t i = 1; i + 1 < chain.size(); i++) {
                const auto bend = [&](const Tree& t) {
                    return std::abs(t.node(chain[i - 1]).radius - 2.0 * t.node(chain[i]).radius +
                                    t.node(chain[i + 1]).radius);
                };
                rough_before += bend(before);
                rough_after += bend(tree);
            }
        }
        EXPECT_LT(rough_after, 0.3 * rough_before) << "seed " << seed;
        Tree tapered = before;
        smooth_radii(tapered, select(tapered, "all").ids, {0.5, 5}, true, true);
        for (const NodeId id : tapered.depth_first()) {
            const Node& node = tapered.node(id);
            if (node.is_measured()) {
                EXPECT_EQ(node.radius, before.node(id).radius);
            } else if (node.parent != kNoNode) {
                EXPECT_LE(node.radius, tapered.node(node.parent).radius);
            }
        }
    }
}

TEST(EditSmooth, PathsBecomeStraighterBetweenForksThatStay) {
    for (uint64_t seed = 1; seed <= 30; seed++) {
        const Tree before = seed % 3 ? random_tree(seed, 300) : wild_tree(seed, 300);
        Tree tree = before;
        const std::vector<NodeId> moved = smooth_paths(tree, select(tree, "all").ids, {0.7, 30});
        EXPECT_FALSE(moved.empty());
        for (const NodeId id : tree.depth_first()) {
            if (before.node(id).child_count == 1 && id != tree.root()) continue;
            EXPECT_EQ(tree.node(id).position, before.node(id).position);
        }
        EXPECT_LT(length_of(tree), length_of(before));
        // None but those asked for.
        Tree one = before;
        smooth_paths(one, {moved.front()});
        EXPECT_EQ(TreeDelta::between(before, one).changed(), std::vector<NodeId>{moved.front()});
    }
}

TEST(EditSmooth, KinksAreRelaxedToTheAngleAndNoFurther) {
    Tree tree = bough(6, 0.5, 0.02);
    const NodeId kinked = 4;
    const NodeId side = tree.add_child(kinked, {1.5, 1.5, 0.5}, 0.005);
    tree.set_position(kinked, {1.5, 1.6, 0.0});
    const Tree before = tree;
    const auto turn = [&](const Tree& t) {
        const DVec3 in = t.node(4).position - t.node(3).position,
                    out = t.node(5).position - t.node(4).position;
        return glm::degrees(std::acos(glm::dot(in, out) / glm::length(in) / glm::length(out)));
    };
    EXPECT_GT(turn(tree), 90.0);
    EXPECT_EQ(relax_kinks(tree, {kinked}, 30.0), (std::vector<NodeId>{kinked, side}));
    EXPECT_NEAR(turn(tree), 30.0, 1e-6);
    expect_near(tree.node(side).position - tree.node(kinked).position,
                before.node(side).position - before.node(kinked).position, 1e-12, "the side branch");
    EXPECT_TRUE(relax_kinks(tree, {kinked}, 30.0).empty());
    for (uint64_t seed = 1; seed <= 20; seed++) {
        Tree random = random_tree(seed, 300);
        const BranchList list = list_branches(random);
        relax_kinks(random, select(random, "all").ids, 40.0, 1000);
        for (const Branch& branch : list.branches) {
            const auto chain = list.nodes_of(branch);
            for (size_t i = 1; i + 1 < chain.size(); i++) {
                const DVec3 in = random.node(chain[i]).position - random.node(chain[i - 1]).position;
                const DVec3 out = random.node(chain[i + 1]).position - random.node(chain[i]).position;
                const double angle = std::atan2(glm::length(glm::cross(in, out)), glm::dot(in, out));
                EXPECT_LT(glm::degrees(angle), 40.01) << "seed " << seed;
            }
        }
    }
}

TEST(EditSmooth, SubdivisionKeepsTheOldNodesAndTheShape) {
    for (uint64_t seed = 1; seed <= 30; seed++) {
        const Tree before = seed % 3 ? random_tree(seed, 200) : wild_tree(seed, 200);
        for (const bool curved : {false, true}) {
            Tree tree = before;
            const std::vector<NodeId> added = subdivide(tree, select(tree, "all").ids, 0.07, curved);
            ASSERT_EQ(tree.check(), std::nullopt);
            EXPECT_EQ(tree.size(), before.size() + added.size());
            const BranchList list = list_branches(before);
            for (const NodeId id : before.depth_first()) {
                EXPECT_EQ(tree.node(id).position, before.node(id).position);
                EXPECT_EQ(tree.node(id).radius, before.node(id).radius);
            }
            double longest = 0.0;
            for (const NodeId id : tree.depth_first())
                if (tree.node(id).parent != kNoNode)
                    longest = std::max(longest, glm::distance(tree.node(id).position,
                                                              tree.node(tree.node(id).parent).position));
            if (curved) continue;
            EXPECT_LE(longest, 0.07 * (1.0 + 1e-9));
            EXPECT_NEAR(length_of(tree), length_of(before), 1e-9 * length_of(before));
        }
    }
    Tree tree = bough(3, 0.5, 0.02);
    EXPECT_THROW(subdivide(tree, {3}, 1e-9), Error);
    EXPECT_THROW(subdivide(tree, {3}, 0.0), Error);
    EXPECT_THROW(insert_node(tree, tree.root()), Misfit);
    EXPECT_EQ(tree.node(insert_node(tree, 3, 0.25)).position, DVec3(0.625, 1, 0));
}

TEST(EditSmooth, ACurveRunsThroughAnArc) {
    Tree tree;
    NodeId at = tree.add_root({1, 0, 0}, 0.1);
    for (int i = 1; i <= 6; i++)
        at = tree.add_child(at, {std::cos(0.3 * i), std::sin(0.3 * i), 0}, 0.1);
    for (const NodeId id : subdivide(tree, {2, 3, 4, 5}, 0.05, true))
        EXPECT_NEAR(glm::length(tree.node(id).position), 1.0, 5e-4);
}

TEST(EditSmooth, AStraightBranchCarriesItsSideBranches) {
    for (uint64_t seed = 1; seed <= 20; seed++) {
        Tree tree = random_tree(seed, 300);
        const Tree before = tree;
        const BranchList list = list_branches(before);
        const Branch& branch = list.branches[seed % list.branches.size()];
        const auto chain = list.nodes_of(branch);
        straighten(tree, chain.back());
        const DVec3 from = before.node(branch.attach != kNoNode ? branch.attach : chain.front()).position;
        const DVec3 way = glm::normalize(before.node(chain.back()).position - from);
        for (const NodeId id : chain)
            EXPECT_LT(glm::length(glm::cross(tree.node(id).position - from, way)), 1e-9);
        for (const NodeId id : before.depth_first()) {
            if (list.branches[list.branch_of[id]].attach == kNoNode || id == chain.front()) continue;
            const bool on = list.branch_of[id] == list.branch_of[chain.front()];
            if (on) continue;
            const NodeId parent = before.node(id).parent;
            expect_near(tree.node(id).position - tree.node(parent).position,
                        before.node(id).position - before.node(parent).position, 1e-9, "carried");
        }
    }
}

TEST(EditMove, AloneWithItsSubtreeAndWithFalloff) {
    const Tree before = bough(10, 0.5, 0.02);
    Tree tree = before;
    EXPECT_EQ(move_nodes(tree, {5}, {0, 1, 0}, {false, 0.0}), std::vector<NodeId>{5});
    EXPECT_EQ(tree.node(5).position, DVec3(2, 2, 0));
    tree = before;
    EXPECT_EQ(move_nodes(tree, {5}, {0, 1, 0}, {true, 0.0}), (std::vector<NodeId>{5, 6, 7, 8, 9, 10, 11}));
    EXPECT_EQ(tree.node(4).position, before.node(4).position);
    tree = before;
    move_nodes(tree, {5}, {0, 1, 0}, {false, 1.25});
    // 0.5 m and 1 m off: 1 - smoothstep(0.4), 1 - smoothstep(0.8); 1.5 m: nothing.
    EXPECT_NEAR(tree.node(5).position.y, 2.0, 1e-15);
    EXPECT_NEAR(tree.node(6).position.y, 1.648, 1e-12);
    EXPECT_NEAR(tree.node(4).position.y, 1.648, 1e-12);
    EXPECT_NEAR(tree.node(7).position.y, 1.104, 1e-12);
    EXPECT_EQ(tree.node(8).position.y, 1.0);
    EXPECT_EQ(tree.node(2).position.y, 1.0);
    EXPECT_THROW(move_nodes(tree, {5}, {0, INFINITY, 0}), Error);
    EXPECT_THROW(move_nodes(tree, {5, 99}, {0, 1, 0}), Misfit);
}

TEST(EditMove, TurningMirroringAndScalingKeepTheJointAndTheShape) {
    for (uint64_t seed = 1; seed <= 30; seed++) {
        const Tree before = seed % 3 ? random_tree(seed, 200) : wild_tree(seed, 200);
        Random random(seed);
        const std::vector<NodeId> ids = before.depth_first();
        const NodeId id = ids[random.below(static_cast<uint32_t>(ids.size()))];
        const std::vector<NodeId> branch = before.depth_first(id);
        const std::set<NodeId> in(branch.begin(), branch.end());
        const NodeId parent = before.node(id).parent;
        const DVec3 joint = before.node(parent != kNoNode ? parent : id).position;
        const DVec3 axis = random.direction();
        Tree turned = before, mirrored = before, scaled = before;
        turn_branch(turned, id, axis, 70.0);
        mirror_branch(mirrored, id, axis);
        scale_branch(scaled, id, 2.0, 0.5);
        for (const NodeId node : ids) {
            if (!in.count(node)) {
                for (const Tree* tree : {&turned, &mirrored, &scaled})
                    EXPECT_EQ(tree->node(node).position, before.node(node).position);
                continue;
            }
            const double distance = glm::distance(before.node(node).position, joint);
            EXPECT_NEAR(glm::distance(turned.node(node).position, joint), distance, 1e-9);
            EXPECT_NEAR(glm::distance(mirrored.node(node).position, joint), distance, 1e-9);
            EXPECT_NEAR(glm::distance(scaled.node(node).position, joint), 2.0 * distance, 1e-9);
            EXPECT_EQ(scaled.node(node).radius, 0.5 * before.node(node).radius);
        }
        mirror_branch(mirrored, id, axis * -3.0);
        turn_branch(turned, id, axis * 2.0, -70.0);
        for (const NodeId node : branch) {
            expect_near(mirrored.node(node).position, before.node(node).position, 1e-9, "mirrored back");
            expect_near(turned.node(node).position, before.node(node).position, 1e-9, "turned back");
        }
    }
    Tree tree = bough(2, 0.5, 0.02);
    turn_branch(tree, 2, {0, 1, 0}, 90.0);
    expect_near(tree.node(2).position, {0, 1, -0.5}, 1e-12, "counter-clockwise about +Y, X goes to -Z");
}

TEST(EditMove, NewWoodGrowsOnOrAside) {
    Tree tree = bough(3, 0.5, 0.02);
    GrowNodeOptions options;
    options.nodes = 2;
    const std::vector<NodeId> on = grow_node(tree, 4, options);
    ASSERT_EQ(on.size(), 2U);
    expect_near(tree.node(on[1]).position, {2.0, 1, 0}, 1e-12, "a segment's length on");
    EXPECT_LT(tree.node(on[0]).radius, 0.02);
    const NodeId one = grow_node(tree, 3).front(), two = grow_node(tree, 3).front();
    EXPECT_GT(glm::distance(tree.node(one).position, tree.node(two).position), 0.1);
    EXPECT_GT(glm::distance(tree.node(one).position, tree.node(4).position), 0.1);
    options.direction = DVec3(0, 0, 0);
    EXPECT_THROW(grow_node(tree, 3, options), Error);
    options.direction = DVec3(0, 0, 2);
    options.length = 0.25;
    options.radius = 0.004;
    options.nodes = 1;
    const NodeId given = grow_node(tree, 3, options).front();
    expect_near(tree.node(given).position - tree.node(3).position, {0, 0, 0.25}, 1e-12, "as asked");
    EXPECT_EQ(tree.node(given).radius, 0.004);
}

TEST(EditMove, ABranchHangsElsewhere) {
    Tree tree = bough(4, 0.5, 0.02);
    const NodeId side = tree.add_child(3, {1.0, 1.5, 0}, 0.01), tip = tree.add_child(side, {1.0, 2, 0}, 0.01);
    Tree stays = tree;
    attach_branch(stays, side, 2, false);
    EXPECT_EQ(stays.node(side).parent, 2);
    EXPECT_EQ(stays.node(tip).position, DVec3(1.0, 2, 0));
    attach_branch(tree, side, 2, true);
    expect_near(tree.node(tip).position, DVec3(0.5, 2, 0), 1e-12, "brought along");
    EXPECT_EQ(tree.check(), std::nullopt);
    EXPECT_THROW(attach_branch(tree, side, tip, true), Misfit);
    EXPECT_THROW(attach_branch(tree, tree.root(), tip, true), Misfit);
}

// A bar of constant thickness held at one end sinks by q L^4 / (8 E I) under its weight.
TEST(EditSag, ABarBendsAsTheBeamFormulaSays) {
    const double length = 1.0, radius = 0.01;
    Tree tree = bough(100, length / 100, radius);
    tree.set_radius(1, radius);
    SagOptions options;
    options.density = 900.0;
    options.stiffness = 8e9;
    const NodeId tip = tree.depth_first().back();
    std::vector<NodeId> bar = tree.depth_first();
    bar.erase(bar.begin(), bar.begin() + 2);
    sag(tree, bar, options);
    const double q = 900.0 * kPi * radius * radius * 9.81;
    const double inertia = kPi / 4.0 * std::pow(radius, 4.0);
    const double sinks = q * std::pow(length, 4.0) / (8.0 * 8e9 * inertia);
    EXPECT_NEAR(1.0 - tree.node(tip).position.y, sinks, 0.02 * sinks);
    EXPECT_NEAR(length_of(tree), 1.0 + length, 1e-9);
}

TEST(EditSag, ThinWoodBendsMoreAndNeverPastStraightDown) {
    Tree thick = bough(20, 0.1, 0.02), thin = bough(20, 0.1, 0.005);
    const NodeId tip = thick.depth_first().back();
    sag(thick, select(thick, "all").ids);
    sag(thin, select(thin, "all").ids);
    EXPECT_LT(thin.node(tip).position.y, thick.node(tip).position.y);
    Tree string = bough(20, 0.1, 0.0005);
    string.set_radius(1, 0.0005);
    SagOptions options;
    options.load = 10.0;
    options.steps = 100;
    sag(string, select(string, "all").ids, options);
    EXPECT_LT(string.node(tip).position.y, -0.5);
    for (const NodeId id : string.depth_first(3)) {
        const Node& node = string.node(id);
        EXPECT_GE(node.position.x, string.node(node.parent).position.x - 0.03) << "past straight down";
    }
    options.weight = -5.0;
    Tree lifted = bough(20, 0.1, 0.005);
    sag(lifted, select(lifted, "all").ids, options);
    EXPECT_GT(lifted.node(tip).position.y, 1.0);
    // An upright stem has nothing that bends it.
    Tree stem = bough(0, 0.1, 0.02);
    EXPECT_TRUE(sag(stem, select(stem, "all").ids).empty());
    for (uint64_t seed = 1; seed <= 20; seed++) {
        Tree tree = wild_tree(seed, 200);
        const double before = length_of(tree);
        sag(tree, select(tree, "all").ids, {100.0, 1.0, 900.0, 8e9, 8});
        ASSERT_EQ(tree.check(), std::nullopt);
        EXPECT_NEAR(length_of(tree), before, 1e-9 * before);
    }
}

// As if each node was put into its segment alone, but in time that grows with the tree.
TEST(EditSmooth, SubdivisionIsOneInsertionAfterAnother) {
    for (uint64_t seed = 1; seed <= 40; seed++) {
        Tree tree = seed % 3 ? random_tree(seed, 100) : wild_tree(seed, 100);
        tree.remove_subtree(tree.depth_first().back());  // so that an id is free
        Tree slow = tree;
        const std::vector<NodeId> added = subdivide(tree, select(tree, "all").ids, 0.1, false);
        const BranchList list = list_branches(slow);
        const Tree before = slow;
        std::vector<NodeId> expected;
        for (const Branch& branch : list.branches)
            for (const NodeId id : list.nodes_of(branch)) {
                const NodeId parent = before.node(id).parent;
                if (parent == kNoNode) continue;
                const DVec3 from = before.node(parent).position, to = before.node(id).position;
                const int parts = static_cast<int>(std::ceil(glm::distance(from, to) / 0.1));
                for (int part = 1; part < parts; part++) {
                    const NodeId middle = static_cast<NodeId>(before.id_end() + expected.size());
                    const Node& made = tree.node(middle);
                    expected.push_back(slow.insert_before(id, made.position, made.radius, made.flags));
                    ASSERT_LT(glm::distance(made.position, glm::mix(from, to, double(part) / parts)), 1e-12);
                }
            }
        EXPECT_EQ(added, expected);
        EXPECT_TRUE(identical(tree, slow)) << "seed " << seed;
    }
    // A stem of many pieces, each of which lies under all that follow.
    Tree stem;
    NodeId at = stem.add_root(DVec3(0.0), 0.1);
    for (int i = 1; i <= 100000; i++)
        at = stem.add_child(at, DVec3(0.0, i, 0.0), 0.1);
    EXPECT_EQ(subdivide(stem, select(stem, "all").ids, 0.5, true).size(), 100000u);
    EXPECT_EQ(stem.node(at).depth, 200001);
}

}  // namespace
}  // namespace treerec
