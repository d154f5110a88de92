// All commands of the registry, whatever they are: undo, redo, text.
#include "edit/commands/commands.h"

#include <gtest/gtest.h>

#include <set>

#include "cases.h"
#include "edit_at_random.h"
#include "random_tree.h"

namespace treerec {
namespace {

using test::cases;
using test::edit_at_random;
using test::random_tree;
using test::Tally;
using test::wild_tree;

TEST(EditCommands, TenThousandRandomEditsKeepTheTreeSoundAndUndo) {
    Tally tally;
    int total = 0;
    for (uint64_t seed = 1; total < cases(10000); seed++) {
        const bool wild = seed % 3 == 0;
        const int nodes = static_cast<int>(2 + seed * 37 % 400);
        Tree tree = wild ? wild_tree(seed, nodes) : random_tree(seed, nodes);
        // Far from the origin, in centimetres, another axis up.
        if (seed % 2) tree.set_frame({{500000.125, 4000000.25, 90.5}, 0.01, UpAxis::kZ});
        edit_at_random(tree, seed, 100, tally);
        total += 100;
        if (HasFatalFailure()) FAIL() << "seed " << seed;
    }
    for (const EditCommand& command : edit_commands())
        EXPECT_GT(tally[command.name], cases(20)) << command.name << " hardly ever did anything";
}

TEST(EditCommands, DescribeThemselves) {
    std::set<std::string> names;
    for (const EditCommand& command : edit_commands()) {
        EXPECT_TRUE(names.insert(command.name).second) << command.name;
        EXPECT_FALSE(command.group.empty()) << command.name;
        EXPECT_TRUE(command.summary.ends_with('.')) << command.name;
        std::set<std::string> parameters;
        for (const Parameter& parameter : command.parameters) {
            const std::string where = command.name + " " + parameter.name;
            EXPECT_TRUE(parameters.insert(parameter.name).second) << where;
            EXPECT_FALSE(parameter.help.empty()) << where;
            EXPECT_FALSE(parameter.help.ends_with('.')) << where;
            EXPECT_FALSE(parameter.required && !parameter.standard.empty()) << where;
            if (parameter.type == ParameterType::kWord || parameter.type == ParameterType::kText) {
                EXPECT_FALSE(parameter.words.empty()) << where;
            }
            if (parameter.type == ParameterType::kNumber || parameter.type == ParameterType::kWhole ||
                parameter.type == ParameterType::kLength) {
                EXPECT_LT(parameter.from, parameter.to) << where;
                EXPECT_LE(parameter.least, parameter.from) << where;
                EXPECT_GE(parameter.most, parameter.to) << where;
            }
        }
    }
}

std::string error_of(const Tree& tree, const std::string& line) {
    Tree copy = tree;
    try {
        perform(copy, line);
    } catch (const CommandError& error) {
        EXPECT_TRUE(identical(copy, tree));
        return std::to_string(error.column()) + ": " + error.what();
    } catch (const Error& error) {
        EXPECT_TRUE(identical(copy, tree));
        return error.what();
    }
    return "";
}

TEST(EditCommands, SayWhatIsWrongAndWhere) {
    const Tree tree = random_tree(1, 50);
    EXPECT_EQ(error_of(tree, "  prun"),
              "3: There is no command 'prun'; there are: prune prune_below "
              "prune_order prune_radius prune_box prune_sphere prune_side.");
    EXPECT_EQ(error_of(tree, "xyz"), "1: There is no command 'xyz'.");
    EXPECT_EQ(error_of(tree, "prune factor"), "7: 'factor' is not of the form name=value.");
    EXPECT_EQ(error_of(tree, "prune factor=a"), "14: 'factor' must be a number from 0 to 1000, not 'a'.");
    EXPECT_EQ(error_of(tree, "prune factor=nan"), "14: 'factor' must be a number from 0 to 1000, not 'nan'.");
    EXPECT_EQ(error_of(tree, "prune factor=-1"), "14: 'factor' must be a number from 0 to 1000, not '-1'.");
    EXPECT_EQ(error_of(tree, "prune factor=1 factor=2"), "16: 'factor' is given twice.");
    EXPECT_EQ(error_of(tree, "prune by=weight"), "10: 'by' must be one of: nodes metres, not 'weight'.");
    EXPECT_EQ(error_of(tree, "prune spare_leader=1"), "20: 'spare_leader' must be yes or no, not '1'.");
    EXPECT_EQ(error_of(tree, "cut"), "1: 'cut' needs node=: the node that goes, with all above it.");
    EXPECT_EQ(error_of(tree, "cut node=1 at=0,0,0"), "12: Give either 'node' or 'at'.");
    EXPECT_EQ(error_of(tree, "cut node=1 depth=4"), "12: 'cut' takes no 'depth'; it takes node stub.");
    EXPECT_EQ(error_of(tree, "cut node=5000"), "There is no node 5000 in this tree.");
    EXPECT_EQ(error_of(tree, "cut node=x"), "10: 'x' names no node: write an id, 'root', or '@x:y:z'.");
    EXPECT_EQ(error_of(tree, "cut node=root"), "The root cannot be cut away: no tree would be left.");
    EXPECT_EQ(error_of(tree, "cut node=\"3"), "10: The quote that begins here does not end.");
    EXPECT_EQ(error_of(tree, "remove nodes=leaves&order:x"),
              "27: 'x' is no range: write 2, 1..3, 2.. or ..3.");
    EXPECT_EQ(error_of(tree, "remove nodes=leaves,wood:3").substr(0, 28), "21: There is no selection 'w");
    EXPECT_EQ(error_of(tree, "prune_side place=0,1,0 towards=0,0,0"),
              "32: 'towards' must be a direction, which is not zero, not '0,0,0'.");
    EXPECT_EQ(error_of(tree, "   # nothing"), "1: There is no command in this line.");
}

TEST(EditCommands, WordsAreQuotedAndReadBack) {
    Random random(3);
    const std::string alphabet = "ab\"#= \t\\[](),+";
    for (int round = 0; round < 5000; round++) {
        std::string value;
        for (uint32_t i = random.below(12); i > 0; i--)
            value += alphabet[random.below(static_cast<uint32_t>(alphabet.size()))];
        std::string line = "name";
        append_word(line, "first", value);
        append_word(line, "second", "2");
        const std::optional<CommandLine> read = parse_command_line(line + "  # the end");
        ASSERT_TRUE(read) << line;
        ASSERT_EQ(read->words.size(), 2U) << line;
        ASSERT_EQ(read->words[0].value, value) << line;
        ASSERT_EQ(read->words[1].value, "2") << line;
    }
}

}  // namespace
}  // namespace treerec
