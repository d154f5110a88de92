// The commands that cut wood away.
#include <cmath>

#include "edit/commands/command_lists.h"
#include "edit/prune/prune.h"

namespace treerec {

namespace {

EditOutcome outcome_of(Removed removed) {
    EditOutcome outcome;
    outcome.said = removed.nodes.empty() ? "Nothing was cut away."
                                         : "Cut away " + std::to_string(removed.nodes.size()) +
                                               (removed.nodes.size() == 1 ? " node." : " nodes.");
    outcome.removed = std::move(removed);
    return outcome;
}

// Long twigs, and what the user points at.
std::vector<EditCommand> part_commands() {
    return {
        {"prune",
         "prune",
         "Cuts twigs that are longer than most to the mean length.",
         {number_parameter("factor", 1.0, 0.0, 1000.0, "times the mean: how long a twig may be")
              .slider(0.5, 5.0),
          word_parameter("by", {"nodes", "metres"}, "how the length of a twig is counted"),
          length_parameter("minimum_length", 0.0, 0.0, 1e6, "metres of every twig that stay in any case")
              .slider(0.0, 2.0),
          length_parameter("minimum_radius", NAN, 0.0, 1e6, "wood at least this thick stays, in metres")
              .slider(0.001, 0.1)
              .optional(),
          switch_parameter("spare_leader", true, "whether the trunk's own tip is left alone")},
         [](Tree& tree, const EditArguments& given) {
             PruneOptions options;
             options.factor = given.number("factor");
             options.in_metres = given.text("by") == "metres";
             options.minimum_length = given.number("minimum_length");
             if (given.has("minimum_radius")) options.minimum_radius = given.number("minimum_radius");
             options.spare_leader = given.on("spare_leader");
             return outcome_of(prune_twigs(tree, options));
         }},
        {"prune_below",
         "prune",
         "Cuts away all that grows above a node.",
         {node_parameter("node", "the node, which becomes a tip")},
         [](Tree& tree, const EditArguments& given) {
             EditOutcome outcome = outcome_of(prune_below(tree, given.node("node")));
             outcome.nodes = {given.node("node")};
             return outcome;
         }},
        {"cut",
         "prune",
         "Cuts a branch off below a node.",
         {node_parameter("node", "the node that goes, with all above it"),
          length_parameter("stub", 0.0, 0.0, 1e6, "metres of its segment that stay").slider(0.0, 0.5)},
         [](Tree& tree, const EditArguments& given) {
             const NodeId parent = tree.node(given.node("node")).parent;
             NodeId stump = kNoNode;
             EditOutcome outcome = outcome_of(cut(tree, given.node("node"), given.number("stub"), &stump));
             outcome.nodes = {stump != kNoNode ? stump : parent};
             return outcome;
         }},
        {"delete",
         "prune",
         "Takes out one node and joins its neighbours.",
         {node_parameter("node", "the node")},
         [](Tree& tree, const EditArguments& given) {
             const NodeId id = given.node("node");
             Removed removed;
             removed.nodes.push_back({id, tree.node(id)});
             if (tree.node(id).parent != kNoNode)
                 removed.add_piece(tree, 0, tree.node(tree.node(id).parent).position);
             delete_node(tree, id);
             return outcome_of(std::move(removed));
         }},
        {"remove",
         "prune",
         "Cuts away nodes and all that grows from them.",
         {nodes_parameter("nodes", "", "the nodes")},
         [](Tree& tree, const EditArguments& given) {
             return outcome_of(remove_wood(tree, given.nodes("nodes")));
         }},
        {"keep_only",
         "prune",
         "Cuts away all but some nodes and the wood that leads to them.",
         {nodes_parameter("nodes", "", "the nodes")},
         [](Tree& tree, const EditArguments& given) {
             return outcome_of(keep_only(tree, given.nodes("nodes")));
         }},
    };
}

// All wood that is alike.
std::vector<EditCommand> rule_commands() {
    return {
        {"prune_order",
         "prune",
         "Cuts away branches of an order and above.",
         {whole_parameter("order", 3, 1, 1000000, "the lowest that goes; the trunk is 0").slider(1, 8)},
         [](Tree& tree, const EditArguments& given) {
             return outcome_of(prune_by_order(tree, static_cast<int>(given.whole("order"))));
         }},
        {"prune_radius",
         "prune",
         "Cuts away wood that is thinner than a radius.",
         {length_parameter("radius", 0.005, 0.0, 1e6, "metres").slider(0.001, 0.05)},
         [](Tree& tree, const EditArguments& given) {
             return outcome_of(prune_by_radius(tree, given.number("radius")));
         }},
    };
}

// What lies in a part of space.
std::vector<EditCommand> region_commands() {
    return {
        {"prune_box",
         "prune",
         "Cuts away the wood inside a box.",
         {point_parameter("from", "one corner"), point_parameter("to", "the corner across"),
          switch_parameter("exact", true, "whether branches end right at the box")},
         [](Tree& tree, const EditArguments& given) {
             const Region box = Region::box(given.vector("from"), given.vector("to"));
             return outcome_of(prune_region(tree, box, given.on("exact")));
         }},
        {"prune_sphere",
         "prune",
         "Cuts away the wood inside a sphere.",
         {point_parameter("centre", "its centre"),
          length_parameter("radius", NAN, 1e-9, 1e6, "metres").slider(0.1, 3.0),
          switch_parameter("exact", true, "whether branches end right at the sphere")},
         [](Tree& tree, const EditArguments& given) {
             const Region sphere = Region::sphere(given.vector("centre"), given.number("radius"));
             return outcome_of(prune_region(tree, sphere, given.on("exact")));
         }},
        {"prune_side",
         "prune",
         "Cuts away the wood on one side of a plane.",
         {point_parameter("place", "a place on the plane"),
          direction_parameter("towards", "the side that goes, square to the plane"),
          switch_parameter("exact", true, "whether branches end right at the plane")},
         [](Tree& tree, const EditArguments& given) {
             const Region side = Region::side(given.vector("place"), given.vector("towards"));
             return outcome_of(prune_region(tree, side, given.on("exact")));
         }},
    };
}

}  // namespace

std::vector<EditCommand> prune_commands() {
    return joined({part_commands(), rule_commands(), region_commands()});
}

}  // namespace treerec
