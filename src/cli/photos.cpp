#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "cli/commands.h"
#include "cli/png_file.h"
#include "cli/print_outline.h"
#include "cli/reconstruct_options.h"
#include "cli/terminal_progress.h"
#include "file_bytes.h"
#include "geometry/parallel.h"
#include "photos/heic_photos.h"
#include "photos/matches_picture.h"
#include "pipeline/cleaned_cloud.h"
#include "pipeline/compare_sheet.h"
#include "pipeline/export.h"
#include "pipeline/html_report.h"
#include "pipeline/photos.h"
#include "pipeline/report.h"
#include "pipeline/show_fidelity.h"

namespace treerec {

namespace {

// The options of 'reconstruct' that suit a cloud that is made here.
constexpr const char* kShared[] = {"--cloud",
                                   "--seed",
                                   "--up",
                                   "--scale",
                                   "--height",
                                   "--leaves",
                                   "--levels",
                                   "--pictures-beside",
                                   "--threads",
                                   "--skeleton",
                                   "--spanning-tree",
                                   "--flood",
                                   "--voxel",
                                   "--radii",
                                   "--complete",
                                   "--prune",
                                   "--spacing",
                                   "--no-clean",
                                   "--no-clean-colors",
                                   "--no-clean-outliers",
                                   "--no-clean-fragments",
                                   "--no-clean-ground",
                                   "--tree",
                                   "--tree-at",
                                   "--one-tree",
                                   "--all-wood",
                                   "--quiet"};

std::vector<Option> all_options() {
    std::vector<Option> options = {
        {"-o", "OUT",
         "the folder to write to: tree.glb tree.txt report.json report.html compare.png stages.png\n"
         "fidelity.png cloud.ply photos.log"},
        {"--order", "ORDER",
         "which photos are compared: exhaustive (all), sequence (neighbours by name, the last with\n"
         "the first) or auto, the default: exhaustive for up to 80"},
        {"--matcher", "MATCHER",
         "what photos share is found out by sift (COLMAP's features), pyrlk (corners tracked from photo\n"
         "to photo), both, or auto, the default: sift, and both where that does not place all photos,\n"
         "or places some doubtfully"},
        {"--show-matches", "A,B", "nothing but OUT/matches_A_B.png: what is tracked from photo A to photo B"},
        {"--time", "TIME", "how much to find in each photo: quick, normal or best (default normal)"},
        {"--hold-out", "N",
         "every N-th photo, by name, places its camera and nothing else, so that it can judge the tree"},
        {"--masks", "FOLDER",
         "white-on-black pictures of the tree's outline, PHOTO.png, of the photos that are held out or\n"
         "else of all: how well the tree has it is told (without: the photos' sky tells its precision)"},
        {"--bark", "FROM",
         "photos takes the bark's pictures out of the photos, into OUT/bark, where these are good enough;\n"
         "drawn takes those of --leaves (default photos)"},
        {"--leaf-colors", "FROM",
         "photos gives the leaves the colors that the photos show, by height; drawn leaves those of "
         "--leaves\n"
         "(default photos)"},
        {"--sparse", "", "no dense points: the cloud has the few that placed the cameras"},
        {"--colmap", "PROGRAM", "COLMAP, or its folder (default: $COLMAP, PATH, the usual folders)"},
        {"--marker", "SIDE",
         "the side of the black square of printed markers in the photos, such as 150mm, 6in or 0.15 "
         "(metres);\n"
         "sets the scale ('treerec marker' makes one to print)"},
        {"--known-length", "LIST",
         "a length in cloud.ply that sets the scale: x,y,z,x,y,z,metres (photos have none but their GPS)"}};
    for (const Option& option : reconstruct_command().options)
        for (const char* name : kShared)
            if (option.name == name) options.push_back(option);
    return options;
}

void print_photos(const PhotosResult& result) {
    std::printf("%zu of %zu photos placed", result.photos.registered, result.photos.photos);
    if (result.photos.widest_gap)
        std::printf(", the widest gap between them %ld degrees",
                    std::lround(result.photos.widest_gap->degrees));
    if (result.made.pairs > 0)
        std::printf("; %zu points, of %zu pairs of photos\n", result.made.points, result.made.pairs);
    else
        std::printf("; %zu points\n", result.made.points);
    for (const MeasuredMarker& marker : result.marker.markers)
        if (marker.usable() && result.marker.usable())
            std::printf("marker %d in %zu photos, %zu agree: its side and diagonals to %.1f %%\n", marker.id,
                        marker.photos, marker.kept, 100.0 * marker.uneven);
    if (result.marker.usable())
        std::printf("%s: a unit of cloud.ply is %.4f m, give or take %.1f %%\n",
                    result.sized_by_marker ? "the scale is the marker's" : "by the marker",
                    result.marker.metres_per_unit(), 100.0 * result.marker.spread);
    if (result.bark && result.bark->textures)
        std::printf("bark from %zu photos, with pixels of %.1f mm\n", result.bark->photos,
                    1000.0 * result.bark->pixel);
    if (result.leaf_colours && result.leaf_colours->seen())
        std::printf("leaf colors from %zu points in %zu photos\n", result.leaf_colours->points,
                    result.leaf_colours->photos);
}

// The tree over some of its photos. Whether there is one: it is no reason for a tree to fail.
bool write_compared(PhotosResult& result, const std::string& path, Progress& progress) {
    try {
        const PhotoModel model = read_photo_model(result.photos.model, &progress);
        write_png(path, compare_sheet(result.tree.tree, model, result.photos_folder, {}, &progress));
        return true;
    } catch (const Cancelled&) {
        throw;
    } catch (const Error& error) {
        result.tree.warnings.emplace_back("There is no compare.png. " + std::string(error.what()));
        return false;
    }
}

// Throws UsageError where the cleaned cloud can't be written to `path`, or would take the place of something
// else in the folder `out`, which may not be there yet.
void require_cloud_target(const std::string& path, const std::string& out) {
    namespace fs = std::filesystem;
    std::error_code failure;
    const fs::path target = fs::weakly_canonical(path_of(path), failure);
    const fs::path folder = fs::weakly_canonical(path_of(out), failure);
    for (const char* name : {"cloud.ply", "tree.txt"})
        if (target == folder / name)
            throw UsageError("'" + path + "' is another file that this command writes; name --cloud's anew.");
    const bool folder_comes = target.parent_path() == folder && !fs::exists(folder, failure);
    as_usage([&] {
        require_cloud_extension(path);
        if (!folder_comes) require_writable(path);
    });
    require_own_cloud(path);
}

}  // namespace

const Command& photos_command() {
    static const Command command{
        "photos", "photos FOLDER -o OUT [options]", "Turns photos of a tree into a tree, with COLMAP.",
        all_options(),
        "FOLDER: photos (.jpg .png .tif .bmp, or .heic with heif-convert, sips or magick) from all around\n"
        "the tree, 8 or more, or a film of one walk around it (with ffmpeg); they are only read.\n"
        "What was done already with the same photos and options is taken from OUT, also after a kill."};
    return command;
}

void run_photos(const std::vector<std::string>& words) {
    const Arguments arguments(photos_command(), words);
    const std::vector<std::string>& positional = arguments.positional();
    if (positional.empty()) throw UsageError("Which photos? Name their folder, or a film.");
    if (positional.size() > 1)
        throw UsageError("'" + positional[1] + "' is too much: one folder of photos at a time.");
    if (!arguments.has("-o")) throw UsageError("Where to? Name a folder with -o.");
    const std::string folder = positional[0], out = arguments.text("-o", "");
    PhotosOptions options;
    options.colmap.program = arguments.text("--colmap", "");
    options.colmap.order = as_usage([&] { return parse_photo_order(arguments.text("--order", "auto")); });
    options.colmap.matcher =
        as_usage([&] { return parse_photo_matcher(arguments.text("--matcher", "auto")); });
    options.colmap.effort = as_usage([&] { return parse_photo_effort(arguments.text("--time", "normal")); });
    options.cloud = cloud_options_of(options.colmap.effort);
    options.cloud.dense = !arguments.has("--sparse");
    options.marker_side = length_from(arguments, "--marker", 0.0, 1e-3, 100.0);
    options.cloud.hold_out = arguments.whole("--hold-out", 0, 2, 1000);
    const std::string masks = arguments.text("--masks", "");
    if (std::error_code failure; !masks.empty() && !std::filesystem::is_directory(path_of(masks), failure))
        throw Error("There is no folder '" + masks + "' with the photos' masks.");
    const std::string bark = arguments.text("--bark", "photos");
    if (bark != "photos" && bark != "drawn")
        throw UsageError("--bark is photos or drawn, not '" + bark + "'.");
    options.bark = bark == "photos";
    const std::string colors = arguments.text("--leaf-colors", "photos");
    if (colors != "photos" && colors != "drawn")
        throw UsageError("--leaf-colors is photos or drawn, not '" + colors + "'.");
    options.leaf_colours = colors == "photos";
    options.colmap.threads = static_cast<int>(arguments.whole("--threads", 0, 1, 1024));
    options.reconstruct = reconstruct_options_from(arguments);
    options.reconstruct.skeleton.keep_raw = true;
    options.reconstruct.score_points = ReconstructOptions{}.score_points;
    ReportDetails details{
        "", options.reconstruct, arguments.text("--leaves", "auto"), options.reconstruct.skeleton.seed, 0, 0};
    as_usage([&] { return leaf_preset(details.leaves == "auto" ? "generic" : details.leaves); });
    ExportOptions exports;
    exports.seed = options.reconstruct.skeleton.seed;
    exports.levels = levels_from(arguments);
    exports.pictures_beside = arguments.has("--pictures-beside");
    set_thread_count(options.colmap.threads);
    const std::string cloud = arguments.text("--cloud", "");
    if (arguments.has("--cloud")) require_cloud_target(cloud, out);

    const auto start = std::chrono::steady_clock::now();
    const bool quiet = arguments.has("--quiet");
    TerminalProgress progress(quiet);
    if (arguments.has("--show-matches")) {
        const ShownMatches shown =
            show_matches(readable_photos(folder, out, &progress).folder, out,
                         arguments.text("--show-matches", ""), options.colmap.effort, &progress);
        if (!quiet)
            std::printf("%s: %zu matches of the plain method; of the improved one %zu, and %zu dropped\n",
                        shown.path.c_str(), shown.plain, shown.improved, shown.dropped);
        return;
    }
    SubProgress making(&progress, 0.0, 0.95);
    PhotosResult result = reconstruct_photos(folder, out, options, &making);
    Reconstruction& tree = result.tree;
    details.scan_path = result.cloud;
    details.photos = result.photos;
    details.photo_pairs = result.made.pairs;
    details.marker = result.marker;
    details.sized_by_marker = result.sized_by_marker;
    details.sized_by_gps = result.sized_by_gps;
    details.bark = result.bark;
    details.leaf_colours = result.leaf_colours;
    details.leaves = chosen_leaves(details.leaves, tree);
    exports.leaves = suited_leaves(details.leaves, tree);
    exports.textures = details.leaves;
    exports.foliage = tree.foliage;
    if (result.bark && result.bark->textures) exports.bark = encode_bark(*result.bark->textures);
    exports.leaf_colours = result.leaf_colours;
    TreeExporter exporter(tree.tree, exports, &progress);
    progress.update(0.95, "Writing");
    std::vector<std::string> outs;
    for (const char* name : {"tree.glb", "tree.txt"})
        outs.push_back(utf8_of(path_of(out) / name));
    exporter.prepare(outs);
    for (const std::string& path : outs)
        exporter.write(path);
    if (arguments.has("--cloud")) {
        label_found_leaves(tree);
        write_cleaned_cloud(cloud, tree.cloud, &progress);
        outs.push_back(cloud);
    }
    details.triangles = exporter.triangles();
    details.leaf_count = exporter.leaves();
    const auto target = [&](const char* name) { return outs.emplace_back(utf8_of(path_of(out) / name)); };
    details.title = "Tree of " + std::to_string(result.photos.registered) + " photos";
    SubProgress showing(&progress, 0.96, 0.98);
    ShownFidelity shown = show_fidelity(
        tree,
        {details.title, exports.leaves, exports.textures, exports.seed,
         OutlineFolders{result.photos.model, masks, result.photos_folder}, options.cloud.hold_out},
        &showing);
    // Nobody has asked the sky.
    if (!shown.outline && !masks.empty())
        tree.warnings.push_back("The tree's outline was not judged. " + shown.lacks);
    details.outline = shown.outline;
    details.outline_lacks = shown.lacks;
    details.outline_sheet = shown.fidelity;
    write_file(target("report.json"), report_json(tree, details));
    write_file(target("report.html"), report_html(tree, details, &progress));
    write_png(target("stages.png"), *shown.stages);
    write_png(target("fidelity.png"), *shown.fidelity);
    progress.update(0.99, "Comparing");
    if (const std::string path = utf8_of(path_of(out) / "compare.png");
        write_compared(result, path, progress))
        outs.push_back(path);
    if (result.bark && result.bark->textures)
        for (const char* name : {"albedo.png", "normal.png", "roughness.png"})
            outs.push_back(utf8_of(path_of(out) / "bark" / name));
    outs.push_back(result.cloud);
    progress.clear();
    for (const std::string& warning : tree.warnings)
        std::fprintf(stderr, "Warning: %s\n", warning.c_str());
    if (quiet) return;
    print_photos(result);
    if (details.outline) {
        print_fidelity(details.outline->cloud, shown.skeleton, details.outline->source);
        print_outline(details.outline->shapes, details.outline->source);
    }
    print_summary(tree, outs,
                  std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
}

}  // namespace treerec
