#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "bench.h"
#include "child.h"
#include "exchange/tree_files.h"
#include "fidelity/score.h"
#include "file_bytes.h"
#include "scan/formats/read_cloud.h"
#include "tree/measure.h"

namespace treerec::bench {

namespace {

using Json = nlohmann::json;

// Of all end branches, from their tip back to the last fork, the share shorter than 5 cm.
double short_tips(const Tree& tree) {
    constexpr double kShort = 0.05;
    size_t tips = 0, brief = 0;
    for (NodeId id : tree.nodes_of_kind(NodeKind::kLeaf)) {
        double length = 0.0;
        for (NodeId at = id; tree.node(at).parent != kNoNode;) {
            const NodeId parent = tree.node(at).parent;
            length += glm::distance(tree.node(at).position, tree.node(parent).position);
            if (tree.node(parent).child_count > 1) break;
            at = parent;
        }
        tips++;
        brief += length < kShort;
    }
    return tips ? static_cast<double>(brief) / static_cast<double>(tips) : 0.0;
}

std::string last_line(const std::string& text) {
    const size_t end = text.find_last_not_of("\r\n ");
    if (end == std::string::npos) return "";
    const size_t start = text.find_last_of("\r\n", end);
    return text.substr(start == std::string::npos ? 0 : start + 1,
                       end - (start == std::string::npos ? 0 : start + 1) + 1);
}

struct Place {
    const PointCloud& cloud;
    std::string truth;  // the corrected skeleton's file, or none
};

// What can be said about any program's tree: from its surface on.
void print_fit(const Tree& tree, const Place& place) {
    const ScanScore fit = score_scan(tree, place.cloud);
    char surface[60];
    std::snprintf(surface, sizeof surface, "%.1f / %.1f / %.1f", fit.median_mm, fit.mean_mm, fit.p95_mm);
    const Measurements m = measure(tree);
    std::printf(" %6zu %6zu %7.1f %8.2f %22s %9.1f %6.1f", m.nodes, m.tips, 100.0 * m.dbh, m.height, surface,
                100.0 * fit.explained_2cm, 100.0 * short_tips(tree));
    if (place.truth.empty()) return;
    const SkeletonScore score = score_skeleton(tree, read_skeleton(place.truth));
    std::printf("  %6.3f %9.3f %+8.1f", score.match.recall, score.match.precision,
                100.0 * score.length_error);
}

}  // namespace

std::string truth_of(const std::string& scan, const std::string& folder) {
    if (folder.empty()) return "";
    const std::string start = stem_of(scan) + "_skeleton_corrected";
    for (const auto& entry : std::filesystem::directory_iterator(path_of(folder))) {
        const std::string path = utf8_of(entry.path());
        if (extension_of(path) == "csv" && stem_of(path).starts_with(start)) return path;
    }
    return "";
}

// Surface figures are of all the scan's points, also of those that cleaning removes.
void bench_scans(const std::vector<std::string>& scans, const Settings& settings) {
    std::printf("%-38s %8s %7s %7s %5s %4s %6s %6s %7s %8s %22s %9s %6s", "scan", "points", "wall s", "CPU s",
                "MB", "warn", "nodes", "tips", "DBH cm", "height m", "mm median/mean/p95", "in 2 cm %",
                "<5cm %");
    std::printf(settings.truth.empty() ? "\n" : "  recall precision length %%\n");
    for (const std::string& scan : scans) {
        const ScratchFolder folder;
        const std::string table = folder.file("tree.txt"), report = folder.file("report.json");
        const std::string name = std::filesystem::path(scan).filename().string();
        const ChildRun run = run_child({settings.program, "reconstruct", scan, "-o", folder.file("tree.glb"),
                                        "-o", table, "--report", report, "--quiet"});
        if (run.exit_code != 0) {
            std::printf("%-38s %s\n", name.c_str(), last_line(run.output).c_str());
            continue;
        }
        const Json facts = Json::parse(read_file(report).view());
        const PointCloud cloud = read_cloud(scan);
        const Place place{cloud, truth_of(scan, settings.truth)};
        std::printf("%-38s %8zu %7.2f %7.2f %5.0f %4zu", name.c_str(), facts["points_read"].get<size_t>(),
                    run.wall_s, run.cpu_s, run.peak_mb, facts["warnings"].size());
        print_fit(read_skeleton(table), place);
        std::printf("\n");
        const std::string other = settings.models + "/" + stem_of(scan) + ".txt";
        if (!settings.models.empty() && std::filesystem::exists(path_of(other))) {
            std::printf("  %-36s %8s %7s %7s %5s %4s", "the other program's", "", "", "", "", "");
            print_fit(read_skeleton(other), place);
            std::printf("\n");
        }
        std::fflush(stdout);
    }
}

}  // namespace treerec::bench
