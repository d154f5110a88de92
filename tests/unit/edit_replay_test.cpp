// Logs on another reconstruction of the same scan, whose branches have other nodes, and more or fewer of
// them.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "cases.h"
#include "edit/commands/address.h"
#include "edit/commands/commands.h"
#include "edit/commands/script.h"
#include "edit/select.h"
#include "geometry/random.h"
#include "random_tree.h"

namespace treerec {
namespace {

using test::cases;
using test::random_tree;

std::string list_of(const std::vector<NodeId>& ids) {
    std::string text;
    for (const NodeId id : ids)
        text += (text.empty() ? "" : ",") + std::to_string(id);
    return text;
}

// As a log wrote it that knew nodes alone.
std::string addresses_of(const Tree& tree, const std::vector<NodeId>& ids) {
    std::string text;
    for (const NodeId id : ids)
        text += (text.empty() ? "" : ",") + address_of(tree, id);
    return text;
}

// A branch with some nodes above its first one, or kNoNode.
NodeId branch_of(const Tree& tree, Random& random) {
    std::vector<NodeId> candidates;
    for (const NodeId id : tree.depth_first()) {
        const size_t above = tree.depth_first(id).size();
        if (above >= 8 && above < tree.size() / 3 && tree.node(id).parent != kNoNode)
            candidates.push_back(id);
    }
    return candidates.empty() ? kNoNode : candidates[random.below(static_cast<uint32_t>(candidates.size()))];
}

// The same scan once more: all nodes lie a little elsewhere, and some tips above `branch` were not found.
Tree again(const Tree& tree, NodeId branch, Random& random) {
    Tree copy = tree;
    for (const NodeId id : tree.depth_first())
        copy.set_position(id, tree.node(id).position + random.direction() * 0.0015);
    size_t lost = 0;
    for (const NodeId id : tree.depth_first(branch))
        if (id != branch && tree.node(id).first_child == kNoNode && lost++ % 2 == 0) copy.remove_subtree(id);
    return copy;
}

ScriptResult replay(Tree& tree, const std::string& log) {
    ScriptOptions options;
    options.keep_going = true;
    return run_script(tree, log, options);
}

std::string log_of(const Tree& tree, const std::string& command) {
    EditLog log;
    log.add(EditLog::Entry{command, tree.frame(), ""});
    return log.text();
}

TEST(EditReplay, ABranchIsNamedByItsLowestNode) {
    for (int seed = 0; seed < cases(200); seed++) {
        Tree tree = random_tree(seed, 400);
        Random random(static_cast<uint64_t>(seed));
        const NodeId branch = branch_of(tree, random);
        if (branch == kNoNode) continue;
        std::vector<NodeId> ids = tree.depth_first(branch);
        const Selection selection = select(tree, list_of(ids));
        EXPECT_EQ(selection.text, "below:" + address_of(tree, branch)) << "seed " << seed;
        EXPECT_EQ(select(tree, selection.text).ids, selection.ids) << "seed " << seed;
        // Any nodes are the same nodes after they were written.
        std::vector<NodeId> some;
        for (const NodeId id : tree.depth_first())
            if (random.below(3) > 0) some.push_back(id);
        const Selection mixed = select(tree, list_of(some));
        EXPECT_EQ(mixed.ids, some) << "seed " << seed;
        EXPECT_EQ(select(tree, mixed.text).ids, some) << "seed " << seed << ": " << mixed.text;
    }
}

TEST(EditReplay, ACutFitsThoughSomeOfItsNodesAreGone) {
    size_t tried = 0, in_part = 0;
    for (int seed = 0; seed < cases(200); seed++) {
        const Tree tree = random_tree(seed, 400);
        Random random(static_cast<uint64_t>(seed));
        const NodeId branch = branch_of(tree, random);
        if (branch == kNoNode) continue;
        const Tree other = again(tree, branch, random);
        const std::vector<NodeId> cut = tree.depth_first(branch);
        Tree logged = tree;
        const Edit edit = perform(logged, "remove nodes=" + list_of(cut));
        for (const std::string& command : {edit.command, "remove nodes=" + addresses_of(tree, cut)}) {
            Tree replayed = other;
            const ScriptResult result = replay(replayed, log_of(tree, command));
            EXPECT_EQ(result.done, 1U) << "seed " << seed << ": " << command;
            EXPECT_TRUE(result.left_out.empty()) << "seed " << seed;
            EXPECT_FALSE(replayed.contains(branch)) << "seed " << seed << ": " << command;
            in_part += result.in_part.size();
            if (command != edit.command) continue;
            EXPECT_EQ(replayed.size(), logged.size()) << "seed " << seed;
            for (const NodeId id : logged.depth_first())
                EXPECT_TRUE(replayed.contains(id)) << "seed " << seed << ", node " << id;
        }
        tried++;
    }
    EXPECT_GT(tried, static_cast<size_t>(cases(200)) / 2);
    EXPECT_GT(in_part, 0U);
}

TEST(EditReplay, WhatIsGoneAltogetherIsLeftOutAndNothingElse) {
    Tree tree = random_tree(5, 300);
    const Tree start = tree;
    const std::string gone = "remove nodes=5@0:0:5000:0:0:1:0.1,6@0:0:5001:0:0:1:0.1";
    const std::string half = gone + "," + address_of(tree, tree.nodes_of_kind(NodeKind::kLeaf).back());
    ScriptResult result = replay(tree, log_of(tree, gone));
    EXPECT_EQ(result.done, 0U);
    ASSERT_EQ(result.left_out.size(), 1U);
    EXPECT_TRUE(result.in_part.empty());
    EXPECT_TRUE(identical(tree, start));
    const size_t before = tree.size();
    result = replay(tree, log_of(tree, half));
    EXPECT_EQ(result.done, 1U);
    EXPECT_TRUE(result.left_out.empty());
    ASSERT_EQ(result.in_part.size(), 1U);
    EXPECT_EQ(result.in_part[0].reason, "2 of 3 places are not there any more.");
    EXPECT_EQ(tree.size(), before - 1);
    // A script is done whole or not at all.
    Tree strict = start;
    EXPECT_THROW(run_script(strict, log_of(start, half)), Error);
    EXPECT_TRUE(identical(strict, start));
}

TEST(EditReplay, TellsWhereACommandWas) {
    for (int seed = 0; seed < cases(100); seed++) {
        Tree tree = random_tree(seed, 200);
        tree.set_frame({{1000, 2000, 30}, 0.01, UpAxis::kZ});
        Random random(static_cast<uint64_t>(seed));
        std::vector<NodeId> ids;
        for (const NodeId id : tree.depth_first())
            if (random.below(20) == 0) ids.push_back(id);
        const std::string command = "move nodes=" + addresses_of(tree, ids) + " by=1,2,3";
        const std::vector<NamedPlace> places = places_named(tree.frame(), command);
        ASSERT_EQ(places.size(), ids.size()) << command;
        for (size_t i = 0; i < ids.size(); i++) {
            const Node& node = tree.node(ids[i]);
            EXPECT_LT(glm::distance(places[i].place, node.position), 0.001);
            EXPECT_NEAR(places[i].radius, node.radius, 1e-3 * node.radius);
            if (node.parent == kNoNode) continue;
            const DVec3 way = node.position - tree.node(node.parent).position;
            EXPECT_GT(glm::dot(places[i].direction, way), 0.99 * glm::length(way));
        }
    }
    EXPECT_TRUE(places_named(ScanFrame(), "cut node=5 stub=0.1").empty());
    EXPECT_TRUE(places_named(ScanFrame(), "cut node=5@a:b:c").empty());
    EXPECT_EQ(places_named(ScanFrame(), "remove nodes=below:7@1:2:3&order:2,@4:5:6").size(), 2U);
}

TEST(EditReplay, AnEntryOfALogCanBeTakenOut) {
    const Tree tree = random_tree(1, 100);
    EditLog log;
    log.add(EditLog::Entry{"prune_order order=3", tree.frame(), ""});
    log.add(EditLog::Entry{"cut node=99999", tree.frame(), "There is no node 99999 in this tree."});
    log.add(EditLog::Entry{"smooth", tree.frame(), ""});
    log.remove(1);
    ASSERT_EQ(log.entries().size(), 2U);
    EXPECT_EQ(log.entries()[1].command, "smooth");
    EXPECT_EQ(log.text().find("cut"), std::string::npos);
}

}  // namespace
}  // namespace treerec
