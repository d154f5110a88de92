// Deltas, addresses, selections, scripts and logs.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "edit/commands/address.h"
#include "edit/commands/script.h"
#include "edit/delta.h"
#include "edit/select.h"
#include "random_edit.h"
#include "random_tree.h"
#include "tree/branches.h"

namespace treerec {
namespace {

using test::random_command;
using test::random_tree;
using test::wild_tree;

TEST(EditDelta, HoldsOnlyWhatChanged) {
    const Tree before = random_tree(1, 5000);
    Tree tree = before;
    EXPECT_TRUE(TreeDelta::between(before, tree).empty());
    const NodeId id = tree.depth_first()[100];
    tree.set_position(id, tree.node(id).position + DVec3(0.1, 0, 0));
    const TreeDelta moved = TreeDelta::between(before, tree);
    EXPECT_EQ(moved.changed(), std::vector<NodeId>{id});
    EXPECT_EQ(moved.changed(TreeDelta::kPosition), std::vector<NodeId>{id});
    EXPECT_TRUE(moved.changed(TreeDelta::kRadius).empty());
    EXPECT_LT(moved.bytes(), 400U);
    const NodeId child = tree.add_child(id, {1, 2, 3}, 0.01);
    tree.remove_subtree(child);
    EXPECT_FALSE(identical(tree, before)) << "an id was spent";
    tree = before;
    moved.apply(tree);
    EXPECT_FALSE(identical(tree, before));
    moved.revert(tree);
    EXPECT_TRUE(identical(tree, before));
}

TEST(EditDelta, MinusZeroComesBack) {
    Tree before;
    before.add_root({0.0, 0.0, 0.0}, 1.0);
    Tree tree = before;
    tree.set_position(0, {-0.0, 0.0, 0.0});
    const TreeDelta delta = TreeDelta::between(before, tree);
    EXPECT_FALSE(delta.empty());
    delta.revert(tree);
    EXPECT_FALSE(std::signbit(tree.node(0).position.x));
}

TEST(EditDelta, RefusesATreeInAnotherState) {
    const Tree first = random_tree(1, 100);
    Tree second = first;
    const NodeId leaf = first.nodes_of_kind(NodeKind::kLeaf).front();
    second.set_radius(leaf, 1.0);
    Tree third = second;
    third.set_radius(leaf, 2.0);
    const TreeDelta one = TreeDelta::between(first, second), two = TreeDelta::between(second, third);
    Tree tree = first;
    EXPECT_THROW(two.apply(tree), Error);
    EXPECT_THROW(one.revert(tree), Error);
    EXPECT_TRUE(identical(tree, first));
    EXPECT_THROW(TreeDelta::compose(two, one), Error);
    TreeDelta::compose(one, two).apply(tree);
    EXPECT_TRUE(identical(tree, third));
    EXPECT_TRUE(TreeDelta::compose(one, TreeDelta::between(second, first)).empty());
}

TEST(EditAddress, FindsEveryNodeOfTheSameTree) {
    for (const double unit : {1.0, 0.01, 0.3048}) {
        Tree tree = random_tree(5, 400);
        tree.set_frame({{500000.125, 4000000.25, 90.5}, unit, UpAxis::kZ});
        for (const NodeId id : tree.depth_first())
            EXPECT_EQ(find_node(tree, address_of(tree, id)), id);
    }
}

// Reconstructed anew, a tree has other ids, other nodes along the same wood, and lies millimetres aside.
TEST(EditAddress, FindsTheSameWoodOnAnotherReconstruction) {
    int far = 0, all = 0;
    for (uint64_t seed = 1; seed <= 10; seed++) {
        const Tree tree = random_tree(seed, 300);
        Random random(seed);
        Tree other;
        {
            Tree copy = tree;
            for (const NodeId id : copy.depth_first()) {
                if (id == copy.root()) continue;
                const Node node = copy.node(id);
                copy.insert_before(id, glm::mix(copy.node(node.parent).position, node.position, 0.4),
                                   node.radius);
                copy.set_position(id, node.position + random.direction() * 0.004);
                copy.set_radius(id, node.radius * random.uniform(0.8, 1.25));
            }
            // Shifted ids, and another origin.
            const std::vector<NodeId> order = copy.depth_first();
            other = copy.compacted();
            other.rebase({1.0, 0.5, -2.0});
        }
        for (const NodeId id : tree.depth_first()) {
            if (tree.node(id).child_count == 0) continue;
            const NodeId found = find_node(other, address_of(tree, id));
            const DVec3 there = other.frame().to_scan(other.node(found).position);
            all++;
            far += glm::distance(there, tree.frame().to_scan(tree.node(id).position)) > 0.1;
        }
    }
    EXPECT_GT(all, 1000);
    EXPECT_LT(far, all / 50);
}

TEST(EditAddress, SaysWhatIsNotThere) {
    const Tree tree = random_tree(1, 100);
    EXPECT_EQ(find_node(tree, "root"), tree.root());
    EXPECT_EQ(find_node(tree, "@0:0:0"), tree.root());
    EXPECT_THROW(find_node(tree, "1000"), Misfit);
    EXPECT_THROW(find_node(tree, "3@100:100:100:0:1:0:0.1"), Misfit);
    EXPECT_THROW(find_node(tree, "3@0:0:0:0:-1:0:0.1"), Misfit) << "it runs the other way";
    EXPECT_THROW(find_node(tree, "3@0:0:0:0:1:0:0.0001"), Misfit) << "it is far thicker";
    for (const char* text : {"", "x", "-", "@", "@1:2", "@1:2:3:4", "1@a:b:c", "@inf:0:0", "12 ", "1e3"}) {
        try {
            find_node(tree, text);
            ADD_FAILURE() << text;
        } catch (const Misfit&) {
            ADD_FAILURE() << text;
        } catch (const Error&) {
        }
    }
}

TEST(EditSelect, SetsAreWhatTheySay) {
    for (uint64_t seed = 1; seed <= 20; seed++) {
        const Tree tree = seed % 3 ? random_tree(seed, 300) : wild_tree(seed, 300);
        const std::vector<NodeId> all = tree.depth_first();
        const BranchList list = list_branches(tree);
        const NodeId id = all[all.size() / 2];
        const std::string name = std::to_string(id);
        const auto expect = [&](const std::string& text, const auto& wanted) {
            std::vector<NodeId> ids;
            for (const NodeId node : all)
                if (wanted(node)) ids.push_back(node);
            const Selection given = select(tree, text);
            EXPECT_EQ(given.ids, ids) << text;
            EXPECT_EQ(select(tree, given.text).ids, ids) << text << " was kept as " << given.text;
        };
        const auto order = [&](NodeId n) { return list.branches[list.branch_of[n]].order; };
        const auto below = [&](NodeId n) {
            for (; n != kNoNode; n = tree.node(n).parent)
                if (n == id) return true;
            return false;
        };
        const double base = tree.node(tree.root()).position.y;
        const DVec3 centre = tree.bounds().centre();
        expect("all", [](NodeId) { return true; });
        expect("leaves", [&](NodeId n) { return tree.node(n).child_count == 0; });
        expect("forks,leaves", [&](NodeId n) { return tree.node(n).child_count != 1; });
        expect("trunk&!leaves",
               [&](NodeId n) { return tree.node(n).is_trunk() && tree.node(n).child_count; });
        expect("order:1..2", [&](NodeId n) { return order(n) == 1 || order(n) == 2; });
        expect("!order:1..", [&](NodeId n) { return order(n) == 0; });
        expect("radius:..0.02&height:1..", [&](NodeId n) {
            return tree.node(n).radius <= 0.02 && tree.node(n).position.y - base >= 1.0;
        });
        expect("depth:3", [&](NodeId n) { return tree.node(n).depth == 3; });
        expect(name, [&](NodeId n) { return n == id; });
        expect("below:" + name, below);
        expect("branch:" + name, [&](NodeId n) { return list.branch_of[n] == list.branch_of[id]; });
        expect("sphere:" + vector_text(centre, ':') + ":1.5",
               [&](NodeId n) { return glm::distance(tree.node(n).position, centre) <= 1.5; });
        expect("side:" + vector_text(centre, ':') + ":0:2:0,root",
               [&](NodeId n) { return tree.node(n).position.y >= centre.y || n == tree.root(); });
        expect("box:" + vector_text(centre, ':') + ":" + vector_text(centre + DVec3(9, -9, 9), ':'),
               [&](NodeId n) {
                   const DVec3 p = tree.node(n).position - centre;
                   return p.x >= 0 && p.x <= 9 && p.y <= 0 && p.y >= -9 && p.z >= 0 && p.z <= 9;
               });
    }
    const Tree tree = random_tree(1, 50);
    for (const char* text :
         {"", ",", "all,", "&all", "!", "order", "order:", "order:..", "order:1...2", "leaf", "sphere:1:2:3",
          "sphere:1:2:3:0", "side:0:0:0:0:0:0", "box:1:2:3:4:5", "below:x"})
        EXPECT_THROW(select(tree, text), CommandError) << text;
}

TEST(EditScript, LogsReplayToTheSameBytes) {
    for (uint64_t seed = 1; seed <= 60; seed++) {
        Random random(seed);
        Tree tree = seed % 3 ? random_tree(seed, 300) : wild_tree(seed, 150);
        if (seed % 2) tree.set_frame({{500000.125, 4000000.25, 90.5}, 0.01, UpAxis::kZ, {0.1, -0.2, 0.05}});
        const Tree start = tree;
        EditLog log;
        while (log.entries().size() < 12 && tree.size() > 3 && tree.size() < 20000) {
            const std::vector<EditCommand>& all = edit_commands();
            try {
                log.add(perform(tree, random_command(all[random.below(static_cast<uint32_t>(all.size()))],
                                                     tree, random)));
            } catch (const Error&) {
            }
        }
        EXPECT_EQ(EditLog::parse(log.text()).text(), log.text());
        Tree again = start;
        ScriptResult result;
        try {
            result = run_script(again, log.text());
        } catch (const Error& error) {
            FAIL() << "seed " << seed << ": " << error.what() << "\n" << log.text();
        }
        ASSERT_TRUE(identical(again, tree)) << "seed " << seed << "\n" << log.text();
        EXPECT_EQ(result.log.text(), log.text());
        result.delta.revert(again);
        EXPECT_TRUE(identical(again, start));
    }
}

// The log of one reconstruction on another one of the same scan, with another unit, axis and origin.
TEST(EditScript, LogsFitAnotherReconstruction) {
    Tree tree = random_tree(3, 600);
    tree.set_frame({{1000, 2000, 30}, 1.0, UpAxis::kZ});
    Tree other;
    {
        Tree copy = tree;
        Random random(3);
        for (const NodeId id : copy.depth_first())
            copy.set_position(id, copy.node(id).position + random.direction() * 0.002);
        copy.insert_before(copy.depth_first()[1], {0, 0.01, 0}, 0.05);
        other = copy.compacted();
        // Half the size, elsewhere: the same place in the scan.
        other.rebase({0.5, 0.25, 0.5});
        other.scale(0.5);
    }
    EditLog log;
    const Tree start = tree;
    const std::vector<NodeId> forks = tree.nodes_of_kind(NodeKind::kBranch);
    log.add(perform(tree, "prune_side place=0,8,0 towards=0,1,0"));
    log.add(perform(tree, "prune_below node=" + std::to_string(forks[3])));
    log.add(perform(tree, "move nodes=" + std::to_string(forks[2]) + " by=0.2,0,0.1"));
    log.add(perform(tree, "set_radius nodes=leaves&!trunk radius=0.003"));
    EditLog::Entry strange{"cut node=5@0:0:5000:0:0:1:0.1", tree.frame(), ""};
    log.add(strange);
    EXPECT_THROW(run_script(other, log.text()), Error);
    const Tree other_start = other;
    ScriptOptions options;
    options.keep_going = true;
    const ScriptResult result = run_script(other, log.text(), options);
    EXPECT_EQ(result.done, 4U);
    ASSERT_EQ(result.left_out.size(), 1U);
    EXPECT_EQ(result.left_out[0].command, strange.command);
    EXPECT_EQ(result.left_out[0].reason.substr(0, 17), "There is no wood ");
    // The same wood is left.
    const auto span = [](const Tree& t) {
        Bounds scan;
        for (const NodeId id : t.depth_first())
            scan.add(t.frame().to_scan(t.node(id).position));
        return scan;
    };
    const Bounds a = span(tree), b = span(other);
    EXPECT_LT(glm::distance(a.min, b.min), 0.05);
    EXPECT_LT(glm::distance(a.max, b.max), 0.05);
    EXPECT_NEAR(static_cast<double>(tree.size()), static_cast<double>(other.size()), 6.0);
    const NodeId leaf = other.nodes_of_kind(NodeKind::kLeaf).back();
    EXPECT_NEAR(other.frame().length_to_scan(other.node(leaf).radius), 0.003, 1e-12);
    // What did not fit is not lost, and fits again where it belongs.
    EXPECT_NE(result.log.text().find("#? " + strange.command), std::string::npos);
    EXPECT_EQ(EditLog::parse(result.log.text()).text(), result.log.text());
    Tree third = other_start;
    EXPECT_EQ(run_script(third, result.log.text(), options).left_out.size(), 1U);
    EXPECT_TRUE(identical(third, other));
}

TEST(EditScript, ErrorsNameLineAndColumnAndChangeNothing) {
    const Tree start = random_tree(1, 100);
    const auto error_of = [&](const std::string& script) -> std::string {
        Tree tree = start;
        try {
            run_script(tree, script);
        } catch (const Error& error) {
            EXPECT_TRUE(identical(tree, start)) << script;
            return error.what();
        }
        return "";
    };
    EXPECT_EQ(error_of("prune\r\n\n  # nothing\n\tprune_order order=2 # twigs"), "");
    EXPECT_EQ(error_of("prune\nprune factor=x"),
              "Line 2, column 14: 'factor' must be a number from 0 to 1000, not 'x'.");
    EXPECT_EQ(error_of("prune\n\n  cut node=9999"), "Line 3, column 3: There is no node 9999 in this tree.");
    EXPECT_EQ(error_of("frame up=w"), "Line 1, column 10: 'up' must be one of: x y z -x -y -z, not 'w'.");
    EXPECT_EQ(
        error_of("frame tilt=0.9,0.9,0"),
        "Line 1, column 12: 'tilt' must be three numbers x,y,z, together less than 1, not '0.9,0.9,0'.");
    EXPECT_EQ(error_of("frame unit=0"),
              "Line 1, column 12: 'unit' must be a positive number of metres, not '0'.");
    EXPECT_EQ(error_of("frame size=2"),
              "Line 1, column 7: 'frame' takes no 'size'; it takes origin unit up tilt.");
    EXPECT_EQ(error_of("# treerec edit log 2\nprune"),
              "This log was written by a newer version (2; this one reads up to 1). Update to replay it.");
    const std::string newer = "# treerec edit log 2\nsomething new\n";
    EditLog log = EditLog::parse(newer);
    EXPECT_EQ(log.text(), newer) << "a newer log is kept as it is";
    log.add(EditLog::Entry{"prune", {}, ""});
    EXPECT_EQ(log.text(), newer + "frame origin=0,0,0 unit=1 up=y\nprune\n");
    // As a file from elsewhere may end its lines.
    EXPECT_EQ(EditLog::parse("#? cut node=3\r\r\n").entries().at(0).command, "cut node=3");
}

// Whatever is in a script: it runs, or it throws Error and changes nothing.
TEST(EditScript, HostileScriptsNeverHarmTheTree) {
    const Tree start = random_tree(2, 60);
    Random random(11);
    const std::string seedling =
        "frame origin=0,0,0 unit=1 up=y\nprune factor=1.5\ncut node=5@0:1:2:0:1:0:0.1 stub=0.1\n"
        "remove nodes=leaves&!order:1..2,below:7\n#? grow node=3\nmove nodes=4 by=1,2,3 with=alone\n";
    for (int round = 0; round < 3000; round++) {
        std::string script = seedling;
        for (uint32_t i = 1 + random.below(6); i > 0; i--) {
            const size_t at = random.below(static_cast<uint32_t>(script.size()));
            if (random.below(3) == 0)
                script.erase(at, 1 + random.below(4));
            else
                script[at] = static_cast<char>(random.below(256));
            if (script.empty()) script = "x";
        }
        Tree tree = start;
        ScriptOptions options;
        options.keep_going = round % 2 == 0;
        try {
            run_script(tree, script, options);
            ASSERT_EQ(tree.check(), std::nullopt) << script;
        } catch (const Error&) {
            ASSERT_TRUE(identical(tree, start)) << script;
        }
        try {
            const EditLog log = EditLog::parse(script);
            EXPECT_EQ(EditLog::parse(log.text()).text(), log.text());
        } catch (const Error&) {
        }
    }
}

// A script runs in place; its commands one by one, each with a way back, give the same.
TEST(EditScript, IsItsCommandsOneByOne) {
    for (uint64_t seed = 1; seed <= 20; seed++) {
        Tree tree = random_tree(seed, 150), other = tree, third = tree;
        std::string script;
        Random random(seed);
        for (int i = 0; i < 12; i++) {
            const std::string node = std::to_string(random.below(120));
            const std::string line = i % 4 == 0   ? "graft node=" + node + " twig=dead tries=3 seed=" + node
                                     : i % 4 == 1 ? "thicken factor=1.1"
                                     : i % 4 == 2 ? "lstring node=root string=\"F(1)[+F(0.5)]F\""
                                                  : "graft node=root string=\"F(1)\\nF(2)\" vary=segments";
            if (i % 4 == 2 && i < 8) continue;
            script += line + "\n";
        }
        size_t done = 0;
        for (size_t at = 0; at < script.size(); at = script.find('\n', at) + 1) {
            try {
                perform(other, script.substr(at, script.find('\n', at) - at));
                done++;
            } catch (const Error&) {
            }
        }
        ScriptOptions options;
        options.keep_going = true;
        EXPECT_EQ(run_script(tree, script, options).done, done);
        EXPECT_TRUE(identical(tree, other)) << "seed " << seed;
    }
}

// A string of several lines, with a comment and a heading, is one text of one command.
TEST(EditScript, ATextMayHaveSeveralLines) {
    const Tree start = random_tree(3, 80);
    const std::string string = "# L-string; dialect paper\n+45F(0.3) # \"\"up\"\"\n[&80F(0.2)]";
    Tree tree = start, again = start;
    Edit edit = perform(tree, "graft node=5 string=\"" + string + "\"");
    EXPECT_EQ(edit.outcome.nodes.size(), 2u);
    EditLog log;
    log.add(edit);
    log.add(perform(tree, "thicken factor=2"));
    EXPECT_EQ(EditLog::parse(log.text()).text(), log.text());
    EXPECT_EQ(EditLog::parse(log.text()).entries().size(), 2u);
    const ScriptResult result = run_script(again, log.text());
    EXPECT_EQ(result.done, 2u);
    EXPECT_TRUE(identical(tree, again));
    // What does not fit is kept with all its lines, and tried again.
    Tree small;
    small.add_root(DVec3(0.0), 0.1);
    ScriptOptions options;
    options.keep_going = true;
    const ScriptResult left = run_script(small, log.text(), options);
    ASSERT_EQ(left.left_out.size(), 1u);
    EXPECT_EQ(left.left_out[0].line, 3u);
    Tree later = start;
    EXPECT_EQ(run_script(later, left.log.text(), options).done, 2u);
    // Lines are still counted, and a quote that never ends spoils no more than its own.
    try {
        run_script(again, "graft node=5 string=\"F(1)\n\nF(1)\"\nprune factor=x");
        FAIL();
    } catch (const Error& error) {
        EXPECT_TRUE(std::string(error.what()).starts_with("Line 4, column 14: ")) << error.what();
    }
    EXPECT_EQ(run_script(again, "graft node=5 string=\"F(1)\nthicken factor=2\n", options).done, 1u);
}

TEST(EditArguments, ALimitIsNotMissedByARounding) {
    Tree tree = random_tree(3, 40);
    EXPECT_NO_THROW(perform(tree, "graft node=5 stretch=0.9000000000000001"));
    EXPECT_THROW(perform(tree, "graft node=5 stretch=0.90001"), Error);
    EXPECT_THROW(perform(tree, "graft node=5 stretch=nan"), Error);
    EXPECT_THROW(perform(tree, "graft node=4294967301"), Error);
}

}  // namespace
}  // namespace treerec
