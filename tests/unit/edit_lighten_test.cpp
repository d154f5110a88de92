#include "edit/lighten/lighten.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "error.h"
#include "fidelity/silhouette.h"
#include "geometry/segment.h"
#include "mesh/branch_tubes.h"
#include "random_tree.h"
#include "synth/grow.h"

namespace treerec {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

void expect_same(const Tree& a, const Tree& b) {
    ASSERT_EQ(a.depth_first(), b.depth_first());
    for (NodeId id : a.depth_first()) {
        EXPECT_EQ(a.node(id).parent, b.node(id).parent);
        EXPECT_EQ(a.node(id).position, b.node(id).position);
        EXPECT_EQ(a.node(id).radius, b.node(id).radius);
        EXPECT_EQ(a.node(id).flags, b.node(id).flags);
    }
}

// --- the paper's algorithms once more, as slowly as they are written
// ------------------------------------------

bool turns_less(const Tree& tree, NodeId id, double angle) {
    const Node& node = tree.node(id);
    const DVec3 u = node.position - tree.node(node.parent).position;
    const DVec3 v = tree.node(node.first_child).position - node.position;
    const double lengths = std::sqrt(glm::dot(u, u) * glm::dot(v, v));
    const double cosine = lengths > 0.0 ? std::min(glm::dot(u, v) / lengths, 1.0) : 1.0;
    return cosine > std::cos(angle * std::numbers::pi / 180.0);
}

bool slow_turns(Tree& tree, double angle) {
    bool any = false;
    for (bool again = angle > 0.0; again;) {
        again = false;
        for (NodeId id : tree.depth_first()) {
            if (id == tree.root() || tree.node(id).child_count != 1 || !turns_less(tree, id, angle)) continue;
            if (tree.node(id).is_trunk()) tree.set_flag(tree.node(id).first_child, kTrunkFlag, true);
            tree.dissolve(id);
            any = again = true;
            break;
        }
    }
    return any;
}

bool slow_tips(Tree& tree, double distance) {
    bool any = false;
    for (NodeId fork : tree.depth_first()) {
        if (!tree.contains(fork)) continue;
        for (bool again = true; again;) {
            again = false;
            std::vector<NodeId> tips;
            for (NodeId child : tree.children(fork))
                if (tree.node(child).child_count == 0) tips.push_back(child);
            for (size_t i = 0; i < tips.size() && !again; i++)
                for (size_t j = i + 1; j < tips.size() && !again; j++) {
                    const Node a = tree.node(tips[i]), b = tree.node(tips[j]);
                    if (!(glm::distance(a.position, b.position) < distance)) continue;
                    tree.set_position(tips[i], 0.5 * (a.position + b.position));
                    tree.set_radius(tips[i], std::max(a.radius, b.radius));
                    tree.set_flag(tips[i], kTrunkFlag, a.is_trunk() || b.is_trunk());
                    tree.set_flag(tips[i], kMeasuredRadiusFlag, a.is_measured() && b.is_measured());
                    tree.set_flag(tips[i], kGuessFlag, a.is_guess() && b.is_guess());
                    tree.remove_subtree(tips[j]);
                    any = again = true;
                }
        }
    }
    return any;
}

TEST(MergeBranches, FindsWhatThePaperDefines) {
    Random random(3);
    for (uint64_t seed = 1; seed <= 300; seed++) {
        const int nodes = 1 + static_cast<int>(random.below(120));
        const Tree tree = seed % 3 ? test::random_tree(seed, nodes) : test::wild_tree(seed, nodes);
        const double angle = seed % 7 == 0 ? 0.0 : random.uniform(1.0, 180.0);
        const double distance = seed % 5 == 0 ? 0.0 : std::pow(10.0, random.uniform(-2.0, 1.0));
        Tree fast = tree, slow = tree;
        const Lightened result = merge_branches(fast, angle, distance);
        for (bool again = true; again;) {
            again = slow_turns(slow, angle);
            again = slow_tips(slow, distance) || again;
        }
        ASSERT_EQ(fast.check().value_or("sound"), "sound");
        expect_same(fast, slow);
        EXPECT_EQ(result.after, fast.size());
        EXPECT_EQ(result.before, result.after + result.removed.size());
        if (::testing::Test::HasFailure()) FAIL() << "seed " << seed;
    }
}

TEST(MergeBranches, ManyLeavesOnOneForkAreMergedInTheSameOrder) {
    for (uint64_t seed = 1; seed <= 6; seed++) {
        Random random(seed);
        Tree tree;
        tree.add_root(DVec3(0.0), 0.1);
        for (int i = 0; i < 150; i++)
            tree.add_child(0, random.uniform(0.5, 1.0) * random.direction(), 0.01);
        Tree fast = tree, slow = tree;
        merge_tips(fast, 0.07 * static_cast<double>(seed));
        slow_tips(slow, 0.07 * static_cast<double>(seed));
        EXPECT_LT(fast.size(), tree.size());
        expect_same(fast, slow);
    }
}

TEST(MergeBranches, DoesWhatFigure62Shows) {
    // A - B - C with the leaves D and E, nearly straight.
    Tree tree;
    const NodeId a = tree.add_root({0, 0, 0}, 0.10, kTrunkFlag);
    const NodeId b = tree.add_child(a, {0.02, 1, 0}, 0.08, kTrunkFlag);
    const NodeId c = tree.add_child(b, {0, 2, 0}, 0.06, kTrunkFlag);
    const NodeId d = tree.add_child(c, {-0.1, 3, 0}, 0.02);
    const NodeId e = tree.add_child(c, {0.1, 3, 0}, 0.03, kTrunkFlag);
    Tree turns = tree;
    EXPECT_EQ(merge_turns(turns, 20.0).removed, std::vector<NodeId>{b});
    Tree tips = tree;
    EXPECT_EQ(merge_tips(tips, 0.3).removed, std::vector<NodeId>{e});
    EXPECT_EQ(tips.node(d).position, DVec3(0, 3, 0));
    EXPECT_EQ(tips.node(d).radius, 0.03);
    EXPECT_TRUE(tips.node(d).is_trunk());
    const Lightened both = merge_branches(tree, 20.0, 0.3);
    EXPECT_EQ(tree.depth_first(), (std::vector<NodeId>{a, d}));
    EXPECT_EQ(both.removed, (std::vector<NodeId>{b, c, e}));
    EXPECT_EQ(both.changed, std::vector<NodeId>{d});
    EXPECT_NEAR(both.tip_distance, 0.1, 1e-12);
    EXPECT_NEAR(both.deviation, 0.02 + (0.08 - (0.1 - 0.08 / 3)), 0.01);
    EXPECT_EQ(tree.check().value_or("sound"), "sound");
}

// --- lighten()
// --------------------------------------------------------------------------------------------------

size_t trunk_tips(const Tree& tree) {
    size_t count = 0;
    for (NodeId id : tree.nodes_of_kind(NodeKind::kLeaf))
        count += tree.node(id).is_trunk();
    return count;
}

// Whether `above` stands over `below` in the tree.
bool stands_over(const Tree& tree, NodeId above, NodeId below) {
    while (above != kNoNode && above != below)
        above = tree.node(above).parent;
    return above == below;
}

TEST(Lighten, KeepsItsBoundsOnAnyTree) {
    Random random(5);
    for (uint64_t seed = 1; seed <= 300; seed++) {
        const int nodes = 1 + static_cast<int>(random.below(300));
        const Tree tree = seed % 3 ? test::random_tree(seed, nodes) : test::wild_tree(seed, nodes);
        const LightenOptions options{random.uniform(0.0, 180.0), std::pow(10.0, random.uniform(-2.0, 0.5)),
                                     std::pow(10.0, random.uniform(-3.0, 0.0))};
        Tree light = tree;
        const Lightened result = lighten(light, options);
        ASSERT_EQ(light.check().value_or("sound"), "sound");
        EXPECT_EQ(result.before, tree.size());
        EXPECT_EQ(result.after, light.size());
        EXPECT_EQ(result.before - result.after, result.removed.size());
        EXPECT_LE(result.deviation, options.deviation);
        EXPECT_LE(result.tip_distance, options.distance);
        EXPECT_EQ(light.root(), tree.root());
        EXPECT_EQ(trunk_tips(light), trunk_tips(tree));
        for (NodeId id : light.depth_first()) {
            // What stays stays as it was, over what it stood over.
            EXPECT_EQ(light.node(id).position, tree.node(id).position);
            EXPECT_EQ(light.node(id).radius, tree.node(id).radius);
            EXPECT_EQ(light.node(id).is_trunk(), tree.node(id).is_trunk());
            const NodeId parent = light.node(id).parent;
            if (parent == kNoNode) continue;
            EXPECT_TRUE(stands_over(tree, id, parent));
            for (NodeId at = tree.node(id).parent; at != parent; at = tree.node(at).parent)
                EXPECT_LE(distance_to_segment(tree.node(at).position, light.node(parent).position,
                                              light.node(id).position),
                          options.deviation);
        }
        for (NodeId tip : tree.nodes_of_kind(NodeKind::kLeaf)) {
            double nearest = kInfinity;
            for (NodeId id : light.depth_first()) {
                const NodeId parent = light.node(id).parent;
                nearest =
                    std::min(nearest, distance_to_segment(tree.node(tip).position, light.node(id).position,
                                                          light.node(parent < 0 ? id : parent).position));
            }
            EXPECT_LE(nearest, options.distance + options.deviation);
        }
        if (::testing::Test::HasFailure()) FAIL() << "seed " << seed;
    }
}

TEST(Lighten, ReachesTheNumberOfNodesThatItIsGiven) {
    for (uint64_t seed = 1; seed <= 60; seed++) {
        const Tree tree =
            seed % 3 ? test::random_tree(seed, 400) : test::wild_tree(seed, 200 + static_cast<int>(seed));
        size_t least = 2;  // the root and the trunk's tips with the forks among them
        if (trunk_tips(tree) > 1) least = 2 * trunk_tips(tree) + 1;
        for (size_t nodes : {tree.size() + 5, tree.size() - 1, tree.size() / 2, tree.size() / 7, least}) {
            Tree light = tree;
            LightenOptions options;
            options.nodes = nodes;
            const Lightened result = lighten(light, options);
            EXPECT_EQ(light.check().value_or("sound"), "sound");
            EXPECT_LE(light.size(), std::max(nodes, least));
            if (nodes > least) {
                EXPECT_EQ(light.size(), std::min(nodes, tree.size()));
            }
            EXPECT_EQ(light.root(), tree.root());
            EXPECT_EQ(trunk_tips(light), trunk_tips(tree));
            EXPECT_EQ(result.changed.size(), 0u);
        }
    }
}

TEST(Lighten, ALevelIsPartOfTheNextFinerOne) {
    const Tree tree = grow_tree({Habit::kBroadleaf, 8.0, 3});
    std::vector<NodeId> before = tree.depth_first();
    for (size_t part : {2, 4, 8, 16}) {
        Tree light = tree;
        LightenOptions options;
        options.nodes = tree.size() / part;
        lighten(light, options);
        std::vector<NodeId> left = light.depth_first();
        std::sort(left.begin(), left.end());
        std::sort(before.begin(), before.end());
        EXPECT_TRUE(std::includes(before.begin(), before.end(), left.begin(), left.end()));
        before = left;
    }
}

// What grows from a node alone: the rest of the tree stays as it is, node by node.
TEST(Lighten, ABranchAloneBecomesLighter) {
    for (uint64_t seed = 1; seed <= 60; seed++) {
        const Tree tree = seed % 2 ? test::random_tree(seed, 300) : test::wild_tree(seed, 300);
        const std::vector<NodeId> order = tree.depth_first();
        const NodeId below = order[seed * 7 % order.size()];
        std::vector<NodeId> branch = tree.depth_first(below);
        std::sort(branch.begin(), branch.end());
        for (bool merged : {false, true}) {
            Tree light = tree;
            LightenOptions options;
            options.below = below;
            if (seed % 3 == 0) options.nodes = std::max<size_t>(2, branch.size() / 3);
            const Lightened result =
                merged ? merge_branches(light, 40.0, 0.3, nullptr, below) : lighten(light, options);
            EXPECT_EQ(light.check().value_or("sound"), "sound");
            EXPECT_TRUE(light.contains(below));
            EXPECT_TRUE(
                std::includes(branch.begin(), branch.end(), result.removed.begin(), result.removed.end()));
            for (NodeId id : order) {
                if (id != below && std::binary_search(branch.begin(), branch.end(), id)) continue;
                ASSERT_TRUE(light.contains(id));
                EXPECT_EQ(light.node(id).parent, tree.node(id).parent);
                EXPECT_EQ(light.node(id).position, tree.node(id).position);
                EXPECT_EQ(light.node(id).radius, tree.node(id).radius);
            }
            Tree whole = tree, from_root = tree;
            options.below = kNoNode;
            merged ? merge_branches(whole, 40.0, 0.3) : lighten(whole, options);
            options.below = tree.root();
            merged ? merge_branches(from_root, 40.0, 0.3, nullptr, tree.root()) : lighten(from_root, options);
            expect_same(whole, from_root);
        }
    }
}

TEST(Lighten, ABranchOfItsOwnReachesItsOwnNumberOfNodes) {
    const Tree tree = grow_tree({Habit::kBroadleaf, 8.0, 3});
    const NodeId below = tree.node(tree.root()).first_child;
    const size_t there = tree.depth_first(below).size();
    Tree light = tree;
    LightenOptions options;
    options.below = below;
    options.nodes = there / 4;
    lighten(light, options);
    EXPECT_EQ(light.depth_first(below).size(), there / 4);
}

TEST(Lighten, NoTwigOfATrunkSwallowsIt) {
    // A thin trunk's tip beside a stout leaf.
    Tree tree;
    tree.add_root({0, 0, 0}, 0.1, kTrunkFlag);
    const NodeId tip = tree.add_child(0, {0, 1, 0}, 0.01, kTrunkFlag);
    const NodeId stout = tree.add_child(0, {0.01, 1, 0}, 0.05);
    lighten(tree, {30.0, 0.1, 0.1});
    EXPECT_TRUE(tree.contains(tip));
    EXPECT_FALSE(tree.contains(stout));
}

TEST(Lighten, AWholeThatIsMostlyAGuessIsOne) {
    Tree tree;
    tree.add_root({0, 0, 0}, 0.1);
    const NodeId middle = tree.add_child(0, {0, 2, 0}, 0.1, kGuessFlag);
    const NodeId tip = tree.add_child(middle, {0, 3, 0}, 0.1);
    Tree other = tree;
    EXPECT_EQ(lighten(tree, {}).changed, std::vector<NodeId>{tip});
    EXPECT_TRUE(tree.node(tip).is_guess());
    other.set_position(middle, {0, 0.5, 0});
    EXPECT_TRUE(lighten(other, {}).changed.empty());
    EXPECT_FALSE(other.node(tip).is_guess());
}

TEST(Lighten, IsSeenLessThanThePapersMergingAtTheSameSize) {
    for (Habit habit : {Habit::kBroadleaf, Habit::kBirch, Habit::kForked}) {
        const Tree tree = grow_tree({habit, 9.0, 2});
        const Mesh mesh = build_branch_tubes(tree);
        Tree paper = tree;
        merge_branches(paper, 30.0, 0.3);
        Tree ours = tree;
        LightenOptions options;
        options.nodes = paper.size();
        lighten(ours, options);
        ASSERT_EQ(ours.size(), paper.size());
        const auto change = [&](const Tree& light) {
            return compare_silhouettes(mesh, build_branch_tubes(light), 512).all().share_of_silhouette();
        };
        EXPECT_LT(change(ours), change(paper)) << habit_name(habit);
    }
}

TEST(Lighten, LargeTreesOfEveryShapeEnd) {
    constexpr int kMany = 60000;
    Tree straight, star, comb;
    straight.add_root(DVec3(0.0), 0.1);
    star.add_root(DVec3(0.0), 0.1);
    comb.add_root(DVec3(0.0), 0.1);
    NodeId spine = 0;
    for (int i = 1; i < kMany; i++) {
        straight.add_child(i - 1, {0.0, 0.01 * i, 0.0}, 0.05);
        star.add_child(0, {std::cos(1e-3 * i), 1e-5 * i, std::sin(1e-3 * i)}, 0.01);
        if (i % 2)
            spine = comb.add_child(spine, {0.0, 0.01 * i, 0.0}, 0.05);
        else
            comb.add_child(spine, {0.005, 0.01 * i, 0.0}, 0.02);
    }
    for (const Tree* tree : {&straight, &star, &comb}) {
        Tree light = *tree;
        lighten(light, {180.0, 0.1, 1.0});
        EXPECT_LT(light.size(), tree->size() / 2);
        light = *tree;
        LightenOptions options;
        options.nodes = 10;
        lighten(light, options);
        EXPECT_EQ(light.size(), 10u);
        light = *tree;
        merge_branches(light, 90.0, 0.1);
        // No tooth of the comb has a leaf beside it.
        if (tree != &comb) {
            EXPECT_LT(light.size(), tree->size() / 2);
        }
        EXPECT_EQ(light.check().value_or("sound"), "sound");
    }
}

TEST(Lighten, WrongOptionsAndCancellingChangeNothing) {
    struct Cancel : Progress {
        bool cancelled() const override { return true; }
    };
    const Tree tree = test::random_tree(1, 3000);
    Tree light = tree;
    EXPECT_THROW(lighten(light, {-1.0}), Error);
    EXPECT_THROW(lighten(light, {181.0}), Error);
    EXPECT_THROW(lighten(light, {10.0, -0.1}), Error);
    EXPECT_THROW(lighten(light, {10.0, 0.1, std::nan("")}), Error);
    EXPECT_THROW(lighten(light, {10.0, 0.1, 0.1, 1}), Error);
    LightenOptions nowhere;
    nowhere.below = 1000000;
    EXPECT_THROW(lighten(light, nowhere), Error);
    EXPECT_THROW(merge_branches(light, 10.0, 1.0, nullptr, 1000000), Error);
    EXPECT_THROW(merge_turns(light, std::nan("")), Error);
    EXPECT_THROW(merge_tips(light, kInfinity), Error);
    const Cancel cancel;
    EXPECT_THROW(lighten(light, {60.0, 0.1, 0.1}, &cancel), Cancelled);
    EXPECT_THROW(merge_branches(light, 60.0, 0.1, &cancel), Cancelled);
    expect_same(light, tree);
    Tree empty;
    EXPECT_EQ(lighten(empty, {}).after, 0u);
    EXPECT_EQ(merge_branches(empty, 10.0, 1.0).after, 0u);
}

TEST(Tree, DissolvingManyNodesAtOnceIsDissolvingEach) {
    for (uint64_t seed = 1; seed <= 100; seed++) {
        const Tree tree = test::random_tree(seed, 150);
        Random random(seed);
        std::vector<NodeId> goes;
        for (NodeId id : tree.depth_first())
            if (id != tree.root() && random.below(3) == 0) goes.push_back(id);
        Tree each = tree, all = tree;
        for (NodeId id : goes)
            each.dissolve(id);
        std::reverse(goes.begin(), goes.end());
        all.dissolve_all(goes);
        EXPECT_EQ(all.check().value_or("sound"), "sound");
        expect_same(each, all);
        EXPECT_EQ(all.id_end(), tree.id_end());
        goes.push_back(tree.root());
        Tree same = tree;
        EXPECT_THROW(same.dissolve_all(goes), Error);
        EXPECT_THROW(same.dissolve_all({1, tree.id_end()}), Error);
        expect_same(same, tree);
    }
}

}  // namespace
}  // namespace treerec
