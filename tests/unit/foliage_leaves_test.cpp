#include "foliage/leaves.h"

#include <gtest/gtest.h>

#include <cstring>
#include <map>

#include "error.h"
#include "foliage/branch_axis.h"
#include "foliage/crown.h"
#include "foliage/leaf_placer.h"
#include "geometry/parallel.h"
#include "mesh/leaf_cards.h"
#include "random_tree.h"

namespace treerec {
namespace {

bool same_leaf(const LeafPlacement& a, const LeafPlacement& b) {
    return std::memcmp(&a, &b, sizeof(LeafPlacement)) == 0;
}

// Distance from p to the wood of the whole tree, and the radius there.
std::pair<double, double> nearest_wood(const Tree& tree, const DVec3& p) {
    std::pair<double, double> best{1e9, 0.0};
    for (NodeId id : tree.depth_first()) {
        const Node& node = tree.node(id);
        if (node.parent == kNoNode) continue;
        const DVec3 a = tree.node(node.parent).position, along = node.position - a;
        const double square = glm::dot(along, along);
        const double t = square > 0.0 ? std::clamp(glm::dot(p - a, along) / square, 0.0, 1.0) : 0.0;
        const double distance = glm::distance(p, a + along * t);
        if (distance < best.first) best = {distance, node.radius};
    }
    return best;
}

TEST(Leaves, PresetsHaveSaneRulesAndUnknownNamesAreListed) {
    for (const std::string& name : leaf_preset_names()) {
        const LeafRules rules = leaf_preset(name);
        EXPECT_EQ(rules.enabled, name != "none");
        EXPECT_GT(rules.leaf_size, 0.05);
        EXPECT_GT(rules.internode, 0.0);
    }
    try {
        leaf_preset("plastic");
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("maple"), std::string::npos);
    }
}

TEST(Leaves, SitOnTheBarkOfThinWood) {
    for (uint64_t seed = 0; seed < 20; seed++) {
        const Tree tree = test::random_tree(seed, 200);
        double longest = 0.0;
        for (NodeId id : tree.depth_first())
            if (tree.node(id).parent != kNoNode)
                longest = std::max(
                    longest, glm::distance(tree.node(id).position, tree.node(tree.node(id).parent).position));
        const std::vector<LeafPlacement> leaves = place_leaves(tree, leaf_preset("generic"), seed);
        ASSERT_GT(leaves.size(), tree.nodes_of_kind(NodeKind::kLeaf).size());
        for (const LeafPlacement& leaf : leaves) {
            const auto [distance, radius] = nearest_wood(tree, DVec3(leaf.position));
            // The axis is rounded at bends, where the straight wood cuts the corner.
            ASSERT_LT(distance, radius + 0.12 * longest);
            ASSERT_NEAR(glm::length(leaf.x), 1.0f, 1e-4f);
            ASSERT_NEAR(glm::length(leaf.y), 1.0f, 1e-4f);
            ASSERT_NEAR(glm::length(leaf.outward), 1.0f, 1e-4f);
            ASSERT_NEAR(glm::length(glm::cross(leaf.x, leaf.y) - leaf.z), 0.0f, 1e-4f);
            for (float channel : {leaf.phase, leaf.hue, leaf.stiffness, leaf.sway, leaf.occlusion}) {
                ASSERT_GE(channel, 0.0f);
                ASSERT_LE(channel, 1.0f);
            }
        }
    }
}

bool bears_leaf_at(const std::vector<LeafPlacement>& leaves, const DVec3& place) {
    return std::any_of(leaves.begin(), leaves.end(), [&](const LeafPlacement& leaf) {
        return glm::distance(leaf.position, Vec3(place)) < 1e-4f;
    });
}

TEST(Leaves, EveryTipBearsOne) {
    // Slender wood throughout: no snags.
    Tree tree = test::random_tree(4, 500);
    for (NodeId id : tree.depth_first())
        tree.set_radius(id, std::min(tree.node(id).radius, 0.02));
    LeafRules rules = leaf_preset("birch");
    rules.leaf_area_index = 0.0;
    const std::vector<LeafPlacement> leaves = place_leaves(tree, rules, 1);
    for (NodeId tip : tree.nodes_of_kind(NodeKind::kLeaf))
        EXPECT_TRUE(bears_leaf_at(leaves, tree.node(tip).position));
}

TEST(Leaves, SnagsOnAStoutTrunkBearNone) {
    Tree tree;
    tree.add_root({0, 0, 0}, 0.15);
    const NodeId low = tree.add_child(0, {0, 1, 0}, 0.15);
    NodeId at = low;
    for (int i = 2; i <= 10; i++)
        at = tree.add_child(at, {0, i, 0}, 0.15 - 0.014 * i);
    const NodeId snag = tree.add_child(low, {0.4, 1.2, 0}, 0.01);
    const NodeId on_snag = tree.add_child(snag, {0.5, 1.5, 0}, 0.01);
    const NodeId also_on_snag = tree.add_child(snag, {0.5, 1.2, 0.2}, 0.01);
    const NodeId side_branch = tree.add_child(low, {-1.5, 1.5, 0}, 0.01);
    const NodeId twig = tree.add_child(tree.node(at).parent, {0.3, 9.1, 0}, 0.01);
    const std::vector<LeafPlacement> leaves = place_leaves(tree, leaf_preset("generic"), 1);
    EXPECT_FALSE(bears_leaf_at(leaves, tree.node(on_snag).position));
    EXPECT_FALSE(bears_leaf_at(leaves, tree.node(also_on_snag).position));
    EXPECT_TRUE(bears_leaf_at(leaves, tree.node(side_branch).position));
    EXPECT_TRUE(bears_leaf_at(leaves, tree.node(twig).position));
    EXPECT_TRUE(bears_leaf_at(leaves, tree.node(at).position));
}

// A stem of 10 m and 10 cm radius with a bushy crown above 4 m.
Tree stem_with_a_crown(std::vector<NodeId>& stem) {
    Tree tree;
    stem.push_back(tree.add_root({0, 0, 0}, 0.10));
    for (int i = 1; i <= 20; i++)
        stem.push_back(tree.add_child(stem.back(), {0, 0.5 * i, 0}, 0.10 - 0.004 * i));
    for (int i = 8; i < 20; i++)
        for (int k = 0; k < 4; k++) {
            const double angle = 1.57 * k + i, y = 0.5 * i;
            const DVec3 out(std::cos(angle), 0.3, std::sin(angle));
            NodeId at = stem[static_cast<size_t>(i)];
            for (int j = 1; j <= 6; j++)
                at = tree.add_child(at, DVec3(0, y, 0) + 0.4 * j * out, 0.02 - 0.003 * j);
        }
    return tree;
}

TEST(Leaves, WaterShootsBelowTheCrownBearNone) {
    std::vector<NodeId> stem;
    Tree tree = stem_with_a_crown(stem);
    // The same shoot of 0.8 m, longer than a snag: at the base, and in the crown.
    const auto shoot = [&](NodeId at) {
        const DVec3 from = tree.node(at).position;
        const NodeId knee = tree.add_child(at, from + DVec3(0.5, 0.1, 0.1), 0.006);
        const NodeId side = tree.add_child(knee, from + DVec3(0.6, 0.1, 0.3), 0.003);
        return std::make_pair(tree.add_child(knee, from + DVec3(0.75, 0.25, 0.1), 0.004), side);
    };
    const auto low = shoot(stem[1]), high = shoot(stem[12]);
    // A low branch that reaches far is no shoot.
    const NodeId side_branch = tree.add_child(stem[2], {-2.0, 1.4, 0}, 0.02);
    const std::vector<LeafPlacement> leaves = place_leaves(tree, leaf_preset("generic"), 1);
    EXPECT_FALSE(bears_leaf_at(leaves, tree.node(low.first).position));
    EXPECT_FALSE(bears_leaf_at(leaves, tree.node(low.second).position));
    EXPECT_TRUE(bears_leaf_at(leaves, tree.node(high.first).position));
    EXPECT_TRUE(bears_leaf_at(leaves, tree.node(high.second).position));
    EXPECT_TRUE(bears_leaf_at(leaves, tree.node(side_branch).position));
}

TEST(Leaves, TwigsThatHugTheBarkBearNone) {
    std::vector<NodeId> stem;
    Tree tree = stem_with_a_crown(stem);
    // 1.4 m long, 15 cm from the axis; then one that leaves the bark, and a second stem that does not.
    const auto climb = [&](NodeId from, const DVec3& side, double step, double radius) {
        NodeId at = from;
        for (int i = 1; i <= 6; i++)
            at = tree.add_child(
                at, tree.node(from).position + DVec3(0, 0.25 * i, 0) + side * (i * step + 0.12), radius);
        return at;
    };
    const NodeId ivy = climb(stem[9], DVec3(1, 0, 0), 0.0, 0.004);
    const NodeId twig = climb(stem[9], DVec3(-1, 0, 0), 0.1, 0.004);
    const NodeId twin = climb(stem[9], DVec3(0, 0, 1), 0.0, 0.05);
    const std::vector<LeafPlacement> leaves = place_leaves(tree, leaf_preset("generic"), 1);
    EXPECT_FALSE(bears_leaf_at(leaves, tree.node(ivy).position));
    EXPECT_TRUE(bears_leaf_at(leaves, tree.node(twig).position));
    EXPECT_TRUE(bears_leaf_at(leaves, tree.node(twin).position));
}

TEST(Leaves, SameSeedSameLeavesWhateverTheThreads) {
    const Tree tree = test::random_tree(3, 4000);
    set_thread_count(1);
    const std::vector<LeafPlacement> one = place_leaves(tree, leaf_preset("oak"), 11);
    set_thread_count(4);
    const std::vector<LeafPlacement> four = place_leaves(tree, leaf_preset("oak"), 11);
    set_thread_count(0);
    ASSERT_EQ(one.size(), four.size());
    EXPECT_EQ(std::memcmp(one.data(), four.data(), one.size() * sizeof(LeafPlacement)), 0);
    const std::vector<LeafPlacement> other = place_leaves(tree, leaf_preset("oak"), 12);
    EXPECT_FALSE(same_leaf(one[0], other[0]));
}

TEST(Leaves, PruningOneBranchLeavesTheOthersAlone) {
    Tree tree = test::random_tree(21, 800);
    const LeafRules rules = leaf_preset("generic");
    const std::vector<LeafPlacement> before = place_leaves(tree, rules, 5);
    // A tip inside the crown, so that the tree's measure stays.
    NodeId cut = kNoNode;
    double lowest = 1e9;
    for (NodeId tip : tree.nodes_of_kind(NodeKind::kLeaf))
        if (tree.node(tree.node(tip).parent).child_count > 1 && tree.node(tip).position.y < lowest) {
            lowest = tree.node(tip).position.y;
            cut = tip;
        }
    ASSERT_NE(cut, kNoNode);
    const Vec3 gone(tree.node(cut).position), base(tree.node(tree.node(cut).parent).position);
    tree.remove_subtree(cut);
    const std::vector<LeafPlacement> after = place_leaves(tree, rules, 5);
    const auto key = [](const LeafPlacement& leaf) {
        return std::make_tuple(leaf.position.x, leaf.position.y, leaf.position.z);
    };
    std::map<std::tuple<float, float, float>, LeafPlacement> kept;
    for (const LeafPlacement& leaf : after)
        kept[key(leaf)] = leaf;
    const float reach = 2.0f * glm::distance(gone, base) + 0.7f;
    size_t compared = 0;
    for (const LeafPlacement& leaf : before) {
        if (glm::distance(leaf.position, base) < reach) continue;
        const auto same = kept.find(key(leaf));
        ASSERT_NE(same, kept.end());
        ASSERT_EQ(same->second.size, leaf.size);
        ASSERT_EQ(same->second.phase, leaf.phase);
        ASSERT_EQ(same->second.hue, leaf.hue);
        compared++;
    }
    EXPECT_GT(compared, before.size() / 2);
}

TEST(Leaves, TheLimitKeepsTheArea) {
    const Tree tree = test::random_tree(8, 3000);
    LeafRules rules = leaf_preset("generic");
    const auto area = [](const std::vector<LeafPlacement>& leaves) {
        double sum = 0.0;
        for (const LeafPlacement& leaf : leaves)
            sum += static_cast<double>(leaf.size) * leaf.size;
        return sum;
    };
    const std::vector<LeafPlacement> all = place_leaves(tree, rules, 1);
    rules.maximum_leaves = static_cast<int>(all.size() / 3);
    const std::vector<LeafPlacement> fewer = place_leaves(tree, rules, 1);
    EXPECT_LE(fewer.size(), all.size() / 3);
    EXPECT_GT(fewer.size(), all.size() / 3 - 3);
    EXPECT_NEAR(area(fewer) / area(all), 1.0, 0.05);
    for (int level = 1; level < 4; level++) {
        const std::vector<LeafPlacement> thin = thin_leaves(all, level);
        EXPECT_LT(thin.size(), all.size() / 2);
        EXPECT_NEAR(area(thin) / area(all), 1.0, 0.05) << level;
    }
    rules.maximum_leaves = 0;
    EXPECT_TRUE(place_leaves(tree, rules, 1).empty());
}

// From afar a palm was seven fronds, then three, of two and four times their length.
TEST(Leaves, FewLargeLeavesStayAsTheyAre) {
    Tree stem;
    NodeId at = stem.add_root({0, 0, 0}, 0.2);
    for (int i = 1; i <= 20; i++)
        at = stem.add_child(at, {0, 0.5 * i, 0}, 0.15);
    const std::vector<LeafPlacement> fronds = place_leaves(stem, leaf_preset("palm"), 1);
    ASSERT_GT(fronds.size(), 20u);
    ASSERT_LT(fronds.size(), 64u);
    for (const double level : {0.5, 1.0, 2.0, 4.0}) {
        const std::vector<LeafPlacement> kept = thin_leaves(fronds, level);
        ASSERT_EQ(kept.size(), fronds.size()) << level;
        for (size_t i = 0; i < kept.size(); i++)
            EXPECT_EQ(kept[i].size, fronds[i].size);
    }
    // A budget still finds a level for them.
    EXPECT_LT(thin_leaves(fronds, 7.0).size(), fronds.size() / 8);
    EXPECT_LT(thin_leaves(fronds, 16.0).size(), 2u);
}

// A palm was nearly black in full sun: its wood ends in one point, and fronds were shaded as the inside of a
// crown that looks down.
TEST(Leaves, FrondsOfOneTipAreShadedWhereTheyAre) {
    for (const double tall : {2.0, 5.0, 10.0, 20.0}) {
        Tree stem;
        NodeId at = stem.add_root({0, 0, 0}, 0.02 * tall);
        for (int i = 1; i <= 20; i++)
            at = stem.add_child(at, {0, 0.05 * tall * i, 0}, 0.015 * tall);
        const std::vector<LeafPlacement> fronds = place_leaves(stem, leaf_preset("palm"), 1);
        ASSERT_GT(fronds.size(), 5u) << tall;
        double along = 0.0, open = 0.0;
        for (const LeafPlacement& frond : fronds) {
            along += glm::dot(frond.outward, frond.y) / static_cast<double>(fronds.size());
            open += frond.occlusion / static_cast<double>(fronds.size());
        }
        EXPECT_GT(along, 0.5) << tall;
        EXPECT_GT(open, 0.55) << tall;
    }
}

TEST(Leaves, CoarserLevelsAreSubsets) {
    const std::vector<LeafPlacement> all = place_leaves(test::random_tree(8, 1000), leaf_preset("maple"), 1);
    std::vector<LeafPlacement> finer = all;
    for (int level = 1; level < 4; level++) {
        const std::vector<LeafPlacement> coarser = thin_leaves(all, level);
        size_t at = 0;
        for (const LeafPlacement& leaf : coarser) {
            // About its middle, which stays where it is.
            while (at < finer.size() && (finer[at].phase != leaf.phase || finer[at].y != leaf.y))
                at++;
            ASSERT_LT(at, finer.size()) << level;
            const Vec3 middle = finer[at].position + finer[at].y * (0.5f * finer[at].size);
            EXPECT_LT(glm::distance(leaf.position + leaf.y * (0.5f * leaf.size), middle), 1e-4f);
        }
        finer = coarser;
    }
}

TEST(Leaves, SmallTreesBearSmallLeaves) {
    const std::vector<LeafPlacement> sapling =
        place_leaves(test::random_tree(2, 150, 1.0), leaf_preset("oak"), 1);
    const std::vector<LeafPlacement> grown =
        place_leaves(test::random_tree(2, 150, 20.0), leaf_preset("oak"), 1);
    for (const LeafPlacement& leaf : sapling)
        EXPECT_LT(leaf.size, 0.18f);
    for (const LeafPlacement& leaf : grown)
        EXPECT_GT(leaf.size, 0.18f);
    // Sprays of a tree of 4 m, as many an orchard's, are well under 20 cm.
    LeafRules rules = leaf_preset("generic");
    rules.size_variation = 0.0;
    for (const LeafPlacement& leaf : place_leaves(test::random_tree(2, 150, 4.0), rules, 1))
        EXPECT_LT(leaf.size, 0.16f);
}

TEST(Leaves, WildTreesAndNothing) {
    EXPECT_TRUE(place_leaves(Tree(), {}, 1).empty());
    Tree lone;
    lone.add_root(DVec3(0.0), 0.1);
    EXPECT_TRUE(place_leaves(lone, {}, 1).empty());
    for (uint64_t seed = 0; seed < 200; seed++) {
        const Tree tree = test::wild_tree(seed, 2 + static_cast<int>(seed % 50));
        for (const LeafPlacement& leaf : place_leaves(tree, leaf_preset("maple"), seed)) {
            ASSERT_TRUE(is_finite(DVec3(leaf.position)) && is_finite(DVec3(leaf.x)) &&
                        is_finite(DVec3(leaf.y)) && is_finite(DVec3(leaf.z)));
            ASSERT_TRUE(std::isfinite(leaf.size));
        }
    }
}

TEST(BranchAxis, PassesThroughTheNodesAndNeverStandsStill) {
    for (uint64_t seed = 0; seed < 60; seed++) {
        const Tree tree = seed % 2 ? test::random_tree(seed, 200) : test::wild_tree(seed, 60);
        const BranchList list = list_branches(tree);
        std::vector<AxisPoint> points;
        for (const Branch& branch : list.branches) {
            sample_axis(tree, list, branch, 1e-5, points);
            if (points.empty()) continue;
            ASSERT_GE(points.size(), 2u);
            const NodeId start = branch.attach == kNoNode ? list.nodes[branch.begin] : branch.attach;
            EXPECT_EQ(points.front().position, tree.node(start).position);
            EXPECT_NEAR(glm::distance(points.back().position, tree.node(list.nodes[branch.end - 1]).position),
                        0.0, 2e-5);
            for (size_t i = 1; i < points.size(); i++) {
                ASSERT_GT(points[i].along, points[i - 1].along);
                ASSERT_NEAR(glm::length(points[i].direction), 1.0, 1e-9);
                ASSERT_GT(points[i].radius, 0.0);
            }
            size_t hint = 0;
            const double middle = 0.5 * points.back().along;
            EXPECT_NEAR(axis_at(points, middle, hint).along, middle, 1e-9);
        }
    }
}

// Its size decides whether a leaf is made at all.
TEST(Leaves, TheSizeOfALeafIsKnownBeforeItIsMade) {
    for (const uint64_t seed : {1, 2, 3}) {
        const Tree tree = test::random_tree(seed, 120);
        for (const std::string& name : leaf_preset_names()) {
            const LeafRules rules = leaf_preset(name);
            const LeafPlacer placer(tree, rules, seed);
            std::vector<AxisPoint> axis;
            std::vector<LeafSpot> spots;
            for (const Branch& branch : placer.list.branches)
                placer.bear(branch, 1.0, 1.0, axis, spots);
            EXPECT_FALSE(spots.empty());
            for (const LeafSpot& spot : spots)
                ASSERT_EQ(placer.size_of(spot), placer.leaf_at(spot).size) << name << " " << spot.number;
        }
    }
}

TEST(Crown, SwayGrowsFromTheRootToTheTop) {
    const Tree tree = test::random_tree(5, 300);
    const Crown crown = measure_crown(tree);
    double top = 0.0;
    for (NodeId id : tree.depth_first())
        top = std::max(top, crown.sway(tree.node(id).position));
    EXPECT_EQ(crown.sway(tree.node(tree.root()).position), 0.0);
    EXPECT_NEAR(top, 1.0, 1e-12);
    EXPECT_NEAR(crown.openness(crown.centre), 0.0, 1e-12);
    EXPECT_EQ(crown.openness(crown.centre + DVec3(3.0 * crown.radii.x, 0.0, 0.0)), 1.0);
}

}  // namespace
}  // namespace treerec
