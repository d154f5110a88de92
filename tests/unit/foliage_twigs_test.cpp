#include "foliage/foliage_twigs.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "bark_surface.h"
#include "foliage/leaves.h"
#include "foliage/own_twigs.h"
#include "geometry/parallel.h"
#include "geometry/random.h"
#include "random_tree.h"

namespace treerec {
namespace {

// Leaf points around some of the tree's tips.
Foliage foliage_on(const Tree& tree, uint64_t seed) {
    Random random(seed, 9);
    std::vector<Vec3> points;
    for (const NodeId tip : tree.nodes_of_kind(NodeKind::kLeaf)) {
        if (random.uniform() < 0.4) continue;
        for (int i = 0; i < 400; i++)
            points.emplace_back(tree.node(tip).position +
                                0.7 * std::cbrt(random.uniform()) * random.direction());
    }
    return gather_foliage(points, {});
}

Tree slender_tree(uint64_t seed) {
    Tree tree = test::random_tree(seed, 60 + static_cast<int>(seed % 40));
    for (const NodeId id : tree.depth_first())
        tree.set_radius(id, std::min(tree.node(id).radius, 0.02));
    return tree;
}

double distance_to_wood(const Tree& tree, const DVec3& p) {
    double best = 1e9;
    for (const NodeId id : tree.depth_first()) {
        const Node& node = tree.node(id);
        if (node.parent == kNoNode) continue;
        const DVec3 a = tree.node(node.parent).position, along = node.position - a;
        const double square = glm::dot(along, along);
        const double t = square > 0.0 ? std::clamp(glm::dot(p - a, along) / square, 0.0, 1.0) : 0.0;
        best = std::min(best, glm::distance(p, a + along * t));
    }
    return best;
}

TEST(FoliageTwigs, ReachAllFoliageThatBelongsToTheTree) {
    size_t grown_ones = 0;
    for (uint64_t seed = 0; seed < 25; seed++) {
        const Tree tree = slender_tree(seed);
        const Foliage foliage = foliage_on(tree, seed);
        const Tree leafy = leafy_tree(tree, LeafRules(), foliage);
        ASSERT_EQ(leafy.check(), std::nullopt);
        // What was there stays as it was.
        ASSERT_GE(leafy.size(), tree.size());
        for (const NodeId id : tree.depth_first()) {
            ASSERT_EQ(leafy.node(id).position, tree.node(id).position);
            ASSERT_EQ(leafy.node(id).radius, tree.node(id).radius);
            ASSERT_EQ(leafy.node(id).parent, tree.node(id).parent);
        }
        for (NodeId id = tree.id_end(); id < leafy.id_end(); id++) {
            ASSERT_TRUE(leafy.node(id).is_guess());
            ASSERT_LE(leafy.node(id).radius, 0.0061);
            ASSERT_LE(leafy.node(id).radius, leafy.node(leafy.node(id).parent).radius);
            grown_ones++;
        }
        // A coarse cell's foliage lies within its diagonal of the twig's end.
        const double most = std::sqrt(3.0) * foliage_twig_spacing(foliage);
        for (const FoliageCell& cell : foliage.cells)
            ASSERT_LT(distance_to_wood(leafy, foliage.centre(cell)), most) << "seed " << seed;
    }
    EXPECT_GT(grown_ones, 200u);
}

TEST(FoliageTwigs, LeavesThatFollowTheScanStandOnTheirBark) {
    for (uint64_t seed = 0; seed < 25; seed++) {
        const Tree tree = slender_tree(seed);
        const Foliage foliage = foliage_on(tree, seed);
        LeafRules rules;
        rules.follow_density = seed % 2 ? 1.0 : 0.5;
        const test::BarkSurface bark(leafy_tree(tree, rules, foliage));
        const std::vector<LeafPlacement> leaves = place_leaves(tree, rules, seed, foliage);
        ASSERT_GT(leaves.size(), 50u);
        for (const LeafPlacement& leaf : leaves)
            ASSERT_LT(bark.distance(DVec3(leaf.position)), 0.015) << "seed " << seed;
    }
}

TEST(FoliageTwigs, NoneGrowWithoutFoliageThatIsFollowed) {
    const Tree tree = slender_tree(3);
    const Foliage foliage = foliage_on(tree, 3);
    LeafRules rules;
    EXPECT_GT(leafy_tree(tree, rules, foliage).size(), tree.size());
    EXPECT_EQ(leafy_tree(tree, rules, {}).size(), tree.size());
    rules.follow_density = 0.0;
    EXPECT_EQ(leafy_tree(tree, rules, foliage).size(), tree.size());
    rules = LeafRules();
    rules.enabled = false;
    EXPECT_EQ(leafy_tree(tree, rules, foliage).size(), tree.size());
    EXPECT_TRUE(leafy_tree(Tree(), LeafRules(), foliage).empty());
    // Far away foliage is another tree's.
    std::vector<Vec3> far;
    for (int i = 0; i < 500; i++)
        far.emplace_back(30.0f + 0.001f * static_cast<float>(i), 5.0f, 0.0f);
    EXPECT_EQ(leafy_tree(tree, LeafRules(), gather_foliage(far, {})).size(), tree.size());
}

// A stem with thin side branches that leave it at one angle, and leaves beyond their ends.
struct Alike {
    Tree tree;
    Foliage foliage;
};

Alike alike(double angle, double tip) {
    Alike made;
    NodeId at = made.tree.add_root(DVec3(0.0), 0.02, kTrunkFlag);
    std::vector<Vec3> points;
    Random random(5);
    for (int i = 1; i <= 30; i++) {
        at = made.tree.add_child(at, {0.0, 0.2 * i, 0.0}, 0.02, kTrunkFlag);
        const double around = 2.4 * i;
        const DVec3 way(std::sin(angle) * std::cos(around), std::cos(angle),
                        std::sin(angle) * std::sin(around));
        const DVec3 end = made.tree.node(at).position + 0.8 * way;
        made.tree.add_child(at, end, tip, 0);
        for (int k = 0; k < 200; k++)
            points.emplace_back(end + 0.5 * way + 0.35 * std::cbrt(random.uniform()) * random.direction());
    }
    made.foliage = gather_foliage(points, {});
    return made;
}

// Twigs that the leaves hide are as thin as those that were seen.
TEST(FoliageTwigs, AreAsThoseThatWereSeen) {
    const auto mean_radius = [](double tip) {
        const Alike made = alike(0.8, tip);
        const Tree leafy = leafy_tree(made.tree, LeafRules(), made.foliage);
        double sum = 0.0;
        int count = 0;
        for (NodeId id = made.tree.id_end(); id < leafy.id_end(); id++, count++)
            sum += leafy.node(id).radius;
        return sum / std::max(count, 1);
    };
    EXPECT_LT(mean_radius(0.001), 0.6 * mean_radius(0.004));
    EXPECT_GT(mean_radius(0.001), 0.0005);
    for (const double angle : {0.5, 0.8, 1.1})
        EXPECT_NEAR(measure_twigs(alike(angle, 0.002).tree, 0.03, 1.0).agreement, std::cos(angle), 1e-3);
    EXPECT_NEAR(measure_twigs(alike(0.8, 0.012).tree, 0.03, 1.0).thinning, 0.6, 1e-3);
    // Of what was guessed nothing is learnt, nor of a tree with hardly any twigs.
    EXPECT_EQ(measure_twigs(slender_tree(3), 0.0, 0.5).thinnest, 0.5 * OwnTwigs().thinnest);
}

TEST(FoliageTwigs, SameTwigsWhateverTheThreads) {
    const Tree tree = slender_tree(5);
    const Foliage foliage = foliage_on(tree, 5);
    set_thread_count(1);
    const Tree one = leafy_tree(tree, LeafRules(), foliage);
    set_thread_count(4);
    const Tree four = leafy_tree(tree, LeafRules(), foliage);
    set_thread_count(0);
    ASSERT_EQ(one.id_end(), four.id_end());
    for (NodeId id = 0; id < one.id_end(); id++) {
        ASSERT_EQ(one.node(id).position, four.node(id).position);
        ASSERT_EQ(one.node(id).parent, four.node(id).parent);
    }
}

}  // namespace
}  // namespace treerec
