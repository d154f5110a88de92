#include "pipeline/scan_report.h"

#include <nlohmann/json.hpp>

namespace treerec {

namespace {

using Json = nlohmann::ordered_json;

Json part_json(const FidelityPart& part) {
    return {
        {"points", part.points},       {"explained", part.explained},   {"median_mm", 1000.0 * part.median},
        {"p95_mm", 1000.0 * part.p95}, {"mean_mm", 1000.0 * part.mean}, {"length_m", part.length},
        {"bark_m2", part.bark},        {"coverage", part.coverage}};
}

Json point_json(const DVec3& v) {
    return Json::array({v.x, v.y, v.z});
}

}  // namespace

void score_against_scan(ScanReport& report, const Tree& tree, const PointCloud& cloud, double noise,
                        const FidelityOptions& options, int levels, Progress* progress) {
    SubProgress scoring(progress, 0.0, 0.4), judging(progress, 0.4, 1.0);
    report.noise = noise;
    report.score = score_scan(tree, cloud, noise, &scoring);
    report.fidelity = measure_fidelity(tree, cloud, options, &judging);
    if (levels > 1) report.levels = measure_levels(tree, cloud, levels, options, &judging);
    report.unexplained = find_unexplained(tree, cloud, report.fidelity, {}, {}, &judging);
    report.doubtful = find_doubtful(tree, report.fidelity);
}

std::string scan_report_json(const ScanReport& report, const Tree& tree) {
    Json json;
    const ScanScore& score = report.score;
    json["reference"] = "point cloud";
    json["points"] = score.points;
    json["median_mm"] = score.median_mm;
    json["mean_mm"] = score.mean_mm;
    json["p95_mm"] = score.p95_mm;
    json["explained_2cm"] = score.explained_2cm;
    json["noise_m"] = report.noise;
    json["explained_2cm_noise"] = score.explained_2cm_noise;
    Json fidelity;
    fidelity["tolerance_m"] = report.fidelity.tolerance;
    fidelity["R_s"] = report.fidelity.skeleton;
    fidelity["R_s_strict"] = report.fidelity.skeleton_strict;
    if (report.photos) {
        fidelity["I"] = report.photos->information;
        fidelity["R_3d"] = report.photos->reconstruction;
        fidelity["R_3d_seen"] = report.photos->seen;
        fidelity["Q"] = modelling_fidelity(*report.photos, report.fidelity);
        const Overlap& outline = report.outline->mean;
        const bool known = report.source == OutlineSource::kMasks;
        fidelity["by"] = outline_source_name(report.source);
        fidelity["recall"] = known ? Json(outline.recall) : Json(nullptr);
        fidelity["precision"] = outline.precision;
        fidelity["iou"] = known ? Json(outline.iou) : Json(nullptr);
        for (const PhotoHits& photo : report.photos->photos)
            fidelity["photos"].push_back(
                {{"name", photo.name}, {"inside", photo.inside}, {"outside", photo.outside}});
    }
    fidelity["all"] = part_json(report.fidelity.all);
    fidelity["by_order"] = Json::array();
    for (const FidelityPart& part : report.fidelity.by_order)
        fidelity["by_order"].push_back(part_json(part));
    if (!report.levels.empty()) fidelity["levels"] = Json::array();
    for (const LevelFidelity& level : report.levels) {
        Json entry{{"nodes", level.nodes}, {"R_s", level.skeleton}};
        entry.update(part_json(level.all));
        fidelity["levels"].push_back(entry);
    }
    json["fidelity"] = fidelity;
    json["unexplained"] = Json::array();
    for (const UnexplainedCluster& cluster : report.unexplained)
        json["unexplained"].push_back(
            {{"points", cluster.points.size()},
             {"size_m", cluster.size},
             {"centre", point_json(tree.frame().to_scan(cluster.centre))},
             {"joint", cluster.joint},
             {"gap_m", cluster.gap},
             {"direction", point_json(tree.frame().turn_to_scan(cluster.direction))}});
    json["doubtful"] = Json::array();
    for (const DoubtfulBranch& branch : report.doubtful)
        json["doubtful"].push_back({{"node", branch.node},
                                    {"attach", branch.attach},
                                    {"reasons", doubt_text(branch.reasons)},
                                    {"doubt", branch.doubt},
                                    {"length_m", branch.length},
                                    {"points", branch.points}});
    // Names of photos may hold bytes that are no UTF-8.
    return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace treerec
