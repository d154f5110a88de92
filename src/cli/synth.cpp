#include <cstdio>
#include <filesystem>

#include "cli/commands.h"
#include "cli/terminal_progress.h"
#include "exchange/tree_files.h"
#include "file_bytes.h"
#include "scan/formats/read_cloud.h"
#include "synth/grow.h"
#include "synth/scan.h"
#include "tree/measure.h"

namespace treerec {

const Command& synth_command() {
    static const Command command{
        "synth",
        "synth -o DIR --seed N [options]",
        "Grows a tree, scans it virtually, and writes scan.ply and truth.txt.",
        {{"-o", "DIR", "the folder to write to; it is made"},
         {"--seed", "N", "the tree and everything random about it (default 1)"},
         {"--habit", "NAME",
          "broadleaf conifer birch forked leaning shrub buttressed palm (default broadleaf)"},
         {"--height", "M", "metres (default: the habit's, by the seed)"},
         {"--points", "N", "of the cloud (default 40000)"},
         {"--noise", "S", "standard deviation of the range in metres (default 0.003)"},
         {"--occlusion", "F", "share of each station's view that is hidden, 0 to 0.95 (default 0)"},
         {"--leaves", "F", "0 a winter tree to 1 full foliage (default 0)"},
         {"--stations", "N", "scanner positions around the tree (default 5)"},
         {"--quiet", "", "print errors only"}},
        "scan.ply: Z up, metres, with colours. truth.txt: the tree itself as a tree file, for 'treerec "
        "score'."};
    return command;
}

void run_synth(const std::vector<std::string>& words) {
    const Arguments arguments(synth_command(), words);
    if (!arguments.positional().empty())
        throw UsageError("'" + arguments.positional()[0] + "' is too much; name the folder with -o.");
    if (!arguments.has("-o")) throw UsageError("Where to? Name a folder with -o.");
    const std::string folder = arguments.text("-o", "");
    GrowOptions grow;
    grow.seed = arguments.whole("--seed", 1, 0, UINT64_MAX);
    grow.height = arguments.number("--height", 0.0, 1.0, 60.0);
    if (arguments.has("--habit")) {
        try {
            grow.habit = parse_habit(arguments.text("--habit", ""));
        } catch (const Error& error) {
            throw UsageError(error.what());
        }
    }
    VirtualScanOptions scanning = scan_options_for(grow.habit);
    scanning.seed = grow.seed;
    scanning.points = arguments.whole("--points", scanning.points, 1, 20'000'000);
    scanning.noise = arguments.number("--noise", scanning.noise, 0.0, 1.0);
    scanning.occlusion = arguments.number("--occlusion", 0.0, 0.0, 0.95);
    scanning.leaves = arguments.number("--leaves", 0.0, 0.0, 1.0);
    scanning.stations = static_cast<int>(arguments.whole("--stations", 5, 1, 64));

    const std::string scan_path = folder + "/scan.ply", truth_path = folder + "/truth.txt";
    require_own(truth_path, "# Tree file, one line per tree", "no tree file of ours");
    std::error_code failure;
    if (std::filesystem::exists(path_of(scan_path), failure) &&
        !std::filesystem::exists(path_of(truth_path), failure))
        throw UsageError("'" + scan_path +
                         "' is there already, without the truth.txt of a grown tree, and was left as it is; "
                         "name another folder.");
    const bool quiet = arguments.has("--quiet");
    TerminalProgress progress(quiet);
    progress.update(0.0, "Growing");
    const Tree tree = grow_tree(grow);
    SubProgress scan_progress(&progress, 0.2, 0.9);
    const VirtualScan scan = scan_tree(tree, scanning, &scan_progress);
    progress.check();
    progress.update(0.9, "Writing");
    make_folder(folder);
    write_cloud(scan_path, scan.cloud);
    write_treefile(truth_path, tree);
    progress.clear();
    if (quiet) return;
    const Measurements m = measure(tree);
    std::printf("a %.1f m high tree, DBH %.1f cm, %zu tips, %.0f m of wood\n", m.height, 100.0 * m.dbh,
                m.tips, m.total_length);
    std::printf("wrote %s (%zu points) and %s\n", scan_path.c_str(), scan.cloud.size(), truth_path.c_str());
}

}  // namespace treerec
