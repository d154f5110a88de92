// Wood that bears leaves of several kinds.
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <string>

#include "cases.h"
#include "error.h"
#include "foliage/foliage_twigs.h"
#include "foliage/leaf_rule_text.h"
#include "foliage/leaves.h"
#include "mesh/levels.h"
#include "random_tree.h"
#include "tree/branches.h"

namespace treerec {
namespace {

using test::cases;
using test::random_tree;

std::string error_of(const std::string& text) {
    try {
        plain_leaf_rule(text);
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

// The bytes of leaves, in an order of their own.
std::vector<std::string> sorted(const std::vector<LeafPlacement>& leaves) {
    std::vector<std::string> bytes;
    for (const LeafPlacement& leaf : leaves)
        bytes.emplace_back(reinterpret_cast<const char*>(&leaf), sizeof leaf);
    std::sort(bytes.begin(), bytes.end());
    return bytes;
}

// Without their light, which is a matter of all leaves around them.
std::vector<LeafPlacement> unlit(std::vector<LeafPlacement> leaves) {
    for (LeafPlacement& leaf : leaves) {
        leaf.outward = Vec3(0.0f);
        leaf.occlusion = 1.0f;
    }
    return leaves;
}

// Branches, single nodes and tips with rules, at random.
void paint(Tree& tree, const std::vector<std::string>& rules, Random& random) {
    const std::vector<NodeId> ids = tree.depth_first();
    for (int strokes = 0; strokes < 12; strokes++) {
        const NodeId from = ids[random.below(static_cast<uint32_t>(ids.size()))];
        const uint8_t number =
            tree.name_leaf_rule(plain_leaf_rule(rules[random.below(static_cast<uint32_t>(rules.size()))]));
        for (const NodeId id : random.below(3) == 0 ? std::vector<NodeId>{from} : tree.depth_first(from))
            tree.set_leaf_rule(id, number);
    }
}

Foliage random_foliage(const Tree& tree, Random& random) {
    std::vector<Vec3> points;
    const Bounds bounds = tree.bounds();
    for (int i = 0; i < 3000; i++)
        points.emplace_back(bounds.min +
                            bounds.size() * DVec3(random.uniform(), random.uniform(), random.uniform()));
    return gather_foliage(points, {});
}

TEST(LeafKinds, RulesHaveOneText) {
    EXPECT_EQ(plain_leaf_rule("default"), "");
    EXPECT_EQ(plain_leaf_rule("oak"), "oak");
    EXPECT_EQ(plain_leaf_rule("  curl=40.0\t oak   leaf_size=0.20 "), "oak leaf_size=0.2 curl=40");
    EXPECT_EQ(plain_leaf_rule("droop=6e1"), "droop=60");
    EXPECT_EQ(plain_leaf_rule("none"), "none");
    for (const std::string& name : leaf_preset_names())
        EXPECT_EQ(plain_leaf_rule(name), name);
    for (const char* text : {"maple form=simple leaf_size=0.1 petiole_length=0.05", "look=birch angle=70",
                             "oak form=sprig sprig=F[+F]F[-F]F whorl_size=4 arrangement=whorled"})
        EXPECT_EQ(plain_leaf_rule(plain_leaf_rule(text)), plain_leaf_rule(text)) << text;
    EXPECT_EQ(error_of("ok").substr(0, 33), "'ok' is no leaf rule; write defau");
    EXPECT_EQ(error_of(""),
              "A leaf rule is missing: write default, a preset, or changes of a rule, as in droop=60.");
    EXPECT_EQ(error_of("oak pine"), "A leaf rule begins with one preset, not with 'oak' and 'pine'.");
    EXPECT_EQ(error_of("oak size=3").substr(0, 38), "A leaf rule has no 'size'; it has look");
    EXPECT_EQ(error_of("oak curl=3 curl=4"), "The leaf rule gives 'curl' twice.");
    EXPECT_EQ(error_of("curl=big"), "The leaf rule's curl must be a number, not 'big'.");
    EXPECT_EQ(error_of("clustering=2"), "The leaf rule's clustering is out of its range.");
    EXPECT_EQ(
        error_of("form=leaf"),
        "The leaf rule's form must be one of spray, simple, pinnate, palmate, needles, sprig, not 'leaf'.");
    EXPECT_EQ(error_of("look=none"), "There is no picture of 'none' for the leaf rule's look.");
    EXPECT_EQ(make_leaf_kind("sprig=[+45&60F0.5] sprig_dialect=paper", {}).rules.sprig->wood.size(), 2u);
    EXPECT_EQ(plain_leaf_rule("sprig_dialect=paper sprig=F1"), "sprig=F1 sprig_dialect=paper");
    EXPECT_NE(error_of("sprig=[+45&60F0.5]").find("dialect paper"), std::string::npos);
    EXPECT_NE(error_of("sprig=F sprig_dialect=latin").find("latin"), std::string::npos);
    EXPECT_NE(error_of("sprig_dialect=paper").find("has none"), std::string::npos);
    EXPECT_EQ(error_of("sprig=+"), "This string draws no twig: it has no F.");
}

TEST(LeafKinds, ARuleIsOfAPresetOrOfTheTreesOwn) {
    LeafRules own = leaf_preset("maple");
    own.leaf_size = 0.7;
    EXPECT_EQ(make_leaf_kind("oak", own).rules.leaf_size, leaf_preset("oak").leaf_size);
    EXPECT_EQ(make_leaf_kind("oak", own).look, "oak");
    EXPECT_EQ(make_leaf_kind("droop=60", own).rules.leaf_size, 0.7);
    EXPECT_EQ(make_leaf_kind("droop=60", own).rules.droop, 60.0);
    EXPECT_EQ(make_leaf_kind("droop=60", own).look, "");
    EXPECT_EQ(make_leaf_kind("look=birch", own).look, "birch");
    EXPECT_FALSE(make_leaf_kind("none", own).rules.enabled);
    // From node to node, however many leaves stand at one.
    EXPECT_DOUBLE_EQ(make_leaf_kind("internode=0.2", own).rules.internode, 0.1);
    EXPECT_DOUBLE_EQ(make_leaf_kind("arrangement=spiral", own).rules.internode, 2.0 * own.internode);
    // What the scan saw is the tree's affair.
    own.follow_density = 0.25;
    EXPECT_EQ(make_leaf_kind("oak", own).rules.follow_density, 0.25);
    EXPECT_EQ(make_leaf_kind("oak follow_density=1", own).rules.follow_density, 1.0);
    EXPECT_EQ(make_leaf_kind("palm", leaf_preset("oak")).rules.follow_density, 0.0);
    EXPECT_EQ(make_leaf_kind("oak sprig=F[+FL]F", own).rules.form, LeafForm::kSprig);
}

// However the wood is painted, rules that say the same as the tree's own part its leaves among them.
TEST(LeafKinds, PartTheLeavesOfTheTree) {
    const LeafRules own;
    int mixed = 0;
    const std::vector<std::string> same = {"droop=20", "curl=18", "angle=55 droop=20", "default"};
    for (uint64_t seed = 1; seed <= cases(60); seed++) {
        Random random(seed);
        Tree tree = random_tree(seed, 20 + static_cast<int>(random.below(500)));
        const Foliage foliage = seed % 3 == 0 ? random_foliage(tree, random) : Foliage();
        LeafRules rules = own;
        // Beyond a limit fewer and larger ones would stand for all, of each kind by itself.
        rules.maximum_leaves = 2000000;
        if (!foliage.empty()) rules.leaf_size = 0.6;
        if (seed % 6 == 0) rules.follow_density = 0.5;
        const std::vector<std::string> whole = sorted(place_leaves(tree, rules, seed, foliage));
        paint(tree, same, random);
        ASSERT_EQ(tree.check(), std::nullopt);
        std::vector<LeafPlacement> all;
        size_t kinds = 0;
        for (const std::vector<LeafPlacement>& kind :
             place_foliage(tree, leaf_kinds(tree, rules), seed, foliage)) {
            all.insert(all.end(), kind.begin(), kind.end());
            kinds += !kind.empty();
        }
        ASSERT_EQ(sorted(all), whole) << "seed " << seed;
        mixed += kinds > 1 ? 1 : 0;
    }
    EXPECT_GT(mixed, cases(60) / 2);
}

// A kind's leaves are those that it would have there if the whole tree were of it, in another crown's light.
TEST(LeafKinds, EachHasItsOwnLeavesOnItsWood) {
    const std::vector<std::string> rules = {"oak", "pine", "maple leaf_size=0.2", "droop=60", "none"};
    for (uint64_t seed = 1; seed <= cases(30); seed++) {
        Random random(seed);
        Tree tree = random_tree(seed, 300);
        paint(tree, rules, random);
        const std::vector<LeafKind> kinds = leaf_kinds(tree, LeafRules());
        const auto placed = place_foliage(tree, kinds, seed);
        ASSERT_EQ(placed.size(), kinds.size());
        for (size_t k = 0; k < kinds.size(); k++) {
            const std::vector<std::string> some = sorted(unlit(placed[k]));
            const std::vector<std::string> all = sorted(unlit(place_leaves(tree, kinds[k].rules, seed)));
            ASSERT_TRUE(std::includes(all.begin(), all.end(), some.begin(), some.end()))
                << "seed " << seed << ", " << kinds[k].text;
            if (kinds[k].text == "none") {
                ASSERT_TRUE(some.empty());
            }
        }
    }
}

TEST(LeafKinds, NoTwigsGrowForLeavesThatAreNone) {
    int fewer = 0;
    for (uint64_t seed = 1; seed <= cases(20); seed++) {
        Random random(seed);
        Tree tree = random_tree(seed, 250);
        const Foliage foliage = random_foliage(tree, random);
        const Tree whole = leafy_tree(tree, LeafRules(), foliage);
        paint(tree, {"none", "oak"}, random);
        const Tree leafy = leafy_tree(tree, leaf_kinds(tree, LeafRules()), foliage);
        ASSERT_EQ(leafy.check(), std::nullopt);
        fewer += leafy.size() < whole.size();
        for (NodeId id = tree.id_end(); id < leafy.id_end(); id++)
            if (leafy.contains(id)) {
                const uint8_t number = leafy.node(id).leaf_rule;
                ASSERT_TRUE(number == 0 || leafy.leaf_rules()[number - 1u] == "oak");
                ASSERT_EQ(leafy.node(id).position, whole.node(id).position);
            }
    }
    EXPECT_GT(fewer, 0);
}

TEST(LeafKinds, AllAreInEveryLevelAndInTheBudget) {
    Tree tree = random_tree(5, 1500);
    const BranchList list = list_branches(tree);
    for (const Branch& branch : list.branches) {
        const std::vector<NodeId> side_branch = tree.depth_first(list.nodes[branch.begin]);
        constexpr const char* kRules[] = {"pine", "maple leaf_size=0.2", "birch form=simple leaf_size=0.05"};
        const size_t next = tree.leaf_rules().size();
        if (branch.order != 1 || side_branch.size() < 50 || next == std::size(kRules)) continue;
        const uint8_t number = tree.name_leaf_rule(kRules[next]);
        for (const NodeId id : side_branch)
            tree.set_leaf_rule(id, number);
    }
    ASSERT_EQ(tree.leaf_rules().size(), 3U);
    const LevelBuilder builder(tree, LeafRules(), 1);
    size_t before = SIZE_MAX;
    for (int level = 0; level < 4; level++) {
        const TreeLevel made = builder.build(level);
        ASSERT_EQ(made.foliage.size(), tree.leaf_rules().size() + 1);
        size_t triangles = made.bark.triangle_count();
        for (const LevelLeaves& kind : made.foliage) {
            EXPECT_FALSE(kind.leaves.empty()) << level;
            triangles += kind.leaves.size() * kind.card.triangle_count();
        }
        EXPECT_EQ(made.triangle_count(), triangles);
        EXPECT_LT(triangles, before);
        before = triangles;
    }
    const TreeLevel small = builder.build(0, before);
    EXPECT_LE(small.triangle_count(), before);
    EXPECT_TRUE(small.warning.empty());
}

TEST(LeafKinds, ThereAreNoMoreThanATreeCanName) {
    Tree tree = random_tree(1, 50);
    for (size_t i = 0; i < kMostLeafRules; i++)
        EXPECT_EQ(tree.name_leaf_rule("droop=" + std::to_string(i)), i + 1);
    EXPECT_EQ(tree.name_leaf_rule("droop=7"), 8);
    EXPECT_THROW(tree.name_leaf_rule("one more"), Error);
    EXPECT_THROW(tree.set_leaf_rule(tree.root(), 251), Error);
    tree.set_leaf_rule(tree.root(), 9);
    tree.drop_unused_leaf_rules();
    EXPECT_EQ(tree.leaf_rules(), std::vector<std::string>{"droop=8"});
    EXPECT_EQ(tree.node(tree.root()).leaf_rule, 1);
    EXPECT_THROW(place_foliage(tree, {LeafKind{}}, 1), Error);
}

}  // namespace
}  // namespace treerec
