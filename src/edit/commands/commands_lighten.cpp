// The commands that leave fewer nodes.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "edit/commands/address.h"
#include "edit/commands/command_lists.h"
#include "edit/lighten/lighten.h"

namespace treerec {

namespace {

std::string number_text(double value, const char* format) {
    char text[64];
    std::snprintf(text, sizeof text, format, value);
    return text;
}

// before: the tree as it was.
EditOutcome outcome_of(const Tree& before, const Lightened& lightened) {
    EditOutcome outcome;
    outcome.nodes = lightened.changed;
    for (NodeId id : lightened.removed) {
        const size_t at = outcome.removed.nodes.size();
        outcome.removed.nodes.push_back({id, before.node(id)});
        outcome.removed.add_piece(before, at, before.node(before.node(id).parent).position);
    }
    outcome.said = std::to_string(lightened.after) + " of " + std::to_string(lightened.before) +
                   " nodes are left; bark moved by up to " +
                   number_text(1000.0 * lightened.deviation, "%.1f mm") + ", tips by up to " +
                   number_text(100.0 * lightened.tip_distance, "%.1f cm") + ".";
    return outcome;
}

EditOutcome run_lighten(Tree& tree, const EditArguments& given) {
    LightenOptions options;
    options.angle = given.number("angle");
    options.distance = given.number("distance");
    options.deviation = given.number("deviation");
    if (given.has("nodes") && given.has("share"))
        throw Error("Give the number of nodes or their share, not both.");
    if (given.has("nodes")) options.nodes = static_cast<size_t>(given.whole("nodes"));
    if (given.has("below")) options.below = given.node("below");
    if (given.has("share")) {
        const size_t there = options.below == kNoNode ? tree.size() : tree.depth_first(options.below).size();
        options.nodes = std::max<size_t>(
            2, static_cast<size_t>(std::lround(given.number("share") * static_cast<double>(there))));
    }
    const Tree before = tree;
    return outcome_of(before, lighten(tree, options, given.progress()));
}

EditOutcome run_merge(Tree& tree, const EditArguments& given) {
    const Tree before = tree;
    const NodeId below = given.has("below") ? given.node("below") : kNoNode;
    return outcome_of(before, merge_branches(tree, given.number("angle"), given.number("distance"),
                                             given.progress(), below));
}

}  // namespace

std::vector<EditCommand> lighten_commands() {
    const LightenOptions standard;
    Parameter nodes = whole_parameter("nodes", 2, 2, int64_t{1} << 24,
                                      "how many nodes to leave, whatever angle, distance and deviation say")
                          .slider(2, 5000);
    nodes.standard.clear();
    const Parameter below =
        node_parameter("below", "only what grows from this node becomes lighter").optional();
    return {
        {"lighten",
         "lighten",
         "Leaves fewer nodes, the least visible ones first.",
         {number_parameter("angle", standard.angle, 0.0, 180.0,
                           "degrees; a node goes where the wood turns by less")
              .slider(0.0, 90.0),
          length_parameter("distance", standard.distance, 0.0, 1e6,
                           "metres; a twig goes that ends so near the wood beside it")
              .slider(0.0, 1.0),
          length_parameter("deviation", standard.deviation, 0.0, 1e6, "metres that the bark may move")
              .slider(0.0, 0.2),
          nodes,
          number_parameter("share", NAN, 0.0, 1.0, "the same as a share of the nodes that there are")
              .optional(),
          below},
         run_lighten},
        {"merge",
         "lighten",
         "Joins wood that hardly turns and tips that lie side by side into their middle, wherever that "
         "leads.",
         {number_parameter("angle", 15.0, 0.0, 180.0, "degrees; a node goes where the wood turns by less")
              .slider(0.0, 90.0),
          length_parameter("distance", 0.05, 0.0, 1e6, "metres; two tips of one fork so near become one")
              .slider(0.0, 1.0),
          below},
         run_merge},
    };
}

}  // namespace treerec
