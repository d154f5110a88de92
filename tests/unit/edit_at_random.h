// Many random edits on one tree: sound after each, undone and done again bit for bit, told alike by the log.
#pragma once

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "edit/delta.h"
#include "random_edit.h"

namespace treerec::test {

// How often each command did something.
using Tally = std::map<std::string, int>;

// `count` random edits on one tree; a tree that became too small is taken anew.
inline void edit_at_random(const Tree& start, uint64_t seed, int count, Tally& tally) {
    Random random(seed);
    Tree tree = start;
    Tree first = start;
    std::vector<TreeDelta> deltas;
    const auto undo_all = [&] {
        TreeDelta whole;
        bool any = false;
        for (const TreeDelta& delta : deltas) {
            whole = any ? TreeDelta::compose(whole, delta) : delta;
            any = true;
        }
        Tree other = tree;
        const Tree last = tree;
        for (size_t i = deltas.size(); i-- > 0;)
            deltas[i].revert(tree);
        ASSERT_TRUE(identical(tree, first)) << "step by step";
        if (!any) return;
        whole.revert(other);
        ASSERT_TRUE(identical(other, first)) << "in one step";
        whole.apply(other);
        ASSERT_TRUE(identical(other, last)) << "and on again";
        deltas.clear();
    };
    for (int done = 0; done < count;) {
        // Too little left, or too much: begin again.
        if (tree.size() < start.size() / 4 + 2 || tree.size() > 2 * start.size() + 200 ||
            deltas.size() >= 50) {
            undo_all();
            if (::testing::Test::HasFatalFailure()) return;
        }
        const std::vector<EditCommand>& all = edit_commands();
        const EditCommand& command = all[random.below(static_cast<uint32_t>(all.size()))];
        const std::string line = random_command(command, tree, random);
        const Tree before = tree;
        Edit edit;
        try {
            edit = perform(tree, line);
        } catch (const CommandError& error) {
            FAIL() << line << ": " << error.what();
        } catch (const Error&) {
            ASSERT_TRUE(identical(tree, before)) << line;
            tally[command.name] += 0;
            done++;
            continue;
        }
        done++;
        tally[command.name]++;
        ASSERT_EQ(tree.check(), std::nullopt) << line;
        ASSERT_FALSE(tree.empty()) << line;
        const Tree after = tree;
        edit.delta.revert(tree);
        ASSERT_TRUE(identical(tree, before)) << line;
        // What the log keeps does the same.
        Tree again = before;
        try {
            perform(again, edit.command);
        } catch (const Error& error) {
            FAIL() << line << " was kept as " << edit.command << ": " << error.what();
        }
        ASSERT_TRUE(identical(again, after)) << line << " was kept as " << edit.command;
        edit.delta.apply(tree);
        ASSERT_TRUE(identical(tree, after)) << line;
        deltas.push_back(std::move(edit.delta));
    }
    undo_all();
}

}  // namespace treerec::test
