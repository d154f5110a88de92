// The command that gives some wood leaves of its own.
#include "edit/commands/command_lists.h"
#include "edit/leaves_of.h"
#include "foliage/leaf_rule_text.h"

namespace treerec {

namespace {

EditOutcome run_leaves(Tree& tree, const EditArguments& given) {
    EditOutcome outcome;
    outcome.nodes = set_leaves_of(tree, given.nodes("where"), given.text("rule"));
    if (outcome.nodes.empty()) {
        outcome.said = "No leaves changed: there is no such wood, or it bears these already.";
        return outcome;
    }
    const std::string rule = plain_leaf_rule(given.text("rule"));
    const bool one = outcome.nodes.size() == 1;
    outcome.said = std::to_string(outcome.nodes.size());
    if (rule.empty())
        outcome.said +=
            one ? " node bears the tree's own leaves again." : " nodes bear the tree's own leaves again.";
    else
        outcome.said += (one ? " node bears leaves by the rule " : " nodes bear leaves by the rule ") +
                        quote_word(rule) + ".";
    return outcome;
}

}  // namespace

std::vector<EditCommand> leaf_commands() {
    return {
        {"leaves",
         "leaves",
         "Gives some wood leaves of its own kind.",
         {nodes_parameter("where", "", "the wood, by its nodes; one at an end stands for its whole twig"),
          text_parameter(
              "rule",
              {"oak", "pine", "maple leaf_size=0.2 droop=40", "droop=60 size_variation=0", "none", "default"},
              "a preset, changes of one as in 'oak droop=40', changes of the tree's own as in 'droop=40', or "
              "default")},
         run_leaves}};
}

}  // namespace treerec
