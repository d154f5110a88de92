#include <cstdio>
#include <nlohmann/json.hpp>

#include "cli/commands.h"
#include "cli/terminal_progress.h"
#include "exchange/tree_files.h"
#include "geometry/bounds.h"
#include "pipeline/report.h"
#include "scan/formats/read_cloud.h"

namespace treerec {

namespace {

using Json = nlohmann::ordered_json;

Json vector_json(const DVec3& v) {
    return Json::array({v.x, v.y, v.z});
}

void print_json(const Json& json) {
    std::printf("%s\n", json.dump(2, ' ', false, Json::error_handler_t::replace).c_str());
}

void info_of_skeleton(const std::string& path, const SkeletonChoice& choice, bool as_json) {
    SkeletonReport report;
    const Tree tree = read_skeleton(path, choice, &report);
    if (as_json) {
        Json json = Json::parse(measurements_json(tree));
        Json all;
        all["file"] = path;
        all["kind"] = "skeleton";
        all["up"] = up_axis_name(tree.frame().up);
        all["tilt_degrees"] = tree.frame().tilt_degrees();
        all["metres_per_unit"] = tree.frame().metres_per_unit;
        all["origin"] = vector_json(tree.frame().origin);
        all["trees"] = report.trees;
        all["tree"] = report.taken;
        all["warnings"] = report.warnings;
        all.update(json);
        print_json(all);
        return;
    }
    const Measurements m = measure(tree);
    std::printf("%s: a skeleton, %s up, %g m per unit\n", path.c_str(), up_axis_name(tree.frame().up),
                tree.frame().metres_per_unit);
    if (report.trees > 1) std::printf("tree           %zu of %zu\n", report.taken, report.trees);
    std::printf("nodes          %zu\ntips           %zu\n", m.nodes, m.tips);
    std::printf("height         %.2f m\n", m.height);
    if (m.dbh > 0.0)
        std::printf("DBH            %.1f cm (%d stem%s)\n", 100.0 * m.dbh, m.stems, m.stems == 1 ? "" : "s");
    else
        std::printf("DBH            none: %s\n",
                    m.height < kBreastHeight ? "it is lower than breast height" : "no wood at breast height");
    std::printf("crown radius   %.2f m\ncrown base     %.2f m\n", m.crown_radius, m.crown_base);
    std::printf("length         %.1f m\nwood           %.4f m3\n", m.total_length, m.volume);
    std::printf("measured       %.0f %% of the length\n", 100.0 * m.measured_share);
    for (size_t order = 0; order < m.by_order.size(); order++)
        std::printf("order %-2zu       %zu branch%s, %.1f m\n", order, m.by_order[order].branches,
                    m.by_order[order].branches == 1 ? "" : "es", m.by_order[order].length);
    for (const std::string& warning : report.warnings)
        std::fprintf(stderr, "Warning: %s\n", warning.c_str());
}

void info_of_cloud(const std::string& path, const ReadCloudOptions& options, bool as_json) {
    ReadCloudReport report;
    TerminalProgress progress(true);
    const PointCloud cloud = read_cloud(path, options, &report, &progress);
    if (!cloud.unit.doubt.empty()) report.warnings.push_back(cloud.unit.doubt);
    Bounds bounds;
    for (const Vec3& p : cloud.positions)
        bounds.add(cloud.frame.to_scan(DVec3(p)));
    if (as_json) {
        Json json;
        json["file"] = path;
        json["kind"] = "point cloud";
        json["format"] = report.format;
        json["points"] = cloud.size();
        json["colors"] = cloud.has_colors();
        json["normals"] = cloud.has_normals();
        json["labels"] = cloud.labels.empty() ? Json(nullptr) : Json(cloud.labels.column);
        json["metres_per_unit"] = cloud.unit.metres > 0.0 ? Json(cloud.unit.metres) : Json(nullptr);
        json["min"] = vector_json(bounds.min);
        json["max"] = vector_json(bounds.max);
        json["warnings"] = report.warnings;
        print_json(json);
        return;
    }
    const DVec3 size = bounds.size();
    std::printf("%s: a point cloud, %s\n", path.c_str(), report.format.c_str());
    std::printf("points         %zu%s%s%s\n", cloud.size(), cloud.has_colors() ? ", with colours" : "",
                cloud.has_normals() ? ", with normals" : "",
                cloud.labels.empty() ? "" : (", with labels in " + quote_word(cloud.labels.column)).c_str());
    for (int axis = 0; axis < 3; axis++)
        std::printf("%c              %.3f to %.3f (%.3f)\n", "xyz"[axis], bounds.min[axis], bounds.max[axis],
                    size[axis]);
    for (const std::string& warning : report.warnings)
        std::fprintf(stderr, "Warning: %s\n", warning.c_str());
}

}  // namespace

const Command& info_command() {
    static const Command command{
        "info",
        "info FILE [--json] [--up AXIS] [--tree N] [--dialect NAME] [--columns LIST] [--classes LIST]",
        "Tells what is in a point cloud or a skeleton file.",
        {{"--json", "", "as JSON"},
         {"--up", "AXIS", "the axis to the sky of a skeleton that does not say: x y z -x -y -z (default z)"},
         {"--tree", "N", "which tree of a file with several, in its order (default: the largest)"},
         {"--dialect", "NAME", "of an L-string: turtle or paper (default: as it says itself, or turtle)"},
         {"--columns", "LIST", "names of a text file's columns, such as x,y,z,r,g,b; - skips one"},
         {"--classes", "LIST",
          "classes of LAS points to read, such as 2,4-5, or all (default: all but noise, 7 and 18)"}},
        "FILE: a point cloud (as for reconstruct), or a skeleton: a tree file, a table of nodes, the "
        "cylinders of\n"
        "TreeQSM, SimpleForest, aRchi, Treegraph or rTwig (text, csv), a skeleton PLY (AdTree's too), SWC, "
        "MTG, an "
        "L-string."};
    return command;
}

void run_info(const std::vector<std::string>& words) {
    const Arguments arguments(info_command(), words);
    if (arguments.positional().size() != 1) throw UsageError("Name one file.");
    const std::string path = arguments.positional()[0];
    const UpAxis up = up_axis_from(arguments);
    const size_t tree = arguments.whole("--tree", 0, 1, 1'000'000'000);
    const std::optional<LStringDialect> dialect = told_dialect_from(arguments);
    if (is_skeleton_file(path))
        info_of_skeleton(path, {up, tree, dialect}, arguments.has("--json"));
    else
        info_of_cloud(path, read_options_from(arguments), arguments.has("--json"));
}

}  // namespace treerec
