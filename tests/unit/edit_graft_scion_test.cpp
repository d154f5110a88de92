// Branches taken from a tree and put back.
#include <gtest/gtest.h>

#include <cmath>

#include "edit/graft/scion.h"
#include "error.h"
#include "random_tree.h"

namespace treerec {
namespace {

NodeId some_node(const Tree& tree, Random& random) {
    const std::vector<NodeId> all = tree.depth_first();
    return all[random.below(static_cast<uint32_t>(all.size()))];
}

double size_of(const Tree& tree) {
    return std::max(tree.bounds().diagonal(), 1e-9);
}

TEST(EditGraftScion, TakenAndPlacedAtItsJointIsTheSame) {
    for (uint64_t seed = 0; seed < 400; seed++) {
        Random random(seed);
        const int count = 2 + static_cast<int>(random.below(200));
        Tree tree = seed % 2 ? test::random_tree(seed, count) : test::wild_tree(seed, count);
        const NodeId child = some_node(tree, random);
        if (child == tree.root()) continue;
        const NodeId joint = tree.node(child).parent;
        const Tree scion = take_scion(tree, child);
        ASSERT_EQ(scion.check(), std::nullopt);
        EXPECT_EQ(glm::length(scion.node(scion.root()).position), 0.0);
        const std::vector<NodeId> wanted = tree.depth_first(child);
        ASSERT_EQ(scion.size(), wanted.size() + 1);
        const Tree before = tree;
        const std::vector<NodeId> got =
            place_scion(tree, joint, scion, {frame_about(direction_at(tree, joint)), 1.0});
        ASSERT_EQ(tree.check(), std::nullopt);
        ASSERT_EQ(got.size(), wanted.size());
        for (size_t i = 0; i < got.size(); i++) {
            const Node& a = before.node(wanted[i]);
            const Node& b = tree.node(got[i]);
            EXPECT_LE(glm::distance(a.position, b.position), 1e-9 * size_of(before)) << seed;
            EXPECT_EQ(a.radius, b.radius);
            EXPECT_EQ(a.child_count, b.child_count);
            EXPECT_FALSE(b.is_measured() || b.is_trunk());
        }
    }
}

TEST(EditGraftScion, StandsOnThePointsWhereItsJointIsTurned) {
    // The same branch on a turned tree is the same scion, as long as up stays up.
    const Tree tree = test::random_tree(5, 300);
    Tree turned = tree;
    const DMat3 turn = turn_about(DVec3(0, 1, 0), 1.1);
    for (NodeId id : tree.depth_first())
        turned.set_position(id, turn * tree.node(id).position + DVec3(3, 1, -2));
    int compared = 0;
    for (NodeId id : tree.depth_first()) {
        if (tree.node(id).parent == kNoNode) continue;
        const DVec3 forward = direction_at(tree, tree.node(id).parent);
        if (std::abs(forward.y) > 0.93) continue;
        const Tree a = take_scion(tree, id);
        const Tree b = take_scion(turned, id);
        ASSERT_EQ(a.size(), b.size());
        for (NodeId at : a.depth_first())
            EXPECT_LT(glm::distance(a.node(at).position, b.node(at).position), 1e-9);
        compared++;
    }
    EXPECT_GT(compared, 50);
}

TEST(EditGraftScion, TheFrameIsRightHandedAndUpIsUp) {
    Random random(3);
    for (int i = 0; i < 2000; i++) {
        const DVec3 forward = i == 0 ? DVec3(0, 1, 0) : i == 1 ? DVec3(0, -1, 0) : random.direction();
        const DMat3 frame = frame_about(forward);
        EXPECT_NEAR(glm::determinant(frame), 1.0, 1e-12);
        EXPECT_LT(glm::length(frame[1] - forward), 1e-12);
        if (std::abs(forward.y) < 0.93) {
            EXPECT_GE(frame[2].y, 0.3);
            EXPECT_NEAR(frame[0].y, 0.0, 1e-12);
        }
    }
    EXPECT_LT(glm::length(frame_about(DVec3(0, 1, 0))[0] - DVec3(1, 0, 0)), 1e-12);
}

TEST(EditGraftScion, TurnsBetweenAnyDirections) {
    Random random(4);
    for (int i = 0; i < 2000; i++) {
        const DVec3 a = random.direction();
        const DVec3 b = i % 3 == 0 ? -a : i % 3 == 1 ? a : random.direction();
        const DMat3 turn = turn_between(a, b);
        EXPECT_NEAR(glm::determinant(turn), 1.0, 1e-9);
        EXPECT_LT(glm::length(turn * a - b), 1e-9);
    }
}

TEST(EditGraftScion, ASideBranchStartsAsThickAsItself) {
    Tree tree;
    const NodeId base = tree.add_root({0, 0, 0}, 0.2);
    const NodeId fork = tree.add_child(base, {0, 1, 0}, 0.18);
    const NodeId top = tree.add_child(fork, {0, 2, 0}, 0.15);
    const NodeId side = tree.add_child(fork, {1, 1, 0}, 0.03);
    const Tree branch = take_scion(tree, side);
    EXPECT_EQ(branch.node(branch.root()).radius, 0.03);
    EXPECT_LT(glm::length(scion_direction(branch) - DVec3(1, 0, 0)), 1e-12);
    EXPECT_EQ(take_scion(tree, top).node(0).radius, 0.18);
    EXPECT_EQ(take_scion(tree, base).size(), tree.size());
    EXPECT_DOUBLE_EQ(scion_length(take_scion(tree, base)), 2.0);
}

TEST(EditGraftScion, RefusesWhatIsNone) {
    Tree tree;
    EXPECT_THROW(take_scion(tree, 0), Error);
    tree.add_root({0, 0, 0}, 0.1);
    EXPECT_THROW(take_scion(tree, 0), Error);
    EXPECT_THROW(take_scion(tree, 7), Error);
    Tree scion;
    EXPECT_THROW(place_scion(tree, 0, scion, {}), Error);
    scion.add_root({0, 0, 0}, 0.1);
    EXPECT_THROW(place_scion(tree, 0, scion, {}), Error);
    scion.add_child(0, {0, 1, 0}, 0.1);
    EXPECT_THROW(place_scion(tree, 3, scion, {}), Error);
    EXPECT_THROW(place_scion(tree, 0, scion, {DMat3(1.0), HUGE_VAL}), Error);
    EXPECT_THROW(place_scion(tree, 0, scion, {DMat3(1.0), 4.9e-324}), Error);
    EXPECT_EQ(tree.size(), 1u);
    EXPECT_EQ(place_scion(tree, 0, scion, {}).size(), 1u);
    EXPECT_EQ(tree.check(), std::nullopt);
}

TEST(EditGraftScion, LeavesRoomForIds) {
    const std::vector<NodeId> ids{0, kLargestId - 1};
    Tree tree = Tree::from_arrays({-1, 0}, {DVec3(0), DVec3(0, 1, 0)}, {1, 1}, {0, 0}, &ids);
    Tree scion;
    scion.add_root({0, 0, 0}, 0.1);
    scion.add_child(0, {0, 1, 0}, 0.1);
    EXPECT_EQ(place_scion(tree, 0, scion, {})[0], kLargestId);
    EXPECT_THROW(place_scion(tree, 0, scion, {}), Error);
    EXPECT_EQ(tree.size(), 3u);
}

}  // namespace
}  // namespace treerec
