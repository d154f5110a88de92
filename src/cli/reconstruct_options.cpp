#include "cli/reconstruct_options.h"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <string_view>
#include <utility>

#include "cli/commands.h"

namespace treerec {

namespace {

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

KnownLength known_length_from(const Arguments& arguments, const std::string& option) {
    const auto v =
        numbers_from<7>(arguments, option, "0,0,0,0,0,5.2,1.8 (two places and the metres between)");
    const KnownLength known{{v[0], v[1], v[2]}, {v[3], v[4], v[5]}, v[6]};
    if (!(known.metres > 0.0) || known.from == known.to)
        throw UsageError(option + " needs two different places, and a length above 0.");
    return known;
}

constexpr std::pair<std::string_view, double> kUnits[] = {
    {"m", 1.0},     {"cm", 0.01},  {"mm", 0.001}, {"km", 1000.0}, {"ft", 0.3048}, {"us-ft", 1200.0 / 3937.0},
    {"in", 0.0254}, {"yd", 0.9144}};

// "1 mm", "100 m".
std::string length_text(double metres) {
    char text[32];
    const bool small = metres < 1.0;
    const std::to_chars_result end = std::to_chars(text, text + sizeof text, small ? 1000.0 * metres : metres,
                                                   std::chars_format::general, 6);
    return std::string(text, end.ptr) + (small ? " mm" : " m");
}

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

}  // namespace

ReconstructOptions reconstruct_options_from(const Arguments& arguments) {
    ReconstructOptions options;
    options.read = read_options_from(arguments);
    if (arguments.text("--up", "auto") != "auto") options.orient.up = up_axis_from(arguments);
    if (arguments.has("--scale"))
        options.orient.metres_per_unit = arguments.number("--scale", 1.0, 1e-9, 1e9);
    if (arguments.has("--unit")) options.orient.metres_per_unit = unit_from(arguments);
    if (arguments.has("--height")) options.orient.known_height = arguments.number("--height", 0.0, 1e-3, 1e3);
    const std::string length = arguments.has("--known-length") ? "--known-length" : "--length";
    if (arguments.has(length)) options.orient.known_length = known_length_from(arguments, length);
    if (arguments.has("--scale") + arguments.has("--unit") + arguments.has("--height") +
            arguments.has(length) >
        1)
        throw UsageError("--scale, --unit, --height and " + length + " all set the scale; give one of them.");
    options.skeleton.spacing = arguments.number("--spacing", 0.0, 1e-4, 10.0);
    options.skeleton.method =
        as_usage([&] { return parse_skeleton_method(arguments.text("--skeleton", "geodesic")); });
    options.skeleton.spanning_tree =
        as_usage([&] { return parse_spanning_tree_kind(arguments.text("--spanning-tree", "paths")); });
    if (arguments.has("--spanning-tree") && options.skeleton.method != SkeletonMethod::kDelaunay)
        throw UsageError("--spanning-tree is of the Delaunay triangulation; add --skeleton delaunay.");
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

double length_from(const Arguments& arguments, const std::string& option, double otherwise, double least,
                   double most) {
    if (!arguments.has(option)) return otherwise;
    const std::string word = arguments.text(option, "");
    double value = 0.0;
    const auto [end, failure] = std::from_chars(word.data(), word.data() + word.size(), value);
    std::string_view unit(end, static_cast<size_t>(word.data() + word.size() - end));
    while (!unit.empty() && unit.front() == ' ')
        unit.remove_prefix(1);
    if (unit.empty()) unit = "m";
    for (const auto& [name, metres] : kUnits) {
        if (failure != std::errc() || name != unit) continue;
        value *= metres;
        if (value >= least && value <= most) return value;
        throw UsageError(option + " is from " + length_text(least) + " to " + length_text(most) + ", not " +
                         quote_word(word) + ".");
    }
    throw UsageError(option + " needs a length, such as 200mm, 8in or 0.2 (metres), not " + quote_word(word) +
                     ".");
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

}  // namespace treerec
