#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <utility>

#include "cli/commands.h"
#include "cli/png_file.h"
#include "cli/reconstruct_options.h"
#include "cli/terminal_progress.h"
#include "file_bytes.h"
#include "geometry/parallel.h"
#include "pipeline/cleaned_cloud.h"
#include "pipeline/export.h"
#include "pipeline/html_report.h"
#include "pipeline/reconstruct.h"
#include "pipeline/report.h"
#include "pipeline/show_fidelity.h"

namespace treerec {

namespace {

// By what a report and a page of ours are known.
constexpr std::string_view kReportMark = "\"scan_format\"";
constexpr std::string_view kPageMark = "reconstructed tree</title>";

bool is_page(const std::string& path) {
    return extension_of(path) == "html" || extension_of(path) == "htm";
}

void require_safe_target(const std::string& target, const std::string& scan,
                         const std::vector<std::string>& targets) {
    if (std::count(targets.begin(), targets.end(), target) > 1)
        throw UsageError(target + " would be written twice.");
    std::error_code failure;
    if (std::filesystem::equivalent(path_of(target), path_of(scan), failure))
        throw UsageError(target + " is the scan itself; it would be overwritten.");
    as_usage([&] { require_writable(target); });
}

}  // namespace

const Command& reconstruct_command() {
    static const Command command{
        "reconstruct",
        "reconstruct SCAN -o OUT [-o OUT...] [--report R.json] [options]",
        "Turns a point cloud into a tree.",
        {{"-o", "OUT",
          "a file to write; its ending names the format: .glb .gltf .obj (bark and leaves:\n"
          "metres, Y up, base at the origin), .ply .txt .csv .mtg .lstring (skeleton, tree file, QSM\n"
          "cylinders: the scan's own coordinates). More of them: -o A -o B",
          true},
         {"--report", "FILE", "stage times, counts, measurements and warnings as JSON"},
         {"--cloud", "FILE",
          "the cloud as it was cleaned, to lay over the scan: .ply, or .xyz .txt .asc .las (the\n"
          "scan's own coordinates; a column leaf where leaves were told from wood)"},
         {"--html", "FILE", "a page to send to somebody: pictures, fidelity, tables (also -o FILE.html)"},
         {"--sheet", "FILE.png",
          "a picture to show: the cloud, the skeleton before and after pruning, the tree, and it from its\n"
          "four sides"},
         {"--picture", "FILE.png", "the tree alone, from the front: small, and soon drawn"},
         {"--seed", "N", "of everything random (default 1)"},
         {"--up", "AXIS", "the scan's axis to the sky: auto x y z -x -y -z (default auto)"},
         {"--scale", "S", "metres per unit of the scan (default: found out)"},
         {"--unit", "NAME",
          "of the scan: m cm mm km ft us-ft in yd (default: as its file says, or found out)"},
         {"--height", "M", "the tree's height in metres: sets the scale of scans that have none"},
         {"--length", "LIST", "a length in the scan that sets the scale: x,y,z,x,y,z,metres"},
         {"--leaves", "PRESET", leaf_names() + "or auto, the default: palm for a palm, else generic"},
         {"--levels", "N", "levels of detail in .glb and .gltf files, 1 to 5 (default 1)"},
         {"--pictures-beside", "", "the pictures of a .glb go into a folder beside it, as those of a .gltf"},
         {"--threads", "N", "how many to use (default: all cores); changes nothing else"},
         {"--skeleton", "METHOD",
          "geodesic (shortest paths, slices), delaunay (AdTree's own way, to compare) or flood (voxels)\n"
          "(default geodesic)"},
         {"--spanning-tree", "KIND",
          "over the Delaunay triangulation: paths (the shortest from the root) or minimum (default paths)"},
         {"--flood", "KIND", "ours, or paper: as Zhang 2013 prints it, to compare (default ours)"},
         {"--voxel", "M", "edge of the flood's voxels in metres (default: found out)"},
         {"--radii", "RULE", "measured, or by a rule: linear or davinci (default measured)"},
         {"--complete", "", "look again for branches where points are left over"},
         {"--prune", "RULE",
          "cut twigs longer than the mean to it: paper (all, algorithm 3), leader (not the trunk's tip)"},
         {"--spacing", "M", "thin the cloud to this many metres between points (default: found out)"},
         {"--columns", "LIST", "names of a text file's columns, such as x,y,z,r,g,b; - skips one"},
         {"--classes", "LIST",
          "classes of LAS points to read, such as 2,4-5, or all (default: all but noise, 7 and 18)"},
         {"--no-clean", "", "leave out all cleaning, or one step of it:"},
         {"--no-clean-colors", "", "near white and near black points stay"},
         {"--no-clean-outliers", "", "lone points stay"},
         {"--no-clean-fragments", "", "small far clusters stay"},
         {"--no-clean-ground", "", "the ground and walls stay"},
         {"--tree", "N", "which of several trees: 1 is the largest (default 1)"},
         {"--tree-at", "X,Y,Z", "the tree that stands nearest to this place in the scan"},
         {"--one-tree", "", "there is only one tree; nothing is taken for another one"},
         {"--all-wood", "", "leaves are not told from wood: every point is followed"},
         {"--quiet", "", "print errors and warnings only"}},
        "SCAN: PLY (Gaussian splats too), LAS, LAZ (where LASzip is installed), PCD, COLMAP's points3D\n"
        "(.bin .txt) or the folder of its model, or text (.xyz .txt .asc .pts .csv). What it is, its\n"
        "contents tell. From photos: treerec photos."};
    return command;
}

void run_reconstruct(const std::vector<std::string>& words) {
    const Arguments arguments(reconstruct_command(), words);
    const std::vector<std::string>& positional = arguments.positional();
    if (positional.empty()) throw UsageError("Which scan? Name a point-cloud file.");
    // A second one may be a scan as well ("*.ply"), which must not be written over.
    if (positional.size() > 1)
        throw UsageError("'" + positional[1] +
                         "' is too much: one scan at a time, and each file to write behind a -o of its own.");
    const std::string scan = positional[0];
    std::vector<std::string> outs = arguments.all("-o");
    const bool told = arguments.has("--report") || arguments.has("--html") || arguments.has("--cloud") ||
                      arguments.has("--sheet") || arguments.has("--picture");
    if (outs.empty() && !told) throw UsageError("Where to? Name at least one file to write with -o.");
    std::vector<std::string> pages = arguments.all("--html");
    std::copy_if(outs.begin(), outs.end(), std::back_inserter(pages), is_page);
    std::erase_if(outs, is_page);
    ReconstructOptions options = reconstruct_options_from(arguments);
    options.skeleton.keep_raw = arguments.has("--sheet");
    ReportDetails details{scan, options, arguments.text("--leaves", "auto"), options.skeleton.seed, 0, 0};
    ExportOptions exports;
    as_usage([&] { return leaf_preset(details.leaves == "auto" ? "generic" : details.leaves); });
    exports.seed = options.skeleton.seed;
    exports.levels = levels_from(arguments);
    exports.pictures_beside = arguments.has("--pictures-beside");
    set_thread_count(static_cast<int>(arguments.whole("--threads", 0, 1, 1024)));
    // Before the long work, not after it.
    for (const std::string& out : outs)
        as_usage([&] { require_writable_format(out); });
    const std::string report = arguments.text("--report", ""), cloud = arguments.text("--cloud", "");
    std::vector<std::string> targets = outs;
    if (arguments.has("--cloud")) {
        as_usage([&] { require_cloud_extension(cloud); });
        targets.push_back(cloud);
    }
    if (arguments.has("--report")) targets.push_back(report);
    const std::string sheet = arguments.text("--sheet", "");
    const std::string picture = arguments.text("--picture", "");
    for (const char* const option : {"--sheet", "--picture"}) {
        if (!arguments.has(option)) continue;
        require_png(arguments.text(option, ""));
        targets.push_back(arguments.text(option, ""));
    }
    targets.insert(targets.end(), pages.begin(), pages.end());
    for (const std::string& target : targets)
        require_safe_target(target, scan, targets);
    if (arguments.has("--report")) require_own(report, kReportMark, "no report of a reconstruction");
    if (arguments.has("--cloud")) require_own_cloud(cloud);
    for (const std::string& page : arguments.all("--html"))
        require_own(page, kPageMark, "no page of a reconstruction");

    const auto start = std::chrono::steady_clock::now();
    const bool quiet = arguments.has("--quiet");
    TerminalProgress progress(quiet);
    SubProgress reconstructing(&progress, 0.0, 0.88), scoring(&progress, 0.9, 0.95);
    Reconstruction result = reconstruct_tree(scan, options, &reconstructing);
    details.leaves = chosen_leaves(details.leaves, result);
    exports.leaves = suited_leaves(details.leaves, result);
    exports.textures = details.leaves;
    exports.foliage = result.foliage;
    TreeExporter exporter(result.tree, exports, &progress);
    if (!outs.empty() || arguments.has("--cloud")) progress.update(0.9, "Writing");
    exporter.prepare(outs);
    result.measured = exporter.measured();
    label_found_leaves(result);
    // The file system takes what one core writes; the score keeps all others busy.
    parallel_for(2, 1, [&](size_t part, size_t) {
        if (part == 1) return score_reconstruction(result, options, &scoring);
        for (const std::string& out : outs) {
            progress.check();
            exporter.write(out);
        }
        if (arguments.has("--cloud")) write_cleaned_cloud(cloud, result.cloud, &progress);
    });
    progress.check();
    if (arguments.has("--report")) {
        details.triangles = exporter.triangles();
        details.leaf_count = exporter.leaves();
        write_file(report, report_json(result, details));
    }
    if (!pages.empty()) {
        SubProgress reporting(&progress, 0.95, 1.0);
        const std::string html = report_html(result, details, &reporting);
        for (const std::string& page : pages)
            write_file(page, html);
    }
    ShowOptions show{stem_of(scan), exports.leaves, exports.textures, exports.seed};
    show.fidelity = false;
    if (arguments.has("--sheet")) write_png(sheet, *show_fidelity(result, show, &progress).stages);
    if (arguments.has("--picture")) write_png(picture, show_tree(result, show, &progress));
    progress.clear();
    for (const std::string& warning : result.warnings)
        std::fprintf(stderr, "Warning: %s\n", warning.c_str());
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (!quiet) print_summary(result, targets, seconds);
}

}  // namespace treerec
