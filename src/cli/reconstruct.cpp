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
#include "cli/terminal_progress.h"
#include "file_bytes.h"
#include "geometry/parallel.h"
#include "pipeline/export.h"
#include "pipeline/html_report.h"
#include "pipeline/reconstruct.h"
#include "pipeline/report.h"

namespace treerec {

namespace {

// By what a report and a page of ours are known.
constexpr std::string_view kReportMark = "\"scan_format\"";
constexpr std::string_view kPageMark = "reconstructed tree</title>";

// An option's wrong value is a matter of the command line, not of the file.
template <typename Call>
auto as_usage(Call call) {
    try {
        return call();
    } catch (const Error& error) {
        throw UsageError(error.what());
    }
}

// "1,2.5,3": so many finite numbers. `as_in` is an example for the user.
template <size_t kCount>
std::array<double, kCount> numbers_from(const Arguments& arguments, const std::string& option,
                                        const std::string& as_in) {
    const std::string word = arguments.text(option, "");
    std::array<double, kCount> values{};
    const char* at = word.data();
    const char* const end = at + word.size();
    for (size_t i = 0; i < kCount; i++) {
        const auto [next, failure] = std::from_chars(at, end, values[i]);
        const bool last = i + 1 == kCount;
        const bool ends_well = last ? next == end : next != end && *next == ',';
        if (failure != std::errc() || !std::isfinite(values[i]) || !ends_well)
            throw UsageError(option + " needs " + std::to_string(kCount) + " numbers, as in " + as_in +
                             ", not '" + word + "'.");
        at = last ? next : next + 1;
    }
    return values;
}

KnownLength known_length_from(const Arguments& arguments) {
    const auto v =
        numbers_from<7>(arguments, "--length", "0,0,0,0,0,5.2,1.8 (two places and the metres between)");
    const KnownLength known{{v[0], v[1], v[2]}, {v[3], v[4], v[5]}, v[6]};
    if (!(known.metres > 0.0) || known.from == known.to)
        throw UsageError("--length needs two different places, and a length above 0.");
    return known;
}

constexpr std::pair<std::string_view, double> kUnits[] = {
    {"m", 1.0},     {"cm", 0.01},  {"mm", 0.001}, {"km", 1000.0}, {"ft", 0.3048}, {"us-ft", 1200.0 / 3937.0},
    {"in", 0.0254}, {"yd", 0.9144}};

double unit_from(const Arguments& arguments) {
    const std::string word = arguments.text("--unit", "");
    std::string known;
    for (const auto& [name, metres] : kUnits) {
        if (name == word) return metres;
        known += (known.empty() ? "" : " ") + std::string(name);
    }
    throw UsageError("--unit is one of " + known + ", not " + quote_word(word) + ".");
}

PickOptions pick_from(const Arguments& arguments) {
    if (arguments.has("--one-tree") + arguments.has("--tree") + arguments.has("--tree-at") > 1)
        throw UsageError("--one-tree, --tree and --tree-at say which tree is meant; give one of them.");
    PickOptions pick;
    pick.enabled = !arguments.has("--one-tree");
    pick.number = arguments.whole("--tree", 1, 1, 1000000);
    if (arguments.has("--tree-at")) {
        const auto place = numbers_from<3>(arguments, "--tree-at", "12.5,3,0");
        pick.position = DVec3(place[0], place[1], place[2]);
    }
    return pick;
}

ReconstructOptions options_from(const Arguments& arguments) {
    ReconstructOptions options;
    options.read = read_options_from(arguments);
    if (arguments.text("--up", "auto") != "auto") options.orient.up = up_axis_from(arguments);
    if (arguments.has("--scale"))
        options.orient.metres_per_unit = arguments.number("--scale", 1.0, 1e-9, 1e9);
    if (arguments.has("--unit")) options.orient.metres_per_unit = unit_from(arguments);
    if (arguments.has("--height")) options.orient.known_height = arguments.number("--height", 0.0, 1e-3, 1e3);
    if (arguments.has("--length")) options.orient.known_length = known_length_from(arguments);
    if (arguments.has("--scale") + arguments.has("--unit") + arguments.has("--height") +
            arguments.has("--length") >
        1)
        throw UsageError("--scale, --unit, --height and --length all set the scale; give one of them.");
    options.skeleton.spacing = arguments.number("--spacing", 0.0, 1e-4, 10.0);
    options.skeleton.method =
        as_usage([&] { return parse_skeleton_method(arguments.text("--skeleton", "delaunay")); });
    options.skeleton.voxel = arguments.number("--voxel", 0.0, 1e-9, 1e3);
    if (arguments.has("--voxel") && options.skeleton.method != SkeletonMethod::kFlood)
        throw UsageError("--voxel is the size of the flood's voxels; add --skeleton flood.");
    options.skeleton.flood = as_usage([&] { return parse_flood_kind(arguments.text("--flood", "ours")); });
    if (arguments.has("--flood") && options.skeleton.method != SkeletonMethod::kFlood)
        throw UsageError("--flood says how the flood is done; add --skeleton flood.");
    options.radii = as_usage([&] { return parse_radius_rule(arguments.text("--radii", "measured")); });
    options.skeleton.keep_raw = false;
    options.skeleton.seed = arguments.whole("--seed", 1, 0, UINT64_MAX);
    const bool clean = !arguments.has("--no-clean");
    options.clean.remove_extreme_colors = clean && !arguments.has("--no-clean-colors");
    options.clean.remove_outliers = clean && !arguments.has("--no-clean-outliers");
    options.clean.remove_fragments = clean && !arguments.has("--no-clean-fragments");
    options.clean.remove_ground = clean && !arguments.has("--no-clean-ground");
    options.clean.pick = pick_from(arguments);
    options.complete = arguments.has("--complete");
    if (arguments.has("--prune")) {
        const std::string rule = arguments.text("--prune", "");
        if (rule != "paper" && rule != "leader")
            throw UsageError("--prune is paper or leader, not '" + rule + "'.");
        options.prune.emplace();
        options.prune->spare_leader = rule == "leader";
    }
    options.tell_leaves = !arguments.has("--all-wood");
    // Enough for the summary; a report tells more exactly.
    if (!arguments.has("--report")) options.score_points = 1500;
    return options;
}

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

void print_summary(const Reconstruction& result, const std::vector<std::string>& outs, double seconds) {
    const Measurements& m = result.measured;
    std::printf("%zu points, %zu after cleaning; %zu nodes, %zu tips\n", result.points_read,
                result.cloud.size(), m.nodes, m.tips);
    std::printf("height %.2f m, ", m.height);
    if (m.dbh > 0.0)
        std::printf("DBH %.1f cm, ", 100.0 * m.dbh);
    else
        std::printf("%s, ",
                    m.height < kBreastHeight ? "lower than breast height" : "no stem at breast height");
    std::printf("crown radius %.2f m, wood %.3f m3\n", m.crown_radius, m.volume);
    if (result.pruned > 0) std::printf("%zu nodes of long twigs were cut away\n", result.pruned);
    if (result.leaf_points > 0)
        std::printf(
            "%.0f %% of the points are leaves%s\n",
            100.0 * static_cast<double>(result.leaf_points) / static_cast<double>(result.cloud.size()),
            result.leaf_column.empty()
                ? ""
                : (", as the column " + quote_word(result.leaf_column) + " says").c_str());
    std::printf("%.0f %% of the %s lie within 2 cm of the bark, half within %.1f mm\n",
                100.0 * result.fit.explained_2cm, result.leaf_points > 0 ? "others" : "points",
                result.fit.median_mm);
    for (const std::string& out : outs)
        std::printf("wrote %s\n", out.c_str());
    std::printf("%.1f s\n", seconds);
}

std::string leaf_names() {
    std::string names;
    for (const std::string& name : leaf_preset_names())
        names += name + " ";
    return names;
}

}  // namespace

const Command& reconstruct_command() {
    static const Command command{
        "reconstruct",
        "reconstruct SCAN -o OUT [-o OUT...] [--report R.json] [options]",
        "Turns a point cloud into a tree.",
        {{"-o", "OUT",
          "a file to write; its ending names the format: .glb .gltf .obj (bark and leaves:\n"
          "metres, Y up, base at the origin), .ply .txt .csv .lstring (skeleton, tree file, QSM\n"
          "cylinders: the scan's own coordinates). More of them: -o A -o B",
          true},
         {"--report", "FILE", "stage times, counts, measurements and warnings as JSON"},
         {"--html", "FILE", "a page to send to somebody: pictures, fidelity, tables (also -o FILE.html)"},
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
         {"--skeleton", "METHOD", "delaunay (shortest paths, slices) or flood (voxels) (default delaunay)"},
         {"--flood", "KIND", "ours, or paper: as papers/002 prints it, to compare (default ours)"},
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
        "(.bin .txt) or text (.xyz .txt .asc .pts .csv). What it is, its contents tell."};
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
    const bool told = arguments.has("--report") || arguments.has("--html");
    if (outs.empty() && !told) throw UsageError("Where to? Name at least one file to write with -o.");
    std::vector<std::string> pages = arguments.all("--html");
    std::copy_if(outs.begin(), outs.end(), std::back_inserter(pages), is_page);
    std::erase_if(outs, is_page);
    const ReconstructOptions options = options_from(arguments);
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
    const std::string report = arguments.text("--report", "");
    std::vector<std::string> targets = outs;
    if (arguments.has("--report")) targets.push_back(report);
    targets.insert(targets.end(), pages.begin(), pages.end());
    for (const std::string& target : targets)
        require_safe_target(target, scan, targets);
    if (arguments.has("--report")) require_own(report, kReportMark, "no report of a reconstruction");
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
    if (!outs.empty()) progress.update(0.9, "Writing");
    exporter.prepare(outs);
    result.measured = exporter.measured();
    // The file system takes what one core writes; the score keeps all others busy.
    parallel_for(2, 1, [&](size_t part, size_t) {
        if (part == 1) return score_reconstruction(result, options, &scoring);
        for (const std::string& out : outs) {
            progress.check();
            exporter.write(out);
        }
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
    progress.clear();
    for (const std::string& warning : result.warnings)
        std::fprintf(stderr, "Warning: %s\n", warning.c_str());
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (!quiet) print_summary(result, targets, seconds);
}

}  // namespace treerec
