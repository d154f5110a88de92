// The command that puts an L-string in a branch's place.
#include "edit/commands/command_lists.h"
#include "edit/commands/string_options.h"
#include "edit/graft/scion.h"
#include "lsystem/lstring.h"

namespace treerec {

namespace {

EditOutcome run_lstring(Tree& tree, const EditArguments& given) {
    LStringOptions options = string_options(given);
    options.angle_spread = given.number("vary_angle");
    options.length_spread = given.number("vary_length");
    options.seed = static_cast<uint64_t>(given.whole("seed"));
    const Tree scion = read_lstring(given.text("string"), options, given.progress());
    require_scion(scion);

    // The branch begins at its joint, as take_scion() has it; at the root the tree stands as it is.
    const NodeId node = given.node("node");
    const bool whole = node == tree.root();
    const NodeId joint = whole ? node : tree.node(node).parent;
    const ScionPlacement placement{whole ? DMat3(1.0) : frame_about(direction_at(tree, joint)),
                                   given.number("unit")};
    const bool on_trunk = tree.node(node).is_trunk();
    const uint8_t leaf_rule = tree.node(node).leaf_rule;
    std::vector<NodeId> gone, before;
    for (NodeId child : tree.children(joint))
        if (whole || child == node)
            gone.push_back(child);
        else if (gone.empty())
            before.push_back(child);

    EditOutcome outcome;
    for (NodeId child : gone)
        remove_wood(tree, child, outcome.removed);
    outcome.nodes = place_scion(tree, joint, scion, placement);
    // In the place of what went: behind its elder siblings, before the younger ones.
    for (const NodeId added : outcome.nodes)
        if (tree.node(added).parent == joint) before.push_back(added);
    for (auto child = before.rbegin(); child != before.rend(); ++child)
        tree.make_first_child(*child);
    const std::vector<NodeId> order = scion.depth_first();
    for (const NodeId id : outcome.nodes)
        tree.set_leaf_rule(id, leaf_rule);
    for (size_t i = 1; i < order.size(); i++)
        if (on_trunk && scion.node(order[i]).is_trunk())
            tree.set_flag(outcome.nodes[i - 1], kTrunkFlag, true);
    if (whole) {
        tree.set_radius(joint, placement.scale * scion.node(scion.root()).radius);
        tree.set_flag(joint, kMeasuredRadiusFlag, false);
    }
    outcome.said = "The string's " + std::to_string(outcome.nodes.size()) +
                   (outcome.nodes.size() == 1 ? " node takes" : " nodes take") + " the place of " +
                   std::to_string(outcome.removed.nodes.size()) + ".";
    return outcome;
}

}  // namespace

std::vector<EditCommand> lstring_commands() {
    return {
        {"lstring",
         "graft",
         "Puts the branch that a string draws in the place of another.",
         {node_parameter("node", "the first node of the branch that goes; the root for the whole tree"),
          text_parameter("string",
                         {"F(0.3)[+(50)!(0.004)F(0.2)]F(0.3)", "!(0.02)&(20)F(0.4)[-(40)F(0.2)]^(10)F(0.3)"},
                         "the branch that comes, from the joint on, as an L-string"),
          dialect_parameter(),
          number_parameter("vary_angle", 0.0, 0.0, 90.0,
                           "degrees that every segment's yaw and pitch change by, at most, at random "
                           "(algorithm 6)")
              .slider(0.0, 30.0),
          number_parameter("vary_length", 0.0, 0.0, 0.9,
                           "share that every segment becomes longer or shorter by, at most, at random"),
          whole_parameter("seed", 1, 0, int64_t{1} << 53, "of what varies").slider(1, 100),
          length_parameter("unit", 1.0, 1e-6, 1e6, "metres of a length of 1 in the string").slider(0.1, 3.0)},
         run_lstring}};
}

}  // namespace treerec
