// The command that gives wood leaves of its own, and what becomes of its rules in other edits.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>

#include "cases.h"
#include "edit/commands/commands.h"
#include "edit/commands/script.h"
#include "edit/vary/vary.h"
#include "edit_at_random.h"
#include "random_tree.h"
#include "synth/grow.h"
#include "tree/branches.h"

namespace treerec {
namespace {

using test::cases;
using test::edit_at_random;
using test::random_tree;
using test::Tally;

std::string rule_of(const Tree& tree, NodeId id) {
    const uint8_t number = tree.node(id).leaf_rule;
    return number == 0 ? "" : tree.leaf_rules().at(number - 1u);
}

// Metres of wood by rule.
std::map<std::string, double> wood_by_rule(const Tree& tree) {
    std::map<std::string, double> wood;
    for (const NodeId id : tree.depth_first())
        if (tree.node(id).parent != kNoNode)
            wood[rule_of(tree, id)] +=
                glm::distance(tree.node(id).position, tree.node(tree.node(id).parent).position);
    return wood;
}

// A node with much above it, but not the trunk.
NodeId branch_of(const Tree& tree, Random& random) {
    const BranchList list = list_branches(tree);
    for (;;) {
        const Branch& branch = list.branches[random.below(static_cast<uint32_t>(list.branches.size()))];
        const NodeId id = list.nodes[branch.begin];
        if (branch.order == 1 && tree.depth_first(id).size() > 10) return id;
    }
}

TEST(LeavesCommand, SetsExactlyWhatWasAskedFor) {
    for (uint64_t seed = 1; seed <= cases(50); seed++) {
        Random random(seed);
        Tree tree = random_tree(seed, 300);
        const Tree before = tree;
        const NodeId side_branch = branch_of(tree, random);
        const Edit edit = perform(
            tree, "leaves where=below:" + std::to_string(side_branch) + " rule=\"pine  leaf_size=0.40\"");
        const std::vector<NodeId> above = tree.depth_first(side_branch);
        EXPECT_EQ(edit.outcome.nodes.size(), above.size());
        EXPECT_EQ(tree.leaf_rules(), std::vector<std::string>{"pine leaf_size=0.4"});
        for (const NodeId id : tree.depth_first())
            ASSERT_EQ(!rule_of(tree, id).empty(), std::find(above.begin(), above.end(), id) != above.end());
        // All of it is back: the tree is as if nothing had been.
        perform(tree, "leaves where=all rule=default");
        ASSERT_TRUE(identical(tree, before));
    }
}

// Chen 2025, 3.2.5: end nodes are what leaves are put on; they stand along the twig.
TEST(LeavesCommand, AnEndNodeStandsForItsTwig) {
    Tree tree;
    const NodeId root = tree.add_root({0, 0, 0}, 0.1);
    const NodeId fork = tree.add_child(root, {0, 1, 0}, 0.08);
    const NodeId a = tree.add_child(fork, {0.5, 1.5, 0}, 0.03);
    const NodeId b = tree.add_child(a, {1, 2, 0}, 0.02);
    const NodeId tip = tree.add_child(b, {1.5, 2.5, 0}, 0.01);
    const NodeId other = tree.add_child(fork, {-0.5, 1.5, 0}, 0.03);
    const Edit edit = perform(tree, "leaves where=" + std::to_string(tip) + " rule=maple");
    EXPECT_EQ(edit.outcome.nodes, (std::vector<NodeId>{a, b, tip}));
    EXPECT_EQ(rule_of(tree, fork), "");
    EXPECT_EQ(rule_of(tree, other), "");
    // A node within it is that node alone.
    perform(tree, "leaves where=" + std::to_string(b) + " rule=oak");
    EXPECT_EQ(rule_of(tree, a), "maple");
    EXPECT_EQ(rule_of(tree, b), "oak");
    EXPECT_EQ(rule_of(tree, tip), "maple");
    EXPECT_TRUE(perform(tree, "leaves where=" + std::to_string(b) + " rule=oak").delta.empty());
    const Tree kept = tree;
    EXPECT_THROW(perform(tree, "leaves where=all rule=ok"), Error);
    EXPECT_THROW(perform(tree, "leaves rule=oak"), CommandError);
    EXPECT_TRUE(identical(tree, kept));
}

TEST(LeavesCommand, OtherEditsOfTreesWithRulesAreSoundAndUndo) {
    Tally tally;
    for (uint64_t seed = 1; seed <= cases(25); seed++) {
        Random random(seed);
        Tree tree = random_tree(seed, 200);
        for (const char* rule : {"oak", "pine leaf_size=0.3", "droop=50", "none"})
            perform(tree, "leaves where=below:" + std::to_string(branch_of(tree, random)) +
                              ",leaves&height:" + number_text(random.uniform(3.0, 12.0)) + ".. rule=\"" +
                              rule + "\"");
        edit_at_random(tree, seed, 60, tally);
        if (HasFatalFailure()) FAIL() << "seed " << seed;
    }
}

TEST(LeavesCommand, TheLogSaysItAll) {
    for (uint64_t seed = 1; seed <= cases(20); seed++) {
        Random random(seed);
        const Tree start = random_tree(seed, 250);
        Tree tree = start;
        EditLog log;
        for (int i = 0; i < 12; i++) {
            const std::string side_branch = std::to_string(branch_of(tree, random));
            const char* rules[] = {"oak", "maple leaf_size=0.2 curl=30", "droop=70", "default"};
            log.add(perform(tree, i % 3 == 2
                                      ? "graft node=" + side_branch + " twig=oak seed=" + std::to_string(i)
                                      : "leaves where=below:" + side_branch + " rule=\"" +
                                            rules[random.below(4)] + "\""));
        }
        Tree again = start;
        run_script(again, log.text());
        ASSERT_TRUE(identical(again, tree)) << "seed " << seed;
    }
}

TEST(LeavesCommand, RemovedWoodKeepsItsRules) {
    for (uint64_t seed = 1; seed <= cases(30); seed++) {
        Random random(seed);
        Tree tree = random_tree(seed, 300);
        const std::string side_branch = std::to_string(branch_of(tree, random));
        perform(tree, "leaves where=leaves rule=oak");
        perform(tree, "leaves where=below:" + side_branch + "&leaves rule=\"maple droop=5\"");
        const Tree before = tree;
        EditOutcome outcome = perform(tree, "cut node=" + side_branch).outcome;
        // Rules may have other numbers in a later edit of the same step.
        perform(tree, "leaves where=all rule=birch");
        outcome.removed.append(perform(tree, "prune_order order=1").outcome.removed);
        for (size_t i = 0; i < outcome.removed.pieces.size(); i++) {
            const Tree piece = outcome.removed.piece(i, tree.frame());
            ASSERT_EQ(piece.check(), std::nullopt);
            const std::vector<NodeId> ids = piece.depth_first();
            const size_t begin = outcome.removed.pieces[i].begin;
            for (size_t k = 1; k < ids.size(); k++) {
                const NodeId was = outcome.removed.nodes[begin + k - 1].id;
                ASSERT_EQ(rule_of(piece, ids[k]), i == 0 ? rule_of(before, was) : "birch");
            }
            ASSERT_EQ(rule_of(piece, piece.root()), rule_of(piece, ids[1]));
        }
        ASSERT_GT(outcome.removed.pieces.size(), 1U);
        ASSERT_TRUE(wood_by_rule(outcome.removed.piece(0, tree.frame())).contains("maple droop=5"));
    }
}

TEST(LeavesCommand, GraftsOfTheLibraryTakeTheHostsLeavesAndCopiesKeepTheirOwn) {
    Tree tree = random_tree(3, 300);
    Random random(3);
    const NodeId from = branch_of(tree, random);
    NodeId onto = from;
    while (onto == from)
        onto = branch_of(tree, random);
    perform(tree, "leaves where=" + std::to_string(onto) + " rule=oak");
    perform(tree, "leaves where=below:" + std::to_string(from) + " rule=pine");
    const std::string node = " node=" + std::to_string(onto);
    for (const NodeId id : perform(tree, "graft twig=maple" + node).outcome.nodes)
        EXPECT_EQ(rule_of(tree, id), "oak");
    for (const NodeId id : perform(tree, "graft from=" + std::to_string(from) + node).outcome.nodes)
        EXPECT_EQ(rule_of(tree, id), "pine");
    // Of the tree's own kind, too.
    perform(tree, "leaves where=below:" + std::to_string(from) + " rule=default");
    for (const NodeId id : perform(tree, "graft from=" + std::to_string(from) + node).outcome.nodes)
        EXPECT_EQ(rule_of(tree, id), "");
    const NodeId side_branch = from;
    perform(tree, "leaves where=below:" + std::to_string(side_branch) + " rule=birch");
    for (const NodeId id :
         perform(tree, "lstring node=" + std::to_string(side_branch) + " string=F(0.3)[+F(0.2)]F(0.3)")
             .outcome.nodes)
        EXPECT_EQ(rule_of(tree, id), "birch");
}

TEST(LeavesCommand, VariantsKeepTheRulesWhereTheyAre) {
    for (uint64_t seed = 1; seed <= 4; seed++) {
        GrowOptions options;
        options.seed = seed;
        Tree tree = grow_tree(options);
        Random random(seed);
        const NodeId side_branch = branch_of(tree, random);
        perform(tree, "leaves where=below:" + std::to_string(side_branch) + " rule=pine");
        const double share = wood_by_rule(tree)["pine"];
        const VariantMaker maker(tree);
        EXPECT_TRUE(identical(maker.make(1, 0.0).tree, tree));
        for (uint64_t variant = 1; variant <= 10; variant++) {
            const Tree made = maker.make(variant, 0.7).tree;
            ASSERT_EQ(made.check(), std::nullopt);
            EXPECT_EQ(made.leaf_rules(), tree.leaf_rules());
            // One branch has them, with about as much wood.
            EXPECT_GT(wood_by_rule(made)["pine"], 0.4 * share);
            EXPECT_LT(wood_by_rule(made)["pine"], 2.5 * share);
            int begins = 0;
            for (const NodeId id : made.depth_first())
                begins += made.node(id).leaf_rule == 1 && made.node(made.node(id).parent).leaf_rule == 0;
            EXPECT_EQ(begins, 1) << "seed " << seed << ", variant " << variant;
        }
    }
}

}  // namespace
}  // namespace treerec
