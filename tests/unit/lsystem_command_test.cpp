// The edit command 'lstring'.
#include <gtest/gtest.h>

#include "edit/commands/commands.h"
#include "edit/graft/scion.h"
#include "error.h"
#include "lsystem/lstring.h"
#include "random_tree.h"

namespace treerec {
namespace {

std::string command(NodeId node, const std::string& string) {
    return "lstring node=" + std::to_string(node) + " string=\"" + string + "\"";
}

void expect_same_shape(const Tree& a, const Tree& b, double tolerance) {
    ASSERT_EQ(b.check(), std::nullopt);
    const std::vector<NodeId> in_a = a.depth_first(), in_b = b.depth_first();
    ASSERT_EQ(in_a.size(), in_b.size());
    for (size_t i = 0; i < in_a.size(); i++) {
        const Node &x = a.node(in_a[i]), &y = b.node(in_b[i]);
        ASSERT_LT(glm::distance(x.position, y.position), tolerance) << i;
        ASSERT_EQ(x.child_count, y.child_count) << i;
        ASSERT_EQ(x.is_trunk(), y.is_trunk()) << i;
    }
}

TEST(LStringCommand, ABranchsOwnStringPutsItBack) {
    for (uint64_t seed = 1; seed <= 40; seed++) {
        Random random(seed);
        const Tree tree = test::random_tree(seed, 300);
        const std::vector<NodeId> ids = tree.depth_first();
        for (int i = 0; i < 10; i++) {
            const NodeId node = ids[random.below(static_cast<uint32_t>(ids.size()))];
            const Tree scion = take_scion(tree, node);
            Tree edited = tree;
            const Edit edit = perform(edited, command(node, write_lstring(scion, scion.root())));
            expect_same_shape(tree, edited, 1e-4);
            EXPECT_EQ(edit.outcome.nodes.size(), scion.size() - 1);
            EXPECT_EQ(edit.outcome.removed.nodes.size(), scion.size() - 1);
            edit.delta.revert(edited);
            expect_same_shape(tree, edited, 1e-15);
        }
        if (HasFatalFailure()) FAIL() << "seed " << seed;
    }
}

TEST(LStringCommand, AnglesAreRelativeToTheWoodBelow) {
    Tree tree;
    const NodeId root = tree.add_root(DVec3(0.0), 0.2);
    const NodeId fork = tree.add_child(root, {2, 0, 0}, 0.1);
    const NodeId first = tree.add_child(fork, {3, 0, 0}, 0.1);
    const NodeId middle = tree.add_child(fork, {2, 1, 0}, 0.05);
    tree.add_child(middle, {2, 2, 0}, 0.05);
    const NodeId last = tree.add_child(fork, {2, 0, 1}, 0.05);
    const Edit edit = perform(tree, command(middle, "!(0.03)F(0.5)[&(90)f(0.25)]") + " unit=2");
    ASSERT_EQ(tree.check(), std::nullopt);
    // On along +X; the side that was up is +Y. In the place among its siblings that the old one had.
    std::vector<NodeId> children;
    for (NodeId child : tree.children(fork))
        children.push_back(child);
    ASSERT_EQ(children, (std::vector<NodeId>{first, edit.outcome.nodes[0], last}));
    const Node& near = tree.node(edit.outcome.nodes[0]);
    EXPECT_LT(glm::distance(near.position, DVec3(3, 0, 0)), 1e-12);
    EXPECT_NEAR(near.radius, 0.06, 1e-12);
    const Node& far = tree.node(edit.outcome.nodes[1]);
    EXPECT_LT(glm::distance(far.position, DVec3(3, -0.5, 0)), 1e-12);
    EXPECT_TRUE(far.is_guess());
    EXPECT_EQ(edit.outcome.said, "The string's 2 nodes take the place of 2.");
}

TEST(LStringCommand, TheRootIsTheWholeTree) {
    Tree tree = test::random_tree(3, 100);
    tree.rebase({1, 0, 1});
    const DVec3 base = tree.node(tree.root()).position;
    perform(tree, command(tree.root(), "!(0.5)F(1)[+(90)F(1)]F(1)"));
    ASSERT_EQ(tree.size(), 4u);
    EXPECT_EQ(tree.node(tree.root()).position, base);
    EXPECT_EQ(tree.node(tree.root()).radius, 0.5);
    EXPECT_LT(glm::distance(tree.bounds().max, base + DVec3(0.5, 2.5, 0.5)), 1e-9);
}

TEST(LStringCommand, MistakesChangeNothing) {
    Tree tree = test::random_tree(3, 100);
    const auto sentence = [&](const std::string& line) -> std::string {
        const Tree before = tree;
        try {
            perform(tree, line);
        } catch (const Error& error) {
            expect_same_shape(before, tree, 1e-15);
            return error.what();
        }
        return "no error";
    };
    EXPECT_EQ(sentence(command(5, "F(1)[")), "The L-string, line 1, column 5: this [ is never closed.");
    EXPECT_NE(sentence(command(5, "!(0.1)")), "no error");
    EXPECT_NE(sentence("lstring node=5"), "no error");
    EXPECT_NE(sentence(command(5, "F(1)") + " dialect=french"), "no error");
}

}  // namespace
}  // namespace treerec
