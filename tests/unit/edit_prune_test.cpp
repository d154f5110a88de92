// Pruning: what goes, what stays, what is handed over.
#include "edit/prune/prune.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "edit/commands/address.h"
#include "edit/delta.h"
#include "edit/select.h"
#include "random_tree.h"
#include "tree/branches.h"

namespace treerec {
namespace {

using test::random_tree;
using test::wild_tree;

// Stem of `stem` nodes above the root, then twigs of the lengths given, in nodes of `step` metres.
Tree broom(int stem, const std::vector<int>& twigs, double step = 0.1) {
    Tree tree;
    NodeId at = tree.add_root({0, 0, 0}, 0.05);
    for (int i = 1; i <= stem; i++)
        at = tree.add_child(at, {0, i * step, 0}, 0.05);
    const NodeId fork = at;
    for (size_t t = 0; t < twigs.size(); t++) {
        at = fork;
        for (int i = 1; i <= twigs[t]; i++)
            at = tree.add_child(at, {i * step, (stem + 0.3 * static_cast<double>(t)) * step, 0}, 0.004);
    }
    return tree;
}

// The paper's algorithm 3 step by step, with sets of what is to go; "Truncate" keeps the node it is given.
std::set<NodeId> paper_prune(const Tree& tree) {
    std::map<NodeId, int> depths;
    int total = 0;
    for (const NodeId leaf : tree.nodes_of_kind(NodeKind::kLeaf)) {
        NodeId current = leaf;
        int depth = 0;
        while (tree.node(current).parent != kNoNode) {
            depth++;
            current = tree.node(current).parent;
            if (tree.node(current).child_count < 2) continue;
            depths[leaf] = depth;
            total += depth;
            break;
        }
    }
    std::set<NodeId> gone;
    if (depths.empty()) return gone;
    const int mean = total / static_cast<int>(depths.size());
    for (const auto& [leaf, depth] : depths) {
        NodeId current = leaf;
        for (int i = 0; i < depth - mean; i++) {
            gone.insert(current);
            current = tree.node(current).parent;
        }
    }
    return gone;
}

TEST(EditPrune, IsAlgorithm3) {
    for (uint64_t seed = 1; seed <= 100; seed++) {
        const Tree before = seed % 3 ? random_tree(seed, 300) : wild_tree(seed, 300);
        Tree tree = before;
        PruneOptions options;
        options.spare_leader = false;
        const Removed removed = prune_twigs(tree, options);
        const std::set<NodeId> expected = paper_prune(before);
        const std::vector<NodeId> ids = removed.ids();
        EXPECT_EQ(std::set<NodeId>(ids.begin(), ids.end()), expected) << "seed " << seed;
        EXPECT_EQ(ids.size(), expected.size());
        EXPECT_EQ(tree.size() + expected.size(), before.size());
        EXPECT_EQ(tree.check(), std::nullopt);
    }
}

TEST(EditPrune, ObeysItsLimits) {
    // Mean of 2, 3 and 10 nodes: 5.
    const Tree before = broom(3, {2, 3, 10});
    const auto left = [&](const PruneOptions& options) {
        Tree tree = before;
        prune_twigs(tree, options);
        return static_cast<int>(tree.size()) - 4 - 2 - 3;
    };
    PruneOptions options;
    EXPECT_EQ(left(options), 5);
    options.factor = 1.5;
    EXPECT_EQ(left(options), 7);
    options.factor = 2.0;
    EXPECT_EQ(left(options), 10);
    options.factor = 1.0;
    options.minimum_length = 0.65;
    EXPECT_EQ(left(options), 7);
    options.minimum_length = 0.0;
    options.minimum_radius = 0.004;
    EXPECT_EQ(left(options), 10);
    options.minimum_radius = 0.0041;
    EXPECT_EQ(left(options), 5);
    options = {};
    options.in_metres = true;
    options.factor = 0.5;
    Tree tree = before;
    prune_twigs(tree, options);
    // The mean is about 0.5 m, so that twigs end within 0.25 m of their fork.
    EXPECT_EQ(tree.size(), 4U + 2U + 2U + 2U);
    options = {};
    Tree marked = before;
    for (NodeId at = marked.depth_first().back(); at != kNoNode; at = marked.node(at).parent)
        marked.set_flag(at, kTrunkFlag, true);
    EXPECT_TRUE(prune_twigs(marked).nodes.empty()) << "the leader is spared";
    options.spare_leader = false;
    EXPECT_EQ(prune_twigs(marked, options).nodes.size(), 5U);
    options.factor = -1.0;
    EXPECT_THROW(prune_twigs(marked, options), Error);
    Tree pole = broom(5, {});
    EXPECT_TRUE(prune_twigs(pole).nodes.empty()) << "a pole has no twigs";
    Tree equal = broom(2, {4, 4, 4});
    EXPECT_TRUE(prune_twigs(equal).nodes.empty()) << "none is longer than the mean";
}

// What was removed can be put back together: pieces hold every node, where and as thick as it was.
TEST(EditPrune, HandsOverWhatItRemoved) {
    for (uint64_t seed = 1; seed <= 40; seed++) {
        const Tree before = seed % 3 ? random_tree(seed, 200) : wild_tree(seed, 200);
        Tree tree = before;
        Random random(seed);
        const DVec3 place = before.bounds().centre();
        Removed removed;
        try {
            removed = prune_region(tree, Region::side(place, random.direction()), false);
        } catch (const Misfit&) {
            continue;
        }
        const TreeDelta delta = TreeDelta::between(before, tree);
        std::vector<NodeId> ids = removed.ids();
        std::sort(ids.begin(), ids.end());
        EXPECT_EQ(ids, delta.removed());
        EXPECT_TRUE(delta.added().empty());
        size_t nodes = 0;
        for (size_t i = 0; i < removed.pieces.size(); i++) {
            const Tree piece = removed.piece(i, before.frame());
            ASSERT_EQ(piece.check(), std::nullopt);
            const size_t begin = removed.pieces[i].begin;
            const std::vector<NodeId> order = piece.depth_first();
            ASSERT_EQ(order.size(), removed.pieces[i].end - begin + 1);
            const NodeId first = removed.nodes[begin].id;
            EXPECT_EQ(piece.node(order[0]).position, before.node(before.node(first).parent).position);
            for (size_t k = 1; k < order.size(); k++) {
                const Node &given = piece.node(order[k]), &had = before.node(removed.nodes[begin + k - 1].id);
                EXPECT_EQ(given.position, had.position);
                EXPECT_EQ(given.radius, had.radius);
                EXPECT_EQ(given.flags, had.flags);
                EXPECT_EQ(given.child_count, had.child_count);
            }
            nodes += order.size() - 1;
        }
        EXPECT_EQ(nodes, before.size() - tree.size());
    }
}

TEST(EditPrune, RegionsCutWhereTheyBegin) {
    for (uint64_t seed = 1; seed <= 60; seed++) {
        const Tree before = random_tree(seed, 300);
        Random random(seed);
        const Bounds bounds = before.bounds();
        const DVec3 centre =
            bounds.min + bounds.size() * DVec3(random.uniform(), random.uniform(0.3, 1.0), random.uniform());
        Region region;
        if (seed % 3 == 0) region = Region::sphere(centre, random.uniform(0.5, 4.0));
        if (seed % 3 == 1) region = Region::box(centre, centre + random.direction() * 4.0);
        if (seed % 3 == 2) region = Region::side(centre, random.direction());
        Tree tree = before;
        try {
            prune_region(tree, region);
        } catch (const Misfit&) {
            EXPECT_TRUE(region.contains(before.node(before.root()).position));
            continue;
        }
        const TreeDelta delta = TreeDelta::between(before, tree);
        for (const NodeId id : tree.depth_first()) {
            if (before.contains(id)) {
                EXPECT_FALSE(region.contains(tree.node(id).position));
                EXPECT_EQ(tree.node(id).position, before.node(id).position);
                continue;
            }
            // A new end lies on the region's face, and is a tip.
            const DVec3 p = tree.node(id).position;
            const DVec3 out = normalized_or(tree.node(tree.node(id).parent).position - p, DVec3(0.0));
            EXPECT_TRUE(region.contains(p - out * 1e-9)) << "seed " << seed;
            EXPECT_FALSE(region.contains(p + out * 1e-9)) << "seed " << seed;
            EXPECT_EQ(tree.node(id).child_count, 0);
        }
        EXPECT_EQ(tree.check(), std::nullopt);
    }
    Tree tree = broom(3, {2, 3});
    EXPECT_THROW(prune_region(tree, Region::sphere({0, 0, 0}, 1.0)), Misfit);
    EXPECT_THROW(Region::sphere({0, 0, 0}, 0.0), Error);
    EXPECT_THROW(Region::side({0, 0, 0}, {0, 0, 0}), Error);
    EXPECT_THROW(Region::box({0, 0, 0}, {0, NAN, 0}), Error);
}

TEST(EditPrune, CutsWithAndWithoutAStub) {
    Tree tree = broom(3, {2, 4});
    NodeId stump = kNoNode;
    Tree clean = tree;
    EXPECT_EQ(cut(clean, 6, 0.0, &stump).nodes.size(), 4U);
    EXPECT_EQ(stump, kNoNode);
    EXPECT_EQ(clean.node(3).child_count, 1);
    Tree stubbed = tree;
    EXPECT_EQ(cut(stubbed, 7, 0.025, &stump).ids(), (std::vector<NodeId>{7, 8, 9}));
    ASSERT_TRUE(stubbed.contains(stump));
    EXPECT_EQ(stubbed.node(stump).parent, 6);
    EXPECT_NEAR(glm::distance(stubbed.node(stump).position, stubbed.node(6).position), 0.025, 1e-12);
    Tree whole = tree;
    EXPECT_EQ(cut(whole, 7, 1.0, &stump).ids(), (std::vector<NodeId>{8, 9}));
    EXPECT_EQ(stump, 7);
    EXPECT_THROW(cut(tree, tree.root()), Misfit);
    EXPECT_THROW(cut(tree, 77), Misfit);
    EXPECT_THROW(cut(tree, 7, -1.0), Error);
}

TEST(EditPrune, BelowByOrderByRadiusAndKeepOnly) {
    for (uint64_t seed = 1; seed <= 40; seed++) {
        const Tree before = seed % 3 ? random_tree(seed, 300) : wild_tree(seed, 300);
        const BranchList list = list_branches(before);
        Random random(seed);
        const std::vector<NodeId> ids = before.depth_first();
        const NodeId id = ids[random.below(static_cast<uint32_t>(ids.size()))];
        const auto expect_left = [&](const Tree& tree, const auto& stays) {
            for (const NodeId node : ids)
                EXPECT_EQ(tree.contains(node), stays(node)) << "seed " << seed << ", node " << node;
            EXPECT_EQ(tree.check(), std::nullopt);
        };
        const std::vector<NodeId> above = before.depth_first(id);
        Tree tree = before;
        prune_below(tree, id);
        expect_left(tree, [&](NodeId n) {
            return n == id || std::find(above.begin(), above.end(), n) == above.end();
        });
        tree = before;
        const int order = 1 + static_cast<int>(random.below(3));
        prune_by_order(tree, order);
        expect_left(tree, [&](NodeId n) { return list.branches[list.branch_of[n]].order < order; });
        tree = before;
        const double radius = before.node(id).radius;
        prune_by_radius(tree, radius);
        std::vector<double> thickest(static_cast<size_t>(before.id_end()), 0.0);
        for (auto at = ids.rbegin(); at != ids.rend(); ++at) {
            thickest[*at] = std::max(thickest[*at], before.node(*at).radius);
            if (before.node(*at).parent != kNoNode)
                thickest[before.node(*at).parent] =
                    std::max(thickest[before.node(*at).parent], thickest[*at]);
        }
        expect_left(tree, [&](NodeId n) { return n == before.root() || thickest[n] >= radius; });
        tree = before;
        const NodeId other = ids[random.below(static_cast<uint32_t>(ids.size()))];
        keep_only(tree, {id, other});
        const std::vector<NodeId> one = select_path(before, id), two = select_path(before, other);
        expect_left(tree, [&](NodeId n) {
            return std::find(one.begin(), one.end(), n) != one.end() ||
                   std::find(two.begin(), two.end(), n) != two.end();
        });
        tree = before;
        if (id != before.root() && other != before.root()) {
            // In whatever order they are named.
            Tree reversed = before;
            remove_wood(tree, {id, other});
            remove_wood(reversed, {other, id});
            EXPECT_TRUE(identical(tree, reversed));
        }
    }
    Tree tree = broom(2, {2, 2});
    EXPECT_THROW(prune_by_order(tree, 0), Error);
    EXPECT_THROW(keep_only(tree, {}), Misfit);
    EXPECT_THROW(remove_wood(tree, {tree.root()}), Misfit);
    EXPECT_THROW(remove_wood(tree, {1, 999}), Misfit);
    EXPECT_EQ(tree.size(), 7U);
}

TEST(EditPrune, ADeletedNodesNeighboursAreJoined) {
    Tree tree = broom(3, {2, 3});
    tree.set_flag(2, kGuessFlag, true);
    delete_node(tree, 2);
    EXPECT_EQ(tree.node(3).parent, 1);
    EXPECT_TRUE(tree.node(3).is_guess()) << "a bridged gap stays one";
    delete_node(tree, 3);
    EXPECT_EQ(tree.node(1).child_count, 2);
    EXPECT_TRUE(tree.node(tree.node(1).first_child).is_guess());
    delete_node(tree, tree.root());
    EXPECT_EQ(tree.root(), 1);
    EXPECT_THROW(delete_node(tree, 1), Misfit) << "a forking root has no single heir";
    EXPECT_EQ(tree.check(), std::nullopt);
}

}  // namespace
}  // namespace treerec
