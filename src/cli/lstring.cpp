#include <cmath>
#include <cstdio>

#include "cli/commands.h"
#include "cli/terminal_progress.h"
#include "edit/graft/scion.h"
#include "exchange/lstring_file.h"
#include "exchange/tree_files.h"
#include "file_bytes.h"

namespace treerec {

LStringDialect dialect_from(const Arguments& arguments) {
    try {
        return parse_lstring_dialect(arguments.text("--dialect", "turtle"));
    } catch (const Error& error) {
        throw UsageError(error.what());
    }
}

std::optional<LStringDialect> told_dialect_from(const Arguments& arguments) {
    if (!arguments.has("--dialect")) return std::nullopt;
    return dialect_from(arguments);
}

const Command& lstring_command() {
    static const Command command{
        "lstring",
        "lstring TREE [-o STRING] [options]",
        "Writes a tree, or a branch of it, as an L-string.",
        {{"-o", "FILE", "the file to write (.lstring); without it the string goes to the terminal"},
         {"--node", "N",
          "only what grows from node N, counted from 0 in the file's order, relative to the wood below it"},
         {"--dialect", "NAME", "turtle or paper (absolute yaw and pitch, no radii; default turtle)"},
         {"--accuracy", "A",
          "how far a node may lie off, relative to the length of its segment (default 0.00001)"},
         {"--no-flags", "", "without the marks of trunk, measured radii and guesses"},
         {"--up", "AXIS", "the axis to the sky of a tree file that does not say: x y z -x -y -z (default z)"},
         {"--tree", "N", "which tree of a file with several, in its order (default: the largest)"},
         {"--quiet", "", "print errors only"}},
        "TREE: a tree file (.txt), a skeleton (.ply), a table (.csv), an L-string. 'treerec grow STRING -o "
        "OUT' makes the tree again, in its own coordinates."};
    return command;
}

void run_lstring(const std::vector<std::string>& words) {
    const Arguments arguments(lstring_command(), words);
    const std::vector<std::string>& positional = arguments.positional();
    if (positional.empty()) throw UsageError("Which tree? Name a tree file.");
    if (positional.size() > 1)
        throw UsageError("'" + positional[1] + "' is too much; name the file to write with -o.");
    const std::string out = arguments.text("-o", "");
    LStringOptions options;
    options.dialect = dialect_from(arguments);
    options.accuracy = arguments.number("--accuracy", options.accuracy, 1e-12, 0.1);
    options.radius_accuracy = std::min(10.0 * options.accuracy, 0.1);
    options.flags = !arguments.has("--no-flags");
    if (!out.empty()) require_writable(out);

    const bool quiet = arguments.has("--quiet") || out.empty();
    TerminalProgress progress(quiet);
    Tree tree = skeleton_from(arguments, positional[0]);
    if (arguments.has("--node")) {
        const uint64_t node = arguments.whole("--node", 0, 0, kLargestId);
        tree = take_scion(tree, static_cast<NodeId>(node));
    }
    if (out.empty()) {
        LStringOptions told;
        told.dialect = options.dialect;
        std::printf("%s%s\n", heading(told).c_str(),
                    write_lstring(tree, tree.root(), options, &progress).c_str());
        return;
    }
    write_lstring_file(out, tree, options, &progress);
    progress.clear();
    if (!quiet) std::printf("wrote %s (%zu nodes)\n", out.c_str(), tree.size());
}

}  // namespace treerec
