#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "error.h"
#include "foliage/crown.h"
#include "foliage/leaf_area.h"
#include "foliage/leaves.h"
#include "random_tree.h"

namespace treerec {
namespace {

using Place = std::array<float, 3>;

// Square metres of blades over those of the ground below them, counted by half a metre.
double index_of(const std::vector<LeafPlacement>& leaves, const LeafRules& rules) {
    std::set<std::pair<int, int>> ground;
    double blades = 0.0;
    for (const LeafPlacement& leaf : leaves) {
        const Vec3 middle = leaf.position + leaf.y * (0.5f * leaf.size);
        ground.emplace(static_cast<int>(std::floor(middle.x / 0.5f)),
                       static_cast<int>(std::floor(middle.z / 0.5f)));
        blades += blade_area(rules) * leaf.size * leaf.size;
    }
    return blades / (0.25 * static_cast<double>(ground.size()));
}

// Slender wood: no snags.
Tree leafy(uint64_t seed, int nodes) {
    Tree tree = test::random_tree(seed, nodes, 9.0);
    for (const NodeId id : tree.depth_first())
        tree.set_radius(id, std::min(tree.node(id).radius, 0.01));
    return tree;
}

std::set<Place> places(const std::vector<LeafPlacement>& leaves) {
    std::set<Place> found;
    for (const LeafPlacement& leaf : leaves)
        found.insert({leaf.position.x, leaf.position.y, leaf.position.z});
    return found;
}

TEST(LeafArea, ACrownBearsWhatItsKindDoesHoweverManyTwigs) {
    for (const char* name : {"birch", "oak", "spruce"})
        for (const int nodes : {2500, 5000}) {
            const Tree tree = leafy(3, nodes);
            LeafRules rules = leaf_preset(name);
            rules.maximum_leaves = 1000000;
            const double wanted = rules.leaf_area_index * light_on(measure_crown(tree));
            const double index = index_of(place_leaves(tree, rules, 1), rules);
            EXPECT_GT(index, 0.7 * wanted) << name << " " << nodes;
            EXPECT_LT(index, 1.15 * wanted) << name << " " << nodes;
        }
}

TEST(LeafArea, ALowerIndexTakesSomeOfTheLeavesAndTheInnerFirst) {
    const Tree tree = leafy(5, 4000);
    LeafRules rules = leaf_preset("oak");
    rules.maximum_leaves = 1000000;
    rules.internode = 0.03;
    rules.leaf_area_index = 0.0;
    const std::vector<LeafPlacement> all = place_leaves(tree, rules, 1);
    std::set<Place> before = places(all);
    for (const double index : {6.0, 3.0, 1.0}) {
        rules.leaf_area_index = index;
        const std::set<Place> now = places(place_leaves(tree, rules, 1));
        EXPECT_LT(now.size(), before.size()) << index;
        EXPECT_TRUE(std::includes(before.begin(), before.end(), now.begin(), now.end())) << index;
        before = now;
    }
    rules.leaf_area_index = 3.0;
    before = places(place_leaves(tree, rules, 1));
    double open[2] = {0.0, 0.0}, count[2] = {0.0, 0.0};
    for (const LeafPlacement& leaf : all) {
        const int stays = before.contains({leaf.position.x, leaf.position.y, leaf.position.z});
        open[stays] += leaf.occlusion;
        count[stays]++;
    }
    EXPECT_GT(open[1] / count[1], open[0] / count[0] + 0.05);
}

TEST(LeafArea, WhatIsCutOffMovesNoLeafAside) {
    Tree tree = leafy(7, 3000);
    LeafRules rules = leaf_preset("oak");
    rules.maximum_leaves = 1000000;
    const std::vector<LeafPlacement> before = place_leaves(tree, rules, 1);
    const NodeId cut = tree.nodes_of_kind(NodeKind::kLeaf).front();
    const DVec3 gone = tree.node(cut).position, base = tree.node(tree.node(cut).parent).position;
    tree.remove_subtree(cut);
    const std::set<Place> after = places(place_leaves(tree, rules, 1));
    const double reach = 2.0 * glm::distance(gone, base) + 1.7;
    size_t compared = 0;
    for (const LeafPlacement& leaf : before) {
        if (glm::length(DVec2(leaf.position.x - base.x, leaf.position.z - base.z)) < reach) continue;
        ASSERT_TRUE(after.contains({leaf.position.x, leaf.position.y, leaf.position.z}));
        compared++;
    }
    EXPECT_GT(compared, before.size() / 4);
}

TEST(LeafArea, SlenderCrownsHaveLightFromTheSides) {
    Crown crown;
    crown.radii = {2.0, 2.0, 2.0};
    EXPECT_EQ(light_on(crown), 1.0);
    double before = 1.0;
    for (const double high : {4.0, 8.0, 16.0}) {
        crown.radii.y = high;
        EXPECT_GT(light_on(crown), before);
        before = light_on(crown);
    }
    // Of a very slender one a quarter of the surface, pi^2 a c, over the ground, pi a^2.
    crown.radii.y = 3000.0;
    EXPECT_NEAR(light_on(crown) / (kPi / 4.0 * 1000.0), 1.0, 0.02);
}

TEST(LeafArea, CompoundLeavesCountTheirLeaflets) {
    LeafRules rules;
    rules.form = LeafForm::kSimple;
    const double one = blade_area(rules);
    EXPECT_GT(one, 0.5 * rules.blade_width);
    EXPECT_LT(one, 0.8 * rules.blade_width);
    rules.form = LeafForm::kPalmate;
    rules.leaflets = 5;
    EXPECT_GT(blade_area(rules), 2.0 * one);
    EXPECT_LT(blade_area(rules), 5.0 * one);
    rules.leaf_area_index = -1.0;
    EXPECT_THROW(check_leaf_rules(rules), Error);
}

}  // namespace
}  // namespace treerec
