// The command that puts an L-string in a branch's place.
#include "edit/command_lists.h"
#include "edit/scion.h"
#include "lsystem/lstring.h"

namespace treerec {

namespace {

EditOutcome run_lstring(Tree& tree, const EditArguments& given) {
    LStringOptions options;
    options.dialect = parse_lstring_dialect(given.text("dialect"));
    const Tree scion = read_lstring(given.text("string"), options, given.progress());
    require_scion(scion);

    // The branch begins at its joint, as take_scion() has it; at the root the tree stands as it is.
    const NodeId node = given.node("node");
    const bool whole = node == tree.root();
    const NodeId joint = whole ? node : tree.node(node).parent;
    const ScionPlacement placement{whole ? DMat3(1.0) : frame_about(direction_at(tree, joint)),
                                   given.number("unit")};
    const bool on_trunk = tree.node(node).is_trunk();
    std::vector<NodeId> gone, behind;
    for (NodeId child : tree.children(joint))
        if (whole || child == node)
            gone.push_back(child);
        else if (!gone.empty())
            behind.push_back(child);

    EditOutcome outcome;
    for (NodeId child : gone)
        remove_wood(tree, child, outcome.removed);
    outcome.nodes = place_scion(tree, joint, scion, placement);
    for (NodeId sibling : behind)
        tree.reparent(sibling, joint);
    const std::vector<NodeId> order = scion.depth_first();
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
          word_parameter("dialect", {"turtle", "paper"}, "the string's; paper: absolute yaw and pitch"),
          length_parameter("unit", 1.0, 1e-6, 1e6, "metres of a length of 1 in the string").slider(0.1, 3.0)},
         run_lstring}};
}

}  // namespace treerec
