// The commands that add wood: twigs and grafts.
#include <algorithm>
#include <cmath>
#include <string>

#include "edit/commands/command_lists.h"
#include "edit/commands/string_options.h"
#include "edit/graft/graft.h"
#include "edit/graft/scion.h"
#include "edit/graft/twig.h"
#include "edit/graft/twig_library.h"
#include "lsystem/lstring.h"

namespace treerec {

namespace {

const std::vector<std::string> kAims = {"auto", "onward", "own", "lean", "direction"};
const std::vector<std::string> kScales = {"auto", "radius", "fit", "length", "factor"};

template <typename Enum>
Enum choice(const std::vector<std::string>& words, const std::string& word) {
    const auto at = std::find(words.begin(), words.end(), word);
    return static_cast<Enum>(at - words.begin());
}

std::vector<std::string> twig_names() {
    std::vector<std::string> names{"generic"};
    for (const LibraryTwig& twig : twig_library())
        if (twig.name != "generic") names.emplace_back(twig.name);
    return names;
}

Tree read_scion(std::string_view string, const LStringOptions& options, const Progress* progress) {
    Tree scion = read_lstring(string, options, progress);
    require_scion(scion);
    return scion;
}

// What graft and graft_many have in common.
std::vector<Parameter> graft_parameters() {
    return {
        text_parameter("string", {"F(0.3)[+(50)!(0.004)F(0.2)]F(0.3)"},
                       "the branch as an L-string, instead of one of the library's")
            .optional(),
        dialect_parameter(),
        whole_parameter("seed", 1, 0, int64_t{1} << 53, "of what varies").slider(1, 100),
        number_parameter("angle", 12.0, 0.0, 180.0,
                         "degrees that its branches turn and bend by, at most, at random")
            .slider(0.0, 45.0),
        number_parameter("stretch", 0.15, 0.0, 0.9,
                         "share that its branches become longer or shorter by, at most, at random"),
        word_parameter("vary", {"branches", "segments"},
                       "what varies: branches, which bend and stretch as a whole; or every segment by itself "
                       "(algorithm 6)"),
        word_parameter("aim", kAims,
                       "where it goes: auto: on from a tip, else off to a side; onward: the host's way; "
                       "own: by the angle it grew at; lean: into the widest gap; direction: as told"),
        number_parameter("lean", 45.0, 0.0, 180.0, "degrees off the host's way, for aim=lean"),
        direction_parameter("direction", "where it goes, for aim=direction").optional(),
        number_parameter("roll", 0.0, -360.0, 360.0, "degrees that it is turned about the way it goes"),
        switch_parameter("mirror", false, "whether its left and right change sides"),
        word_parameter("scale", kScales,
                       "its size: auto: a tip's thickness, else made to fit; radius: as thick as the joint "
                       "allows; fit: no thicker than that; length or factor: as told"),
        length_parameter("length", 1.0, 1e-6, 1e6, "metres of its longest way, for scale=length")
            .slider(0.1, 3.0),
        number_parameter("factor", 1.0, 1e-6, 1e6, "of its size, for scale=factor").slider(0.2, 3.0),
        number_parameter("joint_ratio", 0.0, 0.0, 1.0,
                         "its radius at the joint over the host's, at most; 0 for what suits"),
        switch_parameter("smooth", true, "whether its radii are blended into the host's"),
        number_parameter(
            "thinning", 0.0, 0.0, 1.0,
            "each node's radius over the one before it, down from the host's (algorithm 8: 0.8); "
            "0 for radii of its own"),
        length_parameter("clearance", 0.0, 0.0, 1e3, "metres of air to keep from other branches")
            .slider(0.0, 0.1),
        whole_parameter("tries", 1, 1, 1000, "seeds to try until it is clear of other branches")
            .slider(1, 30),
    };
}

GraftOptions graft_options(const EditArguments& given) {
    GraftOptions options;
    options.seed = static_cast<uint64_t>(given.whole("seed"));
    options.variation = {given.number("angle"), given.number("stretch"), given.text("vary") == "segments"};
    options.aim = choice<GraftAim>(kAims, given.text("aim"));
    options.lean = given.number("lean");
    if (given.has("direction")) options.direction = given.vector("direction");
    if (options.aim == GraftAim::kDirection && !given.has("direction"))
        throw Error("With aim=direction a graft needs direction=x,y,z.");
    options.roll = given.number("roll");
    options.mirror = given.on("mirror");
    options.scale = choice<GraftScale>(kScales, given.text("scale"));
    options.length = given.number("length");
    options.factor = given.number("factor");
    options.joint_ratio = given.number("joint_ratio");
    options.smooth = given.on("smooth");
    options.thinning = given.number("thinning");
    options.most_nodes = static_cast<size_t>(given.whole("most"));
    options.clearance = given.number("clearance");
    options.tries = static_cast<int>(given.whole("tries"));
    return options;
}

std::string count_of(size_t count, const char* one, const char* many) {
    return std::to_string(count) + " " + (count == 1 ? one : many);
}

EditOutcome outcome_of(const std::vector<GraftResult>& results) {
    EditOutcome outcome;
    if (results.empty()) {
        outcome.said = "Nothing was grafted: no node was chosen.";
        return outcome;
    }
    size_t collisions = 0;
    for (const GraftResult& result : results) {
        outcome.nodes.insert(outcome.nodes.end(), result.added.begin(), result.added.end());
        collisions += result.collisions.size();
    }
    outcome.said = "Grafted " + count_of(results.size(), "branch", "branches") + " of " +
                   count_of(outcome.nodes.size(), "node", "nodes") + " in all, " +
                   (collisions == 0 ? "clear of other branches."
                                    : "with " + count_of(collisions, "collision", "collisions") +
                                          " with other branches.");
    return outcome;
}

EditOutcome run_twig(Tree& tree, const EditArguments& given) {
    TwigOptions options;
    options.side = given.text("side") == "left" ? TwigSide::kLeft : TwigSide::kRight;
    if (given.has("direction")) options.direction = given.vector("direction");
    if (given.has("view")) options.view = given.vector("view");
    if (given.has("up")) options.up = given.vector("up");
    options.as_printed = given.text("size") == "paper";
    options.length = given.number("length");
    options.radius = given.number("radius");
    EditOutcome outcome;
    outcome.nodes = {make_twig(tree, given.node("node"), options)};
    const size_t collisions = find_collisions(tree, outcome.nodes[0], 0.0, given.progress()).size();
    if (collisions > 0)
        outcome.said = "The twig runs into " +
                       count_of(collisions, "segment of another branch.", "segments of other branches.");
    return outcome;
}

EditOutcome run_graft(Tree& tree, const EditArguments& given) {
    Tree scion;
    if (given.has("from"))
        scion = take_scion(tree, given.node("from"));
    else if (given.has("string"))
        scion = read_scion(given.text("string"), string_options(given), given.progress());
    else
        scion = read_scion(find_library_twig(given.text("twig")).string, {}, given.progress());
    return outcome_of({graft(tree, given.node("node"), scion, graft_options(given), given.progress())});
}

EditOutcome run_graft_many(Tree& tree, const EditArguments& given) {
    std::vector<Tree> scions;
    if (given.has("from")) {
        for (NodeId id : given.nodes("from"))
            scions.push_back(take_scion(tree, id));
    } else if (given.has("string")) {
        scions.push_back(read_scion(given.text("string"), string_options(given), given.progress()));
    } else {
        for (std::string_view name : split(given.text("twigs"), ','))
            scions.push_back(read_scion(find_library_twig(name).string, {}, given.progress()));
    }
    const std::vector<NodeId>& hosts = given.nodes("nodes");
    const GraftOptions options = graft_options(given);
    return outcome_of(graft_many(tree, hosts, scions, options, given.progress()));
}

std::vector<Parameter> joined(std::vector<Parameter> first, const std::vector<Parameter>& second) {
    first.insert(first.end(), second.begin(), second.end());
    return first;
}

}  // namespace

std::vector<EditCommand> graft_commands() {
    Parameter twigs = text_parameter("twigs", {"generic", "maple", "oak,dead"},
                                     "branches of the library, by name, one or several drawn from");
    twigs.standard = "generic";
    twigs.required = false;
    return {
        {"twig",
         "graft",
         "Adds a short side branch to a node, to graft onto.",
         {node_parameter("node", "the node that gets it"),
          word_parameter("side", {"right", "left"}, "to which side of the view it goes"),
          direction_parameter("view", "the way that the eye looks; 0,0,-1 where it is not given").optional(),
          direction_parameter("up", "what is up in the view; 0,1,0 where it is not given").optional(),
          direction_parameter("direction", "where it goes, instead of to a side").optional(),
          length_parameter("length", 0.0, 0.0, 1e6, "metres; 0 for what suits its host").slider(0.0, 1.0),
          length_parameter("radius", 0.0, 0.0, 1e6, "metres; 0 for what suits its host").slider(0.0, 0.05),
          word_parameter("size", {"suited", "paper"},
                         "where length or radius is 0: what suits its host; or 0.6 of the next segment and "
                         "0.8 of the host's radius, as algorithm 5 says")},
         run_twig},
        {"graft", "graft",
         "Puts a branch onto a node: one of the library, an L-string, or a copy of another one of this tree.",
         joined({node_parameter("node", "the node that gets it"),
                 word_parameter("twig", twig_names(), "a branch of the library"),
                 node_parameter("from", "the lowest node of a branch to copy, instead").optional(),
                 whole_parameter("most", 1000000, 1, kLargestId, "nodes that it may add").slider(100, 10000)},
                graft_parameters()),
         run_graft},
        {"graft_many", "graft", "Puts a branch onto each of many nodes, no two alike.",
         joined({nodes_parameter("nodes", "", "the nodes that get one"), twigs,
                 nodes_parameter("from", "", "the lowest nodes of branches to copy, instead").optional(),
                 whole_parameter("most", 50000, 1, kLargestId, "nodes that it may add in all")
                     .slider(100, 10000)},
                graft_parameters()),
         run_graft_many},
    };
}

}  // namespace treerec
