// treerec sketch BRANCH.json --onto TREE: branches drawn over a scan.
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>

#include "cli/commands.h"
#include "cli/terminal_progress.h"
#include "edit/commands/script.h"
#include "fidelity/fidelity.h"
#include "file_bytes.h"
#include "pipeline/export.h"
#include "scan/formats/read_cloud.h"
#include "sketch/read_branch.h"
#include "sketch/sketch_branch.h"
#include "version.h"

namespace treerec {

namespace {

using Json = nlohmann::ordered_json;

Json place_json(const DVec3& v) {
    return Json::array({v.x, v.y, v.z});
}

Json branch_report(const Tree& tree, const SketchedBranch& branch, size_t stroke) {
    Json axis = Json::array();
    for (const BranchPlace& place : branch.axis)
        axis.push_back({{"place", place_json(tree.frame().to_scan(place.position))},
                        {"radius_m", place.radius},
                        {"measured", place.measured}});
    return {{"stroke", stroke},
            {"host", branch.host},
            {"length_m", branch.length},
            {"base_radius_m", branch.axis.front().radius},
            {"measured", branch.measured},
            {"twigs", branch.twigs},
            {"nodes", branch.scion.size() - 1},
            {"command", branch.command},
            {"axis", axis},
            {"remarks", branch.remarks}};
}

Json fidelity_json(const Fidelity& fidelity) {
    return {{"points", fidelity.points},
            {"tolerance_m", fidelity.tolerance},
            {"R_s", fidelity.skeleton},
            {"explained", fidelity.all.explained},
            {"median_mm", 1000.0 * fidelity.all.median},
            {"p95_mm", 1000.0 * fidelity.all.p95},
            {"mean_mm", 1000.0 * fidelity.all.mean},
            {"coverage", fidelity.all.coverage},
            {"length_m", fidelity.all.length}};
}

// The wood of a cloud whose file tells leaves; else empty.
std::vector<uint8_t> wood_of(const PointCloud& cloud) {
    std::vector<uint8_t> wood;
    if (cloud.labels.empty() || !cloud.labels.leaf_is_one) return wood;
    for (const uint8_t label : cloud.labels.values)
        wood.push_back(label == 1 ? 0 : 1);
    return wood;
}

}  // namespace

void run_sketch_onto(const Arguments& arguments) {
    const std::string& path = arguments.positional()[0];
    const std::vector<std::string> none;
    const std::vector<std::string>& outs = arguments.has("-o") ? arguments.all("-o") : none;
    const bool report = arguments.has("--report");
    for (const char* name :
         {"--height", "--trunk-radius", "--depth", "--crown", "--density", "--twigs-of", "--twigs"})
        if (arguments.has(name))
            throw UsageError(std::string(name) + " is for a sketch of a whole tree, not for --onto.");
    const ExportOptions exports = exports_from(arguments, "--species");
    try {
        for (const std::string& out : outs)
            require_writable_format(out);
        if (arguments.has("--log"))
            require_own(arguments.text("--log", ""), "# treerec edit log ", "no log of edits");
    } catch (const UsageError&) {
        throw;
    } catch (const Error& error) {
        throw UsageError(error.what());
    }
    const bool quiet = arguments.has("--quiet");
    TerminalProgress progress(quiet || report);
    progress.update(0.0, "Reading");
    Tree tree = skeleton_from(arguments, arguments.text("--onto", ""));
    const std::vector<BranchStroke> strokes = read_branch_strokes(path, tree.frame());
    std::optional<PointCloud> cloud;
    std::vector<uint8_t> wood;
    std::optional<FidelityTracker> tracker;
    std::optional<Fidelity> before;
    if (arguments.has("--scan")) {
        SubProgress reading(&progress, 0.0, 0.3);
        cloud = read_cloud(arguments.text("--scan", ""), {}, nullptr, &reading);
        wood = wood_of(*cloud);
        if (report || !quiet) {
            tracker.emplace(*cloud);
            before = tracker->update(tree, &progress);
        }
    }
    Json branches = Json::array();
    std::vector<SketchedBranch> drawn;
    EditLog log;
    for (size_t i = 0; i < strokes.size(); i++) {
        const double done = static_cast<double>(i) / static_cast<double>(strokes.size());
        SubProgress drawing(&progress, 0.4 + 0.4 * done,
                            0.4 + 0.4 * (done + 1.0 / static_cast<double>(strokes.size())));
        SketchedBranchOptions options;
        options.seed = exports.seed + i;
        try {
            drawn.push_back(
                sketch_branch(tree, cloud ? &*cloud : nullptr, strokes[i], options, wood, &drawing));
        } catch (const Cancelled&) {
            throw;
        } catch (const Error& error) {
            if (strokes.size() == 1) throw;
            throw Error("Stroke " + std::to_string(i + 1) + ": " + error.what());
        }
        if (report) branches.push_back(branch_report(tree, drawn.back(), i + 1));
        log.add(perform(tree, drawn.back().command, {}));
    }
    std::optional<Fidelity> after;
    if (tracker) after = tracker->update(tree, &progress);
    TreeExporter exporter(tree, exports, &progress);
    for (const std::string& out : outs)
        exporter.write(out);
    if (arguments.has("--log")) write_file(arguments.text("--log", ""), log.text());
    progress.clear();
    if (report) {
        Json json;
        json["format_version"] = 1;
        json["version"] = kVersion;
        json["seed"] = exports.seed;
        json["branches"] = branches;
        json["limbs"] = branches;  // the old word
        if (before) json["fidelity_before"] = fidelity_json(*before);
        if (after) json["fidelity_after"] = fidelity_json(*after);
        std::printf("%s\n", json.dump(2).c_str());
    }
    if (quiet || report) return;
    for (size_t i = 0; i < drawn.size(); i++) {
        const SketchedBranch& branch = drawn[i];
        for (const std::string& remark : branch.remarks)
            std::fprintf(stderr, "stroke %zu: %s\n", i + 1, remark.c_str());
        std::printf("a %.2f m long branch on node %d, %.0f %% of it measured, with %zu twigs\n",
                    branch.length, branch.host, 100.0 * branch.measured, branch.twigs);
    }
    if (before && after)
        std::printf("explained points: %.2f %% before, %.2f %% after\n", 100.0 * before->all.explained,
                    100.0 * after->all.explained);
    for (const std::string& out : outs)
        std::printf("wrote %s\n", out.c_str());
    if (arguments.has("--log")) std::printf("wrote %s\n", arguments.text("--log", "").c_str());
}

}  // namespace treerec
