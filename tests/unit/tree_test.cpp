#include "tree/tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>
#include <set>

#include "error.h"
#include "geometry/random.h"
#include "tree/branches.h"
#include "tree/trunk.h"

namespace treerec {
namespace {

// A slow, obvious tree to compare with: children as lists, by id.
struct Model {
    NodeId root = kNoNode;
    std::map<NodeId, NodeId> parent;
    std::map<NodeId, std::vector<NodeId>> children;

    void remove(NodeId id) {
        for (NodeId child : std::vector<NodeId>(children[id]))
            remove(child);
        if (parent[id] != kNoNode)
            std::erase(children[parent[id]], id);
        else
            root = kNoNode;
        children.erase(id);
        parent.erase(id);
    }
    std::vector<NodeId>::iterator place(NodeId id) { return std::ranges::find(children[parent[id]], id); }
    bool below(NodeId id, NodeId ancestor) const {
        for (; id != kNoNode; id = parent.at(id))
            if (id == ancestor) return true;
        return false;
    }
};

void expect_same(const Tree& tree, const Model& model) {
    ASSERT_EQ(tree.check(), std::nullopt);
    ASSERT_EQ(tree.size(), model.parent.size());
    ASSERT_EQ(tree.root(), model.root);
    for (const auto& [id, parent] : model.parent) {
        ASSERT_TRUE(tree.contains(id));
        ASSERT_EQ(tree.node(id).parent, parent);
        std::vector<NodeId> children;
        for (NodeId child : tree.children(id))
            children.push_back(child);
        ASSERT_EQ(children, model.children.at(id));
    }
}

TEST(Tree, RandomEditsAgreeWithASimpleModel) {
    for (uint64_t seed = 1; seed <= 40; seed++) {
        Random random(seed);
        Tree tree;
        Model model;
        model.root = tree.add_root({0, 0, 0}, 1.0);
        model.parent[model.root] = kNoNode;
        model.children[model.root] = {};
        for (int step = 0; step < 300; step++) {
            std::vector<NodeId> ids;
            for (const auto& [id, parent] : model.parent)
                ids.push_back(id);
            const NodeId id = ids[random.below(static_cast<uint32_t>(ids.size()))];
            const NodeId other = ids[random.below(static_cast<uint32_t>(ids.size()))];
            switch (random.below(12)) {
                case 0:
                    if (id == model.root) break;
                    tree.remove_subtree(id);
                    model.remove(id);
                    break;
                case 1:
                case 2: {
                    if (id == model.root) break;
                    tree.dissolve(id);
                    const auto at = model.place(id);
                    std::vector<NodeId>& siblings = model.children[model.parent[id]];
                    const auto after = siblings.erase(at);
                    siblings.insert(after, model.children[id].begin(), model.children[id].end());
                    for (NodeId child : model.children[id])
                        model.parent[child] = model.parent[id];
                    model.children.erase(id);
                    model.parent.erase(id);
                    break;
                }
                case 3: {
                    if (id == model.root) break;
                    const NodeId middle = tree.insert_before(id, random.direction(), 0.5);
                    *model.place(id) = middle;
                    model.parent[middle] = model.parent[id];
                    model.children[middle] = {id};
                    model.parent[id] = middle;
                    break;
                }
                case 4:
                    if (model.below(other, id)) {
                        EXPECT_THROW(tree.reparent(id, other), Error);
                        break;
                    }
                    tree.reparent(id, other);
                    model.children[model.parent[id]].erase(model.place(id));
                    model.parent[id] = other;
                    model.children[other].push_back(id);
                    break;
                case 5: {
                    if (id == model.root) break;
                    tree.make_first_child(id);
                    const auto at = model.place(id);
                    std::rotate(model.children[model.parent[id]].begin(), at, at + 1);
                    break;
                }
                default: {
                    const NodeId added = tree.add_child(id, random.direction(), 0.1);
                    model.parent[added] = id;
                    model.children[id].push_back(added);
                    model.children[added] = {};
                }
            }
            expect_same(tree, model);
            if (HasFatalFailure()) FAIL() << "seed " << seed << ", step " << step;
        }
        const Tree compact = tree.compacted();
        ASSERT_EQ(compact.check(), std::nullopt);
        ASSERT_EQ(compact.size(), tree.size());
        ASSERT_EQ(static_cast<size_t>(compact.id_end()), compact.size());
    }
}

Tree forked_tree() {
    Tree tree;
    NodeId at = tree.add_root({0, 0, 0}, 0.10);
    at = tree.add_child(at, {0, 1, 0}, 0.09);
    const NodeId fork = tree.add_child(at, {0, 2, 0}, 0.08);
    const NodeId leader = tree.add_child(fork, {0, 3, 0}, 0.06);
    tree.add_child(fork, {0.5, 2.1, 0}, 0.03);
    tree.add_child(leader, {0, 4, 0}, 0.05);
    return tree;
}

TEST(Tree, KindsAndDepthsFollowAlgorithm1) {
    Tree tree = forked_tree();
    mark_trunk(tree);
    EXPECT_EQ(tree.node(0).depth, 1);
    EXPECT_EQ(tree.node(5).depth, 5);
    EXPECT_EQ(tree.nodes_of_kind(NodeKind::kLeaf), (std::vector<NodeId>{4, 5}));
    EXPECT_EQ(tree.nodes_of_kind(NodeKind::kBranch), (std::vector<NodeId>{2}));
    EXPECT_EQ(tree.nodes_of_kind(NodeKind::kTrunk), (std::vector<NodeId>{0, 1, 3}));
    EXPECT_FALSE(tree.node(4).is_trunk());
    EXPECT_TRUE(tree.node(5).is_trunk());
}

TEST(Trunk, ForksIntoTwoStemsOnlyIfBothAreThickAndClose) {
    Tree tree;
    tree.add_root({0, 0, 0}, 0.1);
    const NodeId thick = tree.add_child(0, {0.1, 1, 0}, 0.08);
    const NodeId twin = tree.add_child(0, {-0.1, 1, 0}, 0.07);
    const NodeId aside = tree.add_child(0, {1, 0.1, 0}, 0.08);
    const NodeId thin = tree.add_child(0, {0, 1, 0.1}, 0.02);
    mark_trunk(tree);
    EXPECT_TRUE(tree.node(thick).is_trunk());
    EXPECT_TRUE(tree.node(twin).is_trunk());
    EXPECT_FALSE(tree.node(aside).is_trunk());
    EXPECT_FALSE(tree.node(thin).is_trunk());
}

TEST(Trunk, MarksAgainAfterAnEdit) {
    Tree tree = forked_tree();
    mark_trunk(tree);
    tree.set_radius(4, 0.2);
    mark_trunk(tree);
    EXPECT_TRUE(tree.node(4).is_trunk());
    EXPECT_FALSE(tree.node(3).is_trunk());
}

TEST(Branches, CoverEveryNodeOnceAndContinueTheThickest) {
    const Tree tree = forked_tree();
    const BranchList list = list_branches(tree);
    ASSERT_EQ(list.branches.size(), 2U);
    EXPECT_EQ(list.branches[0].order, 0);
    EXPECT_EQ(list.branches[1].order, 1);
    EXPECT_EQ(list.branches[1].attach, 2);
    EXPECT_DOUBLE_EQ(list.branches[0].length, 4.0);
    EXPECT_EQ(std::set<NodeId>(list.nodes.begin(), list.nodes.end()).size(), tree.size());
    EXPECT_NEAR(subtree_lengths(tree)[2], 2.0 + std::hypot(0.5, 0.1), 1e-12);
    EXPECT_NEAR(longest_paths(tree)[0], 4.0, 1e-12);
}

TEST(Tree, RefusesWhatWouldBreakIt) {
    Tree tree = forked_tree();
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(tree.add_root({0, 0, 0}, 1), Error);
    EXPECT_THROW(tree.add_child(99, {0, 0, 0}, 1), Error);
    EXPECT_THROW(tree.add_child(-1, {0, 0, 0}, 1), Error);
    EXPECT_THROW(tree.add_child(0, {0, nan, 0}, 1), Error);
    EXPECT_THROW(tree.add_child(0, {0, 0, 0}, 0), Error);
    EXPECT_THROW(tree.set_radius(0, nan), Error);
    EXPECT_THROW(tree.dissolve(99), Error);
    EXPECT_THROW(tree.insert_before(tree.root(), {0, 0, 0}, 1), Error);
    EXPECT_EQ(tree.check(), std::nullopt);
    EXPECT_EQ(tree.size(), 6U);
}

TEST(Tree, ArraysRoundTripWithIds) {
    Tree tree = forked_tree();
    tree.remove_subtree(4);
    std::vector<NodeId> ids = tree.depth_first(), parents;
    std::ranges::reverse(ids);  // parents after their children must do
    std::vector<DVec3> positions;
    std::vector<double> radii;
    std::vector<uint8_t> flags;
    for (NodeId id : ids) {
        const Node& node = tree.node(id);
        const auto parent = std::ranges::find(ids, node.parent);
        parents.push_back(parent == ids.end() ? kNoNode : static_cast<NodeId>(parent - ids.begin()));
        positions.push_back(node.position);
        radii.push_back(node.radius);
        flags.push_back(node.flags);
    }
    const Tree copy = Tree::from_arrays(parents, positions, radii, flags, &ids);
    EXPECT_EQ(copy.check(), std::nullopt);
    EXPECT_EQ(copy.depth_first(), tree.depth_first());
}

TEST(Tree, HostileArraysNeverMakeABrokenTree) {
    Random random(7);
    int accepted = 0;
    for (int round = 0; round < 20000; round++) {
        const size_t count = 1 + random.below(6);
        std::vector<NodeId> parents, ids;
        for (size_t i = 0; i < count; i++) {
            parents.push_back(static_cast<NodeId>(random.below(static_cast<uint32_t>(count) + 2)) - 1);
            ids.push_back(random.below(50) == 0 ? -5 : static_cast<NodeId>(random.below(12)));
        }
        const std::vector<DVec3> positions(count, DVec3(0.0));
        const std::vector<double> radii(count, random.below(10) == 0 ? -1.0 : 1.0);
        const std::vector<uint8_t> flags(count, 0);
        try {
            const Tree tree = Tree::from_arrays(parents, positions, radii, flags, round % 2 ? &ids : nullptr);
            accepted++;
            ASSERT_EQ(tree.check(), std::nullopt);
            ASSERT_EQ(tree.size(), count);
        } catch (const Error&) {
        }
    }
    EXPECT_GT(accepted, 100);
}

TEST(Tree, DeepChainsDoNotOverflowTheStack) {
    Tree tree;
    NodeId at = tree.add_root({0, 0, 0}, 0.1);
    for (int i = 1; i < 300000; i++)
        at = tree.add_child(at, {0, i * 0.001, 0}, 0.1);
    mark_trunk(tree);
    EXPECT_EQ(tree.check(), std::nullopt);
    EXPECT_EQ(list_branches(tree).branches.size(), 1U);
    EXPECT_EQ(tree.remove_subtree(1).size(), 299999U);
}

TEST(Tree, RebaseAndScaleKeepThePlaceInTheScan) {
    Tree tree = forked_tree();
    tree.set_frame({{500000.25, 4000000.5, 120.0}, 0.01, UpAxis::kZ});
    const DVec3 before = tree.frame().to_scan(tree.node(4).position);
    tree.rebase({3, 1, -2});
    tree.scale(2.5);
    const DVec3 after = tree.frame().to_scan(tree.node(4).position);
    EXPECT_NEAR(glm::distance(before, after), 0.0, 1e-8);
}

TEST(ScanFrame, TurnsBackAndNeverMirrors) {
    for (const char* name : {"x", "y", "z", "-x", "-y", "-z"}) {
        ScanFrame frame{{10, 20, 30}, 0.01, parse_up_axis(name)};
        EXPECT_STREQ(up_axis_name(frame.up), name);
        const DVec3 a = frame.turn_to_tree({1, 0, 0}), b = frame.turn_to_tree({0, 1, 0}),
                    c = frame.turn_to_tree({0, 0, 1});
        EXPECT_NEAR(glm::dot(glm::cross(a, b), c), 1.0, 1e-12) << name;
        EXPECT_NEAR(glm::distance(frame.to_scan(frame.to_tree({7, -8, 9})), DVec3(7, -8, 9)), 0.0, 1e-12);
        DVec3 up(0.0);
        up["xyz"[0] == name[0] ? 0 : name[name[0] == '-'] - 'x'] = name[0] == '-' ? -1.0 : 1.0;
        EXPECT_NEAR(frame.turn_to_tree(up).y, 1.0, 1e-12) << name;
    }
    EXPECT_THROW(parse_up_axis("up"), Error);
}

TEST(ScanFrame, TakesAnyDirectionForTheSky) {
    Random random(1);
    for (int round = 0; round < 1000; round++) {
        const DVec3 sky = random.direction();
        ScanFrame frame{{10, 20, 30}, 0.01};
        frame.set_sky(random.uniform(0.1, 10.0) * sky);
        EXPECT_NEAR(glm::distance(frame.turn_to_tree(sky), DVec3(0, 1, 0)), 0.0, 1e-12);
        const DVec3 a = frame.turn_to_tree({1, 0, 0}), b = frame.turn_to_tree({0, 1, 0}),
                    c = frame.turn_to_tree({0, 0, 1});
        EXPECT_NEAR(glm::dot(glm::cross(a, b), c), 1.0, 1e-12);
        EXPECT_NEAR(glm::distance(frame.to_scan(frame.to_tree({7, -8, 9})), DVec3(7, -8, 9)), 0.0, 1e-11);
        EXPECT_TRUE(is_tilt(frame.tilt));
        // The axis is the nearest one.
        ScanFrame plain = frame;
        plain.tilt = DVec3(0.0);
        EXPECT_NEAR(std::cos(glm::radians(frame.tilt_degrees())), plain.turn_to_tree(sky).y, 1e-12);
        EXPECT_LE(frame.tilt_degrees(), 54.74);
    }
    for (const char* name : {"x", "y", "z", "-x", "-y", "-z"}) {
        ScanFrame axis, found;
        axis.up = parse_up_axis(name);
        found.set_sky(axis.turn_to_scan({0, 3, 0}));
        EXPECT_EQ(found, axis) << name;
    }
}

}  // namespace
}  // namespace treerec
