#include <algorithm>
#include <cmath>
#include <cstdio>

#include "cli/commands.h"
#include "cli/terminal_progress.h"
#include "edit/lighten/lighten.h"
#include "exchange/tree_files.h"
#include "fidelity/silhouette.h"
#include "mesh/branch_tubes.h"
#include "pipeline/export.h"

namespace treerec {

const Command& lighten_command() {
    static const Command command{
        "lighten",
        "lighten IN -o OUT [-o OUT...] [options]",
        "Leaves fewer nodes in a tree, the least visible ones first.",
        {{"-o", "OUT", "a file to write, as reconstruct does: .glb .gltf .obj .ply .txt .csv .mtg", true},
         {"--nodes", "N", "how many nodes to leave; or:"},
         {"--share", "S", "which share of them to leave, 0 to 1; or what these allow:"},
         {"--angle", "DEG", "a node goes where the wood turns by less (default 60)"},
         {"--distance", "M", "a twig goes that ends so near the wood beside it, in metres (default 0.1)"},
         {"--deviation", "M", "how far the bark may move, in metres (default 0.01)"},
         {"--merge", "",
          "the plain merging by angle and distance instead, which moves tips to their middles"},
         {"--pixels", "N", "of the pictures in which the outline is compared (default 1024)"},
         {"--up", "AXIS", "the axis to the sky of a skeleton that does not say: x y z -x -y -z (default z)"},
         {"--tree", "N", "which tree of a file with several, in its order (default: the largest)"},
         {"--dialect", "NAME", "of an L-string: turtle or paper (default: as it says itself, or turtle)"},
         {"--quiet", "", "print errors only"}},
        "IN: a skeleton (see 'treerec info'). Tells how much of the bark's outline, seen from four sides, "
        "differs."};
    return command;
}

void run_lighten(const std::vector<std::string>& words) {
    const Arguments arguments(lighten_command(), words);
    if (arguments.positional().size() != 1) throw UsageError("Name one skeleton.");
    if (!arguments.has("-o")) throw UsageError("Where to? Name a file with -o.");
    if (arguments.has("--nodes") && arguments.has("--share"))
        throw UsageError("Give --nodes or --share, not both.");
    if (arguments.has("--merge") &&
        (arguments.has("--nodes") || arguments.has("--share") || arguments.has("--deviation")))
        throw UsageError("--merge goes by --angle and --distance alone.");
    LightenOptions options;
    options.angle = arguments.number("--angle", options.angle, 0.0, 180.0);
    options.distance = arguments.number("--distance", options.distance, 0.0, 1e6);
    options.deviation = arguments.number("--deviation", options.deviation, 0.0, 1e6);
    options.nodes = arguments.whole("--nodes", 0, 2, uint64_t{1} << 24);
    const double share = arguments.number("--share", 0.0, 0.0, 1.0);
    const int pixels = static_cast<int>(arguments.whole("--pixels", 1024, 16, 4096));
    for (const std::string& out : arguments.all("-o"))
        require_writable_format(out);

    const bool quiet = arguments.has("--quiet");
    TerminalProgress progress(quiet);
    const Tree before =
        skeleton_from(arguments, arguments.positional()[0], "--tree", told_dialect_from(arguments));
    if (arguments.has("--share"))
        options.nodes =
            std::max<size_t>(2, static_cast<size_t>(std::lround(share * static_cast<double>(before.size()))));
    Tree tree = before;
    const Lightened result = arguments.has("--merge")
                                 ? merge_branches(tree, options.angle, options.distance, &progress)
                                 : lighten(tree, options, &progress);
    TreeExporter exporter(tree, {}, &progress);
    for (const std::string& out : arguments.all("-o"))
        exporter.write(out);
    if (quiet) return;
    const Mesh old_bark = build_branch_tubes(before, {}, &progress);
    const Mesh new_bark = build_branch_tubes(tree, {}, &progress);
    const SilhouetteView change = compare_silhouettes(old_bark, new_bark, pixels, &progress).all();
    progress.clear();
    std::printf("%zu nodes before, %zu after (1 in %.2f); %zu triangles of bark before, %zu after\n",
                result.before, result.after,
                static_cast<double>(result.before) / static_cast<double>(std::max<size_t>(result.after, 1)),
                old_bark.triangle_count(), new_bark.triangle_count());
    std::printf("bark moved by up to %.1f mm, tips by up to %.1f cm\n", 1000.0 * result.deviation,
                100.0 * result.tip_distance);
    std::printf("of the outline %.1f %% differ, of the picture %.2f %% (four sides, %d pixels)\n",
                100.0 * change.share_of_silhouette(), 100.0 * change.share_of_picture(), pixels);
    for (const std::string& out : arguments.all("-o"))
        std::printf("wrote %s\n", out.c_str());
}

}  // namespace treerec
