#include <cmath>
#include <cstdio>

#include "cli/commands.h"
#include "cli/reconstruct_options.h"
#include "cli/terminal_progress.h"
#include "file_bytes.h"
#include "geometry/parallel.h"
#include "pipeline/split_plot.h"

namespace treerec {

const Command& split_command() {
    static const Command command{
        "split",
        "split PLOT OUT_FOLDER [options]",
        "Cuts the scan of a plot into trees, and finds its ground.",
        {{"--tile", "M", "edge of the tiles in which the plot is looked at, in metres (default 40)"},
         {"--overlap", "M", "how far each tile looks beyond its edges (default: by the trees' height)"},
         {"--least-height", "M", "lower trees are left out (default 2)"},
         {"--ground-pixel", "M", "of ground.exr, in metres (default 0.5)"},
         {"--up", "AXIS", "the scan's axis to the sky: auto x y z -x -y -z (default auto)"},
         {"--scale", "S", "metres per unit of the scan (default: found out)"},
         {"--columns", "LIST", "names of a text file's columns, such as x,y,z,r,g,b; - skips one"},
         {"--classes", "LIST",
          "classes of LAS points to read, such as 2,4-5, or all (default: all but noise, 7 and 18)"},
         {"--threads", "N", "how many to use (default: all cores); changes nothing else"},
         {"--quiet", "", "print errors and warnings only"}},
        "OUT_FOLDER gets tree_0001.ply … (where they stood in the scan; for 'treerec reconstruct "
        "--one-tree'),\n"
        "trees.csv (place, height, diameter at breast height, warnings), ground.exr (heights of the ground "
        "in\n"
        "metres, as floats) and plot.json (where that lies). A tree belongs to the tile in which its stem\n"
        "stands. Memory holds one tile; of files other than LAS also the places of all points."};
    return command;
}

void run_split(const std::vector<std::string>& words) {
    const Arguments arguments(split_command(), words);
    const std::vector<std::string>& names = arguments.positional();
    if (names.size() != 2) throw UsageError("Name the scan of a plot and the folder to write to.");
    SplitOptions options;
    options.read = read_options_from(arguments);
    if (arguments.text("--up", "auto") != "auto") options.orient.up = up_axis_from(arguments);
    if (arguments.has("--scale"))
        options.orient.metres_per_unit = arguments.number("--scale", 1.0, 1e-9, 1e9);
    options.tile = arguments.number("--tile", options.tile, 2.0, 1e5);
    options.overlap = arguments.number("--overlap", options.overlap, 0.5, 1e4);
    options.least_height = arguments.number("--least-height", options.least_height, 0.3, 100.0);
    options.pixel = arguments.number("--ground-pixel", options.pixel, 0.05, 100.0);
    set_thread_count(static_cast<int>(arguments.whole("--threads", 0, 1, 1024)));
    std::string folder = names[1];
    while (folder.size() > 1 && folder.back() == '/')
        folder.pop_back();
    as_usage([&] { require_split_folder(folder); });

    const bool quiet = arguments.has("--quiet");
    TerminalProgress progress(quiet);
    const SplitReport report = split_plot(names[0], folder, options, &progress);
    progress.clear();
    for (const std::string& warning : report.warnings)
        std::fprintf(stderr, "Warning: %s\n", warning.c_str());
    if (quiet) return;
    size_t doubted = 0;
    for (const SplitTree& tree : report.trees)
        doubted += !tree.tree.warnings.empty();
    std::printf("%zu trees of %zu points, in %zu tile%s with %.1f m around each; %zu with a warning\n",
                report.trees.size(), report.points, report.tiles, report.tiles == 1 ? "" : "s",
                report.overlap, doubted);
    std::printf("wrote %s: the trees' clouds, trees.csv, plot.json%s\n", folder.c_str(),
                report.ground ? ", ground.exr" : "");
}

}  // namespace treerec
