#include "pipeline/report.h"

#include <nlohmann/json.hpp>

#include "fidelity/fidelity.h"
#include "fidelity/score.h"
#include "version.h"

#if defined(__unix__) || defined(__APPLE__)
#include <sys/resource.h>
#endif

namespace treerec {

namespace {

using Json = nlohmann::ordered_json;

void add_measurements(Json& json, const Measurements& m) {
    json["nodes"] = m.nodes;
    json["tips"] = m.tips;
    Json orders = Json::array();
    for (size_t order = 0; order < m.by_order.size(); order++)
        orders.push_back({{"order", order},
                          {"count", m.by_order[order].branches},
                          {"length_m", m.by_order[order].length}});
    json["branches"] = orders;
    json["height_m"] = m.height;
    json["dbh_m"] = m.dbh > 0.0 ? Json(m.dbh) : Json(nullptr);
    json["stems"] = m.stems;
    json["crown_radius_m"] = m.crown_radius;
    json["crown_base_m"] = m.crown_base;
    json["length_m"] = m.total_length;
    json["volume_m3"] = m.volume;
    json["measured_share"] = m.measured_share;
    json["measured_volume_share"] = m.measured_volume_share;
}

Json vector_json(const DVec3& v) {
    return Json::array({v.x, v.y, v.z});
}

Json options_json(const ReportDetails& details) {
    const ReconstructOptions& options = details.options;
    Json clean;
    clean["extreme_colors"] = options.clean.remove_extreme_colors;
    clean["outliers"] = options.clean.remove_outliers;
    clean["fragments"] = options.clean.remove_fragments;
    clean["ground"] = options.clean.remove_ground;
    Json json;
    json["up"] = options.orient.up ? up_axis_name(*options.orient.up) : "auto";
    json["scale"] = options.orient.metres_per_unit ? Json(*options.orient.metres_per_unit) : Json("auto");
    json["known_height_m"] = options.orient.known_height ? Json(*options.orient.known_height) : Json(nullptr);
    json["known_length_m"] =
        options.orient.known_length ? Json(options.orient.known_length->metres) : Json(nullptr);
    json["skeleton"] = skeleton_method_name(options.skeleton.method);
    json["radii"] = radius_rule_name(options.radii);
    if (options.skeleton.method == SkeletonMethod::kDelaunay)
        json["spanning_tree"] = spanning_tree_kind_name(options.skeleton.spanning_tree);
    if (options.skeleton.method == SkeletonMethod::kFlood) {
        json["flood"] = flood_kind_name(options.skeleton.flood);
        json["voxel_m"] = options.skeleton.voxel > 0.0 ? Json(options.skeleton.voxel) : Json("auto");
    }
    json["spacing_m"] = options.skeleton.spacing > 0.0 ? Json(options.skeleton.spacing) : Json("auto");
    json["columns"] = options.read.columns;
    json["classes"] = options.read.classes ? Json(*options.read.classes) : Json("auto");
    json["leaves"] = details.leaves;
    json["tell_leaves"] = options.tell_leaves;
    json["complete"] = options.complete;
    json["prune"] = !options.prune ? Json(nullptr) : Json(options.prune->spare_leader ? "leader" : "paper");
    const PickOptions& pick = options.clean.pick;
    json["tree"] = !pick.enabled || pick.position ? Json(nullptr) : Json(pick.number);
    json["tree_at"] = pick.position ? vector_json(*pick.position) : Json(nullptr);
    json["one_tree"] = !pick.enabled;
    json["clean"] = clean;
    return json;
}

Json part_json(const FidelityPart& part) {
    return {{"points", part.points},       {"explained", part.explained}, {"median_mm", 1000.0 * part.median},
            {"p95_mm", 1000.0 * part.p95}, {"length_m", part.length},     {"coverage", part.coverage}};
}

// Of about so many points of the wood as the fit is of in the editor.
Json fidelity_json(const Reconstruction& result) {
    constexpr size_t kPoints = 200000;
    PointCloud wood = wood_of(result);
    wood.positions = sample_points(wood.positions, kPoints);
    const Fidelity fidelity = measure_fidelity(result.tree, wood);
    Json json = part_json(fidelity.all);
    json["tolerance_m"] = fidelity.tolerance;
    json["R_s"] = fidelity.skeleton;
    json["R_s_strict"] = fidelity.skeleton_strict;
    json["orders"] = Json::array();
    for (const FidelityPart& part : fidelity.by_order)
        json["orders"].push_back(part_json(part));
    return json;
}

Json bark_json(const PhotoBark& bark) {
    const auto millimetres = [](double metres) { return metres > 0.0 ? Json(1000.0 * metres) : Json(); };
    return {{"from", bark.textures ? "photos" : "drawn"},
            {"why_drawn", bark.textures ? Json() : Json(bark.why_not)},
            {"photos", bark.photos},
            {"pixel_mm", millimetres(bark.pixel)},
            {"detail_mm", millimetres(bark.detail)},
            {"area_m2", bark.area}};
}

Json leaf_colours_json(const LeafColours& colours) {
    const auto color = [](const DVec3& v) { return Json{v.x, v.y, v.z}; };
    Json json = {{"from", colours.seen() ? "photos" : "drawn"},
                 {"why_drawn", colours.seen() ? Json() : Json(colours.why_not)},
                 {"photos", colours.photos},
                 {"points", colours.points}};
    if (!colours.seen()) return json;
    json.update({{"albedo", color(colours.albedo)},
                 {"as_seen", color(colours.as_seen)},
                 {"greenest", color(colours.greenest)},
                 {"least_green", color(colours.least_green)},
                 {"tone_spread", colours.tone_spread},
                 {"low", color(colours.low)},
                 {"high", color(colours.high)},
                 {"low_height_m", colours.low_height},
                 {"high_height_m", colours.high_height},
                 {"bands", Json::array()}});
    for (const LeafBand& band : colours.bands)
        json["bands"].push_back({{"low_m", band.low},
                                 {"high_m", band.high},
                                 {"color", color(band.colour)},
                                 {"points", band.points}});
    return json;
}

Json marker_json(const MarkerScale& scale) {
    Json markers = Json::array();
    for (const MeasuredMarker& marker : scale.markers)
        markers.push_back({{"id", marker.id},
                           {"photos", marker.photos},
                           {"kept", marker.kept},
                           {"parallax_degrees", marker.parallax},
                           {"side_units", marker.side > 0.0 ? Json(marker.side) : Json()},
                           {"uneven", marker.uneven},
                           {"why_not", marker.why_not.empty() ? Json() : Json(marker.why_not)}});
    return {{"photos", scale.photos},
            {"side_m", scale.told_side > 0.0 ? Json(scale.told_side) : Json()},
            {"metres_per_unit", scale.usable() ? Json(scale.metres_per_unit()) : Json()},
            {"spread", scale.spread},
            {"markers", markers}};
}

Json photos_json(const ReportDetails& details) {
    const ColmapRun& run = *details.photos;
    Json cameras = Json::array();
    for (const CameraAround& camera : run.around)
        cameras.push_back({{"name", camera.name}, {"degrees", camera.degrees}, {"away", camera.away}});
    Json gap;
    if (run.widest_gap)
        gap = {
            {"degrees", run.widest_gap->degrees}, {"from", run.widest_gap->from}, {"to", run.widest_gap->to}};
    Json contradictions = Json::array(), weak = Json::array();
    for (const PhotoContradiction& two : run.joints.contradictions)
        contradictions.push_back({{"photos", {two.one, two.other}},
                                  {"shared", two.shared},
                                  {"fitting", two.fitting},
                                  {"own", two.own}});
    for (const PhotoJoint& joint : run.joints.weak)
        weak.push_back(
            {{"from", joint.from}, {"to", joint.to}, {"degrees", joint.degrees}, {"points", joint.points}});
    Json gps;
    if (run.gps.photos > 0)
        gps = {{"photos", run.gps.photos},
               {"fixes", run.gps.fixes},
               {"kept", run.gps.kept},
               {"metres_per_unit", run.gps.metres_per_unit},
               {"relative_error", run.gps.relative_error}};
    Json marker;
    if (details.marker && !details.marker->markers.empty()) marker = marker_json(*details.marker);
    return {{"photos", run.photos},
            {"placed", run.registered},
            {"missing", run.missing},
            {"colmap", run.version},
            {"pairs", details.photo_pairs},
            {"widest_gap", gap},
            {"contradictions", contradictions},
            {"weak_joints", weak},
            {"cameras", cameras},
            {"gps", gps},
            {"marker", marker}};
}

Json outline_json(const OutlineJudgement& outline, double r_s) {
    const bool masks = outline.source == OutlineSource::kMasks;
    const auto shares = [masks](const Overlap& overlap) {
        const auto known = [masks](double share) { return masks ? Json(share) : Json(nullptr); };
        return Json{
            {"recall", known(overlap.recall)}, {"precision", overlap.precision}, {"iou", known(overlap.iou)}};
    };
    Json json = {{"photos", outline.cloud.photos.size()},
                 {"by", outline_source_name(outline.source)},
                 {"hold_out", outline.hold_out},
                 {"I", outline.cloud.information},
                 {"R_3d", outline.cloud.reconstruction},
                 {"R_3d_seen", outline.cloud.seen},
                 {"R_s", r_s},
                 {"Q", outline.cloud.information * outline.cloud.reconstruction * r_s}};
    json.update(shares(outline.shapes.mean));
    json["by_photo"] = Json::array();
    for (const JudgedPhoto& photo : judged_photos(outline)) {
        Json entry = {
            {"name", photo.hits->name}, {"inside", photo.hits->inside}, {"outside", photo.hits->outside}};
        entry.update(photo.overlap ? shares(*photo.overlap)
                                   : Json{{"recall", nullptr}, {"precision", nullptr}, {"iou", nullptr}});
        json["by_photo"].push_back(entry);
    }
    return json;
}

// Paths may hold bytes that are no UTF-8; they must not stop the report.
Json bark_fit_part_json(const BarkFitPart& part) {
    const auto distances = [](const BarkDistances& d) {
        return Json{{"median", d.median}, {"mean", d.mean}, {"p95", d.p95}};
    };
    Json json;
    json["from_m"] = part.from;
    json["to_m"] = part.to;
    json["points"] = part.points;
    json["lumpy"] = part.lumpy;
    json["tubes_m"] = distances(part.tubes);
    json["grown_m"] = distances(part.grown);
    json["nearer"] = part.tubes.mean > 0.0 ? 1.0 - part.grown.mean / part.tubes.mean : 0.0;
    return json;
}

std::string dump(const Json& json) {
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

double peak_memory_mb() {
#if defined(__APPLE__)
    rusage usage{};
    return getrusage(RUSAGE_SELF, &usage) == 0 ? static_cast<double>(usage.ru_maxrss) / (1024.0 * 1024.0)
                                               : 0.0;
#elif defined(__unix__)
    rusage usage{};
    return getrusage(RUSAGE_SELF, &usage) == 0 ? static_cast<double>(usage.ru_maxrss) / 1024.0 : 0.0;
#else
    return 0.0;
#endif
}

std::string measurements_json(const Tree& tree) {
    Json json;
    add_measurements(json, measure(tree));
    return dump(json);
}

std::string skeleton_report_json(const SkeletonReport& report) {
    Json json;
    json["trees"] = report.trees;
    json["tree_taken"] = report.taken;
    json["warnings"] = report.warnings;
    return dump(json);
}

std::string growth_report_json(const GrownTree& grown) {
    Json json;
    json["steps"] = grown.steps;
    json["branches"] = grown.bark.branches.size();
    json["vertices"] = grown.bark.vertices.size();
    json["triangles"] = grown.bark.indices.size() / 3;
    json["warnings"] = grown.remarks;
    return dump(json);
}

std::string growth_proposal_json(const GrowthProposal& proposal) {
    Json json;
    json["burls"] = proposal.burls;
    json["hollows"] = proposal.hollows;
    json["sections"] = proposal.sections;
    json["warnings"] = proposal.remarks;
    return dump(json);
}

std::string bark_fit_json(const BarkFit& fit, const GrownTree& grown) {
    Json json;
    json["bark_fit_version"] = 1;
    json["steps"] = grown.steps;
    json["triangles"] = grown.bark.indices.size() / 3;
    json["warnings"] = grown.remarks;
    json["radii"] = {{"slices", fit.slices}, {"median", fit.radius_median}, {"p95", fit.radius_p95}};
    json["dbh_m"] = nullptr;
    if (fit.dbh_scan > 0.0)
        json["dbh_m"] = {
            {"scan", fit.dbh_scan}, {"grown", fit.dbh_grown}, {"error", fit.dbh_grown / fit.dbh_scan - 1.0}};
    json["all"] = bark_fit_part_json(fit.all);
    json["lumpy"] = bark_fit_part_json(fit.lumpy);
    json["heights"] = Json::array();
    for (const BarkFitPart& part : fit.heights)
        json["heights"].push_back(bark_fit_part_json(part));
    json["worse"] = fit.worse;
    return dump(json);
}

std::string report_json(const Reconstruction& result, const ReportDetails& details) {
    Json json;
    json["format_version"] = kReportVersion;
    json["version"] = kVersion;
    json["scan"] = details.scan_path;
    json["scan_format"] = result.read.format;
    json["seed"] = details.seed;
    json["options"] = options_json(details);
    json["points_read"] = result.points_read;
    json["points"] = result.cloud.size();
    json["leaf_points"] = result.leaf_points;
    json["leaf_share"] = result.cloud.empty() ? 0.0
                                              : static_cast<double>(result.leaf_points) /
                                                    static_cast<double>(result.cloud.size());
    json["leaf_column"] = result.leaf_column.empty() ? Json(nullptr) : Json(result.leaf_column);
    json["foliage_cells"] = result.foliage.cells.size();
    Json removed = Json::object();
    for (const CleanStep& step : result.clean.steps)
        removed[step.name] = step.removed;
    json["removed"] = removed;
    json["up"] = up_axis_name(result.orient.up);
    json["up_detected"] = result.orient.up_detected;
    json["up_from_photos"] = result.orient.photos;
    json["tilt_degrees"] = result.tree.frame().tilt_degrees();
    json["metres_per_unit"] = result.orient.metres_per_unit;
    json["scale_guessed"] = result.orient.scale_guessed;
    json["scale_unknown"] = result.orient.scale_unknown;
    json["scale_from_marker"] = details.sized_by_marker;
    json["scale_from_gps"] = details.sized_by_gps;
    json["origin"] = vector_json(result.tree.frame().origin);
    Json trees = Json::array();
    for (const StandingTree& tree : result.clean.pick.trees) {
        const Json base = vector_json(tree.foot);
        // "foot" is the old word.
        trees.push_back({{"base", base}, {"foot", base}, {"height_m", tree.height}, {"points", tree.points}});
    }
    json["trees"] = trees;
    json["tree_taken"] = trees.empty() ? Json(nullptr) : Json(result.clean.pick.taken + 1);
    json["spacing_m"] = result.spacing;
    json["completed_branches"] = result.completed;
    json["completed_length_m"] = result.completed_length;
    if (result.voxel > 0.0) {
        json["voxel_m"] = result.voxel;
        json["points_are"] = !result.kind_told                    ? "surface, probably"
                             : result.kind == CloudKind::kSurface ? "surface"
                                                                  : "solid";
    }
    Json stages = Json::array();
    double total = 0.0;
    for (const StageTime& stage : result.stages) {
        Json entry = {{"name", stage.name}, {"ms", stage.milliseconds}, {"count", stage.count}};
        if (stage.kept) entry["kept"] = true;
        stages.push_back(std::move(entry));
        total += stage.milliseconds;
    }
    json["stages"] = stages;
    json["total_ms"] = total;
    const double peak = peak_memory_mb();
    json["peak_mb"] = peak > 0.0 ? Json(peak) : Json(nullptr);
    add_measurements(json, result.measured);
    json["triangles"] = details.triangles;
    json["leaves"] = details.leaf_count;
    json["fit"] = {{"points", result.fit.points},
                   {"median_mm", result.fit.median_mm},
                   {"mean_mm", result.fit.mean_mm},
                   {"p95_mm", result.fit.p95_mm},
                   {"explained_2cm", result.fit.explained_2cm}};
    json["fidelity"] = fidelity_json(result);
    json["warnings"] = result.warnings;
    if (details.photos) json["photos"] = photos_json(details);
    if (details.photos) {
        const double r_s = json["fidelity"]["R_s"].get<double>();
        json["photos"]["outline"] = details.outline ? outline_json(*details.outline, r_s) : Json(nullptr);
        if (!details.outline)
            json["photos"]["outline_lacks"] =
                details.outline_lacks.empty() ? Json(nullptr) : Json(details.outline_lacks);
    }
    if (details.bark) json["bark"] = bark_json(*details.bark);
    if (details.leaf_colours) json["leaf_colors"] = leaf_colours_json(*details.leaf_colours);
    return dump(json);
}

}  // namespace treerec
