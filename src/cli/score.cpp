#include <cstdio>
#include <nlohmann/json.hpp>

#include "cli/commands.h"
#include "cli/terminal_progress.h"
#include "exchange/tree_files.h"
#include "fidelity/score.h"
#include "scan/read_cloud.h"

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

void print_scan_score(const ScanScore& score, double noise, bool as_json) {
    if (as_json) {
        Json json;
        json["reference"] = "point cloud";
        json["points"] = score.points;
        json["median_mm"] = score.median_mm;
        json["mean_mm"] = score.mean_mm;
        json["p95_mm"] = score.p95_mm;
        json["explained_2cm"] = score.explained_2cm;
        json["noise_m"] = noise;
        json["explained_2cm_noise"] = score.explained_2cm_noise;
        std::printf("%s\n", json.dump(2).c_str());
        return;
    }
    std::printf("%zu points; distance to the bark: median %.1f, mean %.1f, 95 %% within %.1f mm\n",
                score.points, score.median_mm, score.mean_mm, score.p95_mm);
    std::printf("explained within 2 cm: %.1f %%\n", 100.0 * score.explained_2cm);
    if (noise > 0.0)
        std::printf("explained within 2 cm and %g mm of noise: %.1f %%\n", 1000.0 * noise,
                    100.0 * score.explained_2cm_noise);
}

Tree read_scaled(const std::string& path, UpAxis up, double metres_per_unit) {
    Tree tree = read_skeleton(path, up);
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
         {"--scale", "S", "metres per unit of the files (default: what the model's file says, else 1)"},
         {"--columns", "LIST", "names of a text scan's columns, such as x,y,z,r,g,b; - skips one"},
         {"--quiet", "", "no progress"}},
        "MODEL: a tree file (.txt), a skeleton (.ply) or a table of nodes or of cylinders (.csv), as "
        "'reconstruct' writes "
        "them.\n"
        "REFERENCE: a point cloud, or a skeleton in any of these formats, in the same coordinates.\n"
        "Against a scan: how far the points lie from the nearest bark (each segment a cylinder).\n"
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
    const Tree tree = read_scaled(model, UpAxis::kZ, scale);
    TerminalProgress progress(arguments.has("--quiet") || as_json);
    if (is_skeleton_file(reference)) {
        const Tree wanted = read_scaled(reference, UpAxis::kZ, scale);
        const SkeletonScore score = score_skeleton(tree, wanted, &progress);
        progress.clear();
        print_skeleton_score(score, as_json);
    } else {
        SubProgress reading(&progress, 0.0, 0.3);
        const PointCloud cloud = read_cloud(reference, {columns_from(arguments)}, nullptr, &reading);
        SubProgress scoring(&progress, 0.3, 1.0);
        const ScanScore score = score_scan(tree, cloud, noise, &scoring);
        progress.clear();
        print_scan_score(score, noise, as_json);
    }
}

}  // namespace treerec
