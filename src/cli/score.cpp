#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>

#include "cli/commands.h"
#include "cli/png_file.h"
#include "cli/print_outline.h"
#include "cli/reconstruct_options.h"
#include "cli/terminal_progress.h"
#include "exchange/tree_files.h"
#include "fidelity/doubtful.h"
#include "fidelity/fidelity.h"
#include "fidelity/photo_overlap.h"
#include "fidelity/score.h"
#include "pipeline/judge_outline.h"
#include "pipeline/scan_report.h"
#include "pipeline/sheets.h"
#include "scan/formats/read_cloud.h"

namespace treerec {

namespace {

using Json = nlohmann::ordered_json;

Json agreements_json(const std::vector<Agreement>& agreements, const char* threshold) {
    Json json = Json::array();
    for (const Agreement& a : agreements)
        json.push_back(
            {{threshold, a.threshold}, {"precision", a.precision}, {"recall", a.recall}, {"f", a.f}});
    return json;
}

void print_agreements(const std::vector<Agreement>& agreements, const char* unit, double factor) {
    for (const Agreement& a : agreements)
        std::printf("within %-4g %-9s precision %.3f  recall %.3f  F %.3f\n", factor * a.threshold, unit,
                    a.precision, a.recall, a.f);
}

void print_skeleton_score(const SkeletonScore& score, bool as_json) {
    if (as_json) {
        Json json;
        json["reference"] = "skeleton";
        json["by_radius"] = agreements_json(score.by_radius, "radii");
        json["by_distance"] = agreements_json(score.by_distance, "metres");
        json["chamfer_mm"] = score.chamfer_mm;
        json["length_m"] = score.length;
        json["reference_length_m"] = score.reference_length;
        json["length_error"] = score.length_error;
        json["volume_m3"] = score.volume;
        json["reference_volume_m3"] = score.reference_volume;
        json["volume_error"] = score.volume_error;
        json["radius_error"] = score.radius_error;
        json["radius_error_abs"] = score.radius_error_abs;
        std::printf("%s\n", json.dump(2).c_str());
        return;
    }
    print_agreements(score.by_radius, "radii", 1.0);
    print_agreements(score.by_distance, "cm", 100.0);
    std::printf("Chamfer distance %.2f mm\n", score.chamfer_mm);
    std::printf("length %.2f m, reference %.2f m (%+.1f %%)\n", score.length, score.reference_length,
                100.0 * score.length_error);
    std::printf("wood %.4f m3, reference %.4f m3 (%+.1f %%)\n", score.volume, score.reference_volume,
                100.0 * score.volume_error);
    std::printf("radius error, median %+.1f %%, absolute %.1f %%\n", 100.0 * score.radius_error,
                100.0 * score.radius_error_abs);
}

void print_part(const char* name, const FidelityPart& part) {
    if (part.points == 0) {
        std::printf("%-12s         no points of %8.2f m2\n", name, part.bark);
        return;
    }
    std::printf(
        "%-12s %9zu points %6.1f %% explained, median %6.1f, 95 %% within %7.1f mm, %5.1f %% of %8.2f m2 "
        "seen\n",
        name, part.points, 100.0 * part.explained, 1000.0 * part.median, 1000.0 * part.p95,
        100.0 * part.coverage, part.bark);
}

void print_text(const ScanReport& report, const Tree& tree) {
    const ScanScore& score = report.score;
    const Fidelity& fidelity = report.fidelity;
    std::printf("%zu points; distance to the bark: median %.1f, mean %.1f, 95 %% within %.1f mm\n",
                score.points, score.median_mm, score.mean_mm, score.p95_mm);
    std::printf("explained within 2 cm: %.1f %%\n", 100.0 * score.explained_2cm);
    if (report.noise > 0.0)
        std::printf("explained within 2 cm and %g mm of noise: %.1f %%\n", 1000.0 * report.noise,
                    100.0 * score.explained_2cm_noise);
    std::printf("R_s %.3f with a tolerance of %g mm, %.3f without\n", fidelity.skeleton,
                1000.0 * fidelity.tolerance, fidelity.skeleton_strict);
    if (report.photos) print_fidelity(*report.photos, fidelity.skeleton, report.source);
    if (report.outline) print_outline(*report.outline, report.source);
    for (size_t order = 0; order < fidelity.by_order.size(); order++)
        print_part(order == 0 ? "trunk" : ("order " + std::to_string(order)).c_str(),
                   fidelity.by_order[order]);
    print_part("all", fidelity.all);
    for (const LevelFidelity& level : report.levels)
        print_part((std::to_string(level.nodes) + " nodes").c_str(), level.all);
    constexpr size_t kShown = 5;
    std::printf("%zu clusters of points that no branch explains\n", report.unexplained.size());
    for (size_t i = 0; i < std::min(kShown, report.unexplained.size()); i++) {
        const UnexplainedCluster& cluster = report.unexplained[i];
        const DVec3 centre = tree.frame().to_scan(cluster.centre);
        std::printf("  %zu points, %.2f m, around %.2f %.2f %.2f, %.2f m from node %d\n",
                    cluster.points.size(), cluster.size, centre.x, centre.y, centre.z, cluster.gap,
                    cluster.joint);
    }
    std::printf("%zu doubtful branches\n", report.doubtful.size());
    for (size_t i = 0; i < std::min(kShown, report.doubtful.size()); i++) {
        const DoubtfulBranch& branch = report.doubtful[i];
        std::printf("  node %d: %.2f m, %zu points: %s\n", branch.node, branch.length, branch.points,
                    doubt_text(branch.reasons).c_str());
    }
}

// The tree and its scan in pictures. cloud: in any frame.
Image score_sheet(const Tree& tree, PointCloud cloud, const std::vector<OutlinePart>& parts,
                  const ScanReport& report, const PhotoJudge* judge, const OutlineFolders& folders,
                  const std::string& name, Progress* progress) {
    for (Vec3& p : cloud.positions)
        p = Vec3(tree.frame().to_tree(cloud.frame.to_scan(DVec3(p))));
    cloud.frame = tree.frame();
    SheetPhotos photos;
    if (judge != nullptr) photos = {read_photo_model(folders.model), folders.photos};
    SheetSubject subject{name, tree, parts, cloud};
    if (judge != nullptr && !folders.photos.empty()) subject.photos = &photos;
    return fidelity_sheet(
        subject, {report.fidelity, cloud, judge, report.outline ? &*report.outline : nullptr}, progress);
}

Tree read_scaled(const Arguments& arguments, const std::string& path, const std::string& option,
                 double metres_per_unit) {
    Tree tree = skeleton_from(arguments, path, option, told_dialect_from(arguments));
    if (metres_per_unit > 0.0) tree.scale(metres_per_unit / tree.frame().metres_per_unit);
    return tree;
}

}  // namespace

const Command& score_command() {
    static const Command command{
        "score",
        "score MODEL REFERENCE [--json] [options]",
        "Compares a skeleton with its scan, or with a reference skeleton.",
        {{"--json", "", "as JSON"},
         {"--noise", "S", "the scan's range noise in metres (default 0)"},
         {"--tolerance", "M", "metres from the bark within which a point is explained (default 0.02)"},
         {"--levels", "N", "lightened to a half, a quarter and so on as well (default 1: the tree alone)"},
         {"--photos", "FOLDER", "a COLMAP model in the scan's coordinates, for I, R_3d and Q; with --masks"},
         {"--masks", "FOLDER", "white-on-black pictures of the tree's outline in these photos: PHOTO.png"},
         {"--pictures", "FOLDER",
          "the photos themselves, for --sheet; without --masks their sky judges: precision only"},
         {"--every", "N", "every N-th photo of the model alone, by name: those that '--hold-out N' held out"},
         {"--leaves", "PRESET", "the tree's leaves, for its outline in the photos (default none)"},
         {"--view-weight", "W", "a/b: how much less each further photo tells, 0 to 1, for I (default 0.8)"},
         {"--sheet", "FILE.png",
          "a picture of it: photo, outline, cloud and tree with Q (--pictures), else the cloud, its\n"
          "distances to the bark, the skeleton and the tree"},
         {"--scale", "S", "metres per unit of the files (default: what the model's file says, else 1)"},
         {"--tree", "N", "which tree of a model's file with several, in its order (default: the largest)"},
         {"--reference-tree", "N", "likewise of a reference's file"},
         {"--dialect", "NAME", "of L-strings: turtle or paper (default: as they say themselves, or turtle)"},
         {"--columns", "LIST", "names of a text scan's columns, such as x,y,z,r,g,b; - skips one"},
         {"--classes", "LIST",
          "classes of LAS points to read, such as 2,4-5, or all (default: all but noise, 7 and 18)"},
         {"--quiet", "", "no progress"}},
        "MODEL: a tree file (.txt), a skeleton (.ply) or a table of nodes or of cylinders (.csv), as "
        "'reconstruct' writes "
        "them.\n"
        "REFERENCE: a point cloud, or a skeleton in any of these formats, in the same coordinates.\n"
        "Against a scan: how far the points lie from the nearest bark (each segment a cylinder), as a whole\n"
        "and by order of branching; R_s, the share of points in the balls and frusta of the skeleton; what "
        "no\n"
        "branch explains, and which branches are doubtful.\n"
        "Against a skeleton: the share of the model's wood near the reference's axis (precision), of the\n"
        "reference's near the model's (recall), sampled every millimetre, within shares of the reference's\n"
        "radius and within centimetres."};
    return command;
}

void run_score(const std::vector<std::string>& words) {
    const Arguments arguments(score_command(), words);
    if (arguments.positional().size() != 2) throw UsageError("Name a model and a reference.");
    const std::string& model = arguments.positional()[0];
    const std::string& reference = arguments.positional()[1];
    const double noise = arguments.number("--noise", 0.0, 0.0, 10.0);
    const double scale = arguments.number("--scale", 0.0, 1e-9, 1e9);
    const bool as_json = arguments.has("--json");
    FidelityOptions options;
    options.tolerance = arguments.number("--tolerance", options.tolerance, 0.0, 10.0);
    const int levels = static_cast<int>(arguments.whole("--levels", 1, 1, 12));
    const std::string photos = arguments.text("--photos", ""), masks = arguments.text("--masks", "");
    const std::string pictures = arguments.text("--pictures", ""), sheet = arguments.text("--sheet", "");
    if (photos.empty() != (masks.empty() && pictures.empty()))
        throw UsageError(
            "--photos and --masks belong together: R_3d needs the outline of the tree in each photo, or its "
            "sky (--pictures).");
    for (const char* name : {"--every", "--view-weight"})
        if (photos.empty() && arguments.has(name))
            throw UsageError(std::string(name) + " is for photos: --photos and --masks name them.");
    if (photos.empty() && !arguments.has("--sheet") && arguments.has("--leaves"))
        throw UsageError("--leaves is for photos and for --sheet: --photos and --masks name them.");
    if (arguments.has("--sheet")) require_png(sheet);
    const size_t every = arguments.whole("--every", 0, 2, 1000);
    const double weight = arguments.number("--view-weight", kInformationRatio, 0.0, 1.0);
    const std::string leaves = arguments.text("--leaves", "none");
    const LeafRules rules = as_usage([&] { return leaf_preset(leaves); });
    const Tree tree = read_scaled(arguments, model, "--tree", scale);
    TerminalProgress progress(arguments.has("--quiet") || as_json);
    if (is_skeleton_file(reference)) {
        const Tree wanted = read_scaled(arguments, reference, "--reference-tree", scale);
        const SkeletonScore score = score_skeleton(tree, wanted, &progress);
        progress.clear();
        print_skeleton_score(score, as_json);
    } else {
        SubProgress reading(&progress, 0.0, 0.3);
        const PointCloud cloud = read_cloud(reference, read_options_from(arguments), nullptr, &reading);
        ScanReport report;
        std::optional<PhotoJudge> judge;
        std::vector<OutlinePart> parts;
        if (!photos.empty() || arguments.has("--sheet"))
            parts = outline_parts(tree, rules, leaves, 1, {}, &progress);
        if (!photos.empty()) {
            judge = photo_judge({photos, masks, pictures}, every, cloud, &reading);
            report.photos = judge->cloud();
            report.photos->information = photo_information(report.photos->photos.size(), weight);
            report.outline = judge->judge(parts, tree.frame(), &progress);
            report.source = judge->source();
        }
        SubProgress scoring(&progress, 0.3, 1.0);
        score_against_scan(report, tree, cloud, noise, options, levels, &scoring);
        if (arguments.has("--sheet"))
            write_png(sheet, score_sheet(tree, cloud, parts, report, judge ? &*judge : nullptr,
                                         {photos, masks, pictures}, stem_of(model), &progress));
        progress.clear();
        if (as_json)
            std::printf("%s\n", scan_report_json(report, tree).c_str());
        else
            print_text(report, tree);
    }
}

}  // namespace treerec
