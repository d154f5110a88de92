// The commands that change the shape of wood.
#include <cmath>

#include "edit/commands/command_lists.h"
#include "edit/move.h"
#include "edit/smooth.h"
#include "edit/vary/sag.h"
#include "tree/trunk.h"

namespace treerec {

namespace {

EditOutcome outcome_of(std::vector<NodeId> nodes, const char* verb) {
    EditOutcome outcome;
    outcome.said =
        std::string(verb) + " " + std::to_string(nodes.size()) + (nodes.size() == 1 ? " node." : " nodes.");
    outcome.nodes = std::move(nodes);
    return outcome;
}

Parameter strength_parameter() {
    return number_parameter("strength", 0.5, 0.0, 1.0,
                            "how far a node goes towards its neighbours each time");
}

Parameter rounds_parameter() {
    return whole_parameter("rounds", 5, 0, 1000, "how many times").slider(1, 50);
}

SmoothOptions smooth_options(const EditArguments& given) {
    return {given.number("strength"), static_cast<int>(given.whole("rounds"))};
}

std::vector<EditCommand> smooth_commands() {
    return {
        {"smooth_radii",
         "smooth",
         "Evens out how thick branches are along their way.",
         {nodes_parameter("nodes", "all", "where"), strength_parameter(), rounds_parameter(),
          switch_parameter("keep_measured", false, "whether radii fitted to the scan stay"),
          switch_parameter("taper", true, "whether nothing may be thicker than what it grows from")},
         [](Tree& tree, const EditArguments& given) {
             return outcome_of(smooth_radii(tree, given.nodes("nodes"), smooth_options(given),
                                            given.on("keep_measured"), given.on("taper")),
                               "Smoothed");
         }},
        {"smooth_paths",
         "smooth",
         "Evens out the way branches run; tips and forks stay.",
         {nodes_parameter("nodes", "all", "where"), strength_parameter(), rounds_parameter()},
         [](Tree& tree, const EditArguments& given) {
             return outcome_of(smooth_paths(tree, given.nodes("nodes"), smooth_options(given)), "Smoothed");
         }},
        {"relax",
         "smooth",
         "Takes kinks out of branches.",
         {nodes_parameter("nodes", "all", "where"),
          number_parameter("angle", 40.0, 0.001, 179.999, "degrees that a branch may turn at a node")
              .slider(5.0, 90.0),
          rounds_parameter()},
         [](Tree& tree, const EditArguments& given) {
             return outcome_of(relax_kinks(tree, given.nodes("nodes"), given.number("angle"),
                                           static_cast<int>(given.whole("rounds"))),
                               "Moved");
         }},
        {"subdivide",
         "smooth",
         "Puts nodes into long segments.",
         {nodes_parameter("nodes", "all", "the nodes that the segments end in"),
          length_parameter("length", 0.1, 1e-6, 1e6, "metres that a segment may be long").slider(0.05, 1.0),
          switch_parameter("curved", true, "whether they lie on a curve")},
         [](Tree& tree, const EditArguments& given) {
             return outcome_of(
                 subdivide(tree, given.nodes("nodes"), given.number("length"), given.on("curved")), "Added");
         }},
        {"insert",
         "smooth",
         "Puts a node into a segment.",
         {node_parameter("node", "the node that the segment ends in"),
          number_parameter("share", 0.5, 0.001, 0.999, "where, from 0 at its beginning to 1 at the node")},
         [](Tree& tree, const EditArguments& given) {
             return outcome_of({insert_node(tree, given.node("node"), given.number("share"))}, "Added");
         }},
        {"straighten",
         "smooth",
         "Makes a branch straight.",
         {node_parameter("node", "a node of the branch"),
          number_parameter("strength", 1.0, 0.0, 1.0, "how straight: 0 as it is, 1 wholly")},
         [](Tree& tree, const EditArguments& given) {
             return outcome_of(straighten(tree, given.node("node"), given.number("strength")), "Moved");
         }},
    };
}

// Wood that goes elsewhere, as it is.
std::vector<EditCommand> move_commands() {
    return {
        {"move",
         "shape",
         "Moves nodes by an offset.",
         {nodes_parameter("nodes", "", "the nodes"), offset_parameter("by", "how far, in metres"),
          word_parameter("with", {"subtree", "alone"}, "whether what grows from them goes too"),
          length_parameter("falloff", 0.0, 0.0, 1e6, "metres along the wood over which the rest follows")
              .slider(0.0, 3.0)},
         [](Tree& tree, const EditArguments& given) {
             const MoveOptions options{given.text("with") == "subtree", given.number("falloff")};
             EditOutcome outcome =
                 outcome_of(move_nodes(tree, given.nodes("nodes"), given.vector("by"), options), "Moved");
             outcome.nodes = given.nodes("nodes");
             return outcome;
         }},
        {"turn",
         "shape",
         "Turns a branch about its joint.",
         {node_parameter("node", "the branch's first node, or the root for the whole tree"),
          direction_parameter("axis", "what it turns about"),
          number_parameter("angle", NAN, -36000.0, 36000.0, "degrees, counter-clockwise against the axis")
              .slider(-180.0, 180.0)},
         [](Tree& tree, const EditArguments& given) {
             EditOutcome outcome = outcome_of(
                 turn_branch(tree, given.node("node"), given.vector("axis"), given.number("angle")),
                 "Turned");
             outcome.nodes = {given.node("node")};
             return outcome;
         }},
        {"scale",
         "shape",
         "Makes a branch larger or smaller, from its joint on.",
         {node_parameter("node", "the branch's first node, or the root for the whole tree"),
          number_parameter("factor", NAN, 0.001, 1000.0, "times as long").slider(0.5, 2.0),
          number_parameter("thickness", NAN, 0.001, 1000.0, "times as thick; as factor if not given")
              .slider(0.5, 2.0)
              .optional()},
         [](Tree& tree, const EditArguments& given) {
             const double factor = given.number("factor");
             const double thickness = given.has("thickness") ? given.number("thickness") : factor;
             EditOutcome outcome =
                 outcome_of(scale_branch(tree, given.node("node"), factor, thickness), "Scaled");
             outcome.nodes = {given.node("node")};
             return outcome;
         }},
        {"mirror",
         "shape",
         "Mirrors a branch in a plane through its joint.",
         {node_parameter("node", "the branch's first node, or the root for the whole tree"),
          direction_parameter("normal", "the direction that is turned round")},
         [](Tree& tree, const EditArguments& given) {
             EditOutcome outcome =
                 outcome_of(mirror_branch(tree, given.node("node"), given.vector("normal")), "Mirrored");
             outcome.nodes = {given.node("node")};
             return outcome;
         }},
    };
}

// Wood that is added, hung elsewhere or bent by its weight.
std::vector<EditCommand> wood_commands() {
    return {
        {"grow",
         "shape",
         "Grows new wood on a node.",
         {node_parameter("node", "the node"),
          direction_parameter("direction", "where to; if not given, on at a tip and else to a free side")
              .optional(),
          length_parameter("length", 0.0, 0.0, 1e6, "metres; 0: as the segment below").slider(0.05, 2.0),
          length_parameter("radius", 0.0, 0.0, 1e6, "metres; 0: a little less than the node's")
              .slider(0.001, 0.1),
          whole_parameter("count", 1, 1, 1000, "the nodes that share the length").slider(1, 10)},
         [](Tree& tree, const EditArguments& given) {
             GrowNodeOptions options;
             if (given.has("direction")) options.direction = given.vector("direction");
             options.length = given.number("length");
             options.radius = given.number("radius");
             options.nodes = static_cast<int>(given.whole("count"));
             EditOutcome outcome = outcome_of(grow_node(tree, given.node("node"), options), "Grew");
             outcome.nodes = {outcome.nodes.back()};
             return outcome;
         }},
        {"attach",
         "shape",
         "Hangs a branch on another node.",
         {node_parameter("node", "the branch's first node"),
          node_parameter("to", "the node that it shall hang on"),
          switch_parameter("bring", false, "whether the branch moves there as a whole")},
         [](Tree& tree, const EditArguments& given) {
             EditOutcome outcome = outcome_of(
                 attach_branch(tree, given.node("node"), given.node("to"), given.on("bring")), "Moved");
             outcome.nodes = {given.node("node")};
             return outcome;
         }},
        {"sag",
         "shape",
         "Bends branches under their weight; thin ones bend most.",
         {nodes_parameter("nodes", "all", "where they may bend"),
          number_parameter("weight", 1.0, -1e6, 1e6, "times their own weight; less than 0 lifts them")
              .slider(-3.0, 10.0),
          number_parameter("load", 0.0, 0.0, 1e6, "kg on each metre of wood: leaves, fruit, snow")
              .slider(0.0, 1.0),
          number_parameter("density", 900.0, 1.0, 1e5, "kg in a cubic metre of wood").slider(300.0, 1300.0),
          number_parameter("stiffness", 8.0, 0.001, 1000.0, "of the wood, in GPa").slider(2.0, 20.0)},
         [](Tree& tree, const EditArguments& given) {
             SagOptions options;
             options.weight = given.number("weight");
             options.load = given.number("load");
             options.density = given.number("density");
             options.stiffness = given.number("stiffness") * 1e9;
             return outcome_of(sag(tree, given.nodes("nodes"), options), "Bent");
         }},
    };
}

// How thick wood is, and what of it is trunk.
std::vector<EditCommand> radius_commands() {
    return {
        {"thicken",
         "shape",
         "Makes wood thicker or thinner by a factor.",
         {nodes_parameter("nodes", "all", "where"),
          number_parameter("factor", NAN, 0.001, 1000.0, "times as thick").slider(0.5, 2.0)},
         [](Tree& tree, const EditArguments& given) {
             return outcome_of(scale_radii(tree, given.nodes("nodes"), given.number("factor")), "Changed");
         }},
        {"set_radius",
         "shape",
         "Gives wood a radius.",
         {nodes_parameter("nodes", "", "where"),
          length_parameter("radius", NAN, 1e-6, 1e6, "metres").slider(0.001, 0.3)},
         [](Tree& tree, const EditArguments& given) {
             return outcome_of(set_radii(tree, given.nodes("nodes"), given.number("radius")), "Changed");
         }},
        {"mark_trunk",
         "shape",
         "Finds anew which nodes are trunk.",
         {number_parameter("ratio", 0.8, 0.0, 1.0, "how thick, beside the thickest, a second stem must be"),
          number_parameter("angle", 30.0, 0.0, 180.0, "degrees between them at most")},
         [](Tree& tree, const EditArguments& given) {
             mark_trunk(tree, {given.number("ratio"), given.number("angle")});
             return EditOutcome{{}, {}, "Marked the trunk anew."};
         }},
    };
}

}  // namespace

std::vector<EditCommand> shape_commands() {
    return joined({move_commands(), wood_commands(), radius_commands(), smooth_commands()});
}

}  // namespace treerec
