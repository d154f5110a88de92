#include "accuracy.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>

#include "error.h"
#include "fidelity/score.h"
#include "synth/scan.h"
#include "tree/measure.h"

namespace treerec::bench {

namespace {

constexpr double kSampleStep = 0.004;  // metres between the samples of a skeleton

// Beyond these a row counts as worse; chance alone moves a single tree this much when a rule changes.
constexpr double kRowShare = 0.04;   // precision, recall, F
constexpr double kRowRadius = 0.06;  // radius error
constexpr double kRowDbh = 0.15;     // a leafy foot makes it jump
// And the means of all rows, which hardly move by chance.
constexpr double kMeanShare = 0.006;
constexpr double kMeanRadius = 0.012;

const char* const kHeader =
    "habit\tseed\tnoise\tocclusion\tleaves\tpoints\tprecision\trecall\tf\tlength_error\tradius_error\tdbh_"
    "error";

double seen_share(const Tree& tree, const VirtualScan& scan) {
    std::vector<uint8_t> seen(static_cast<size_t>(tree.id_end()), 0);
    for (size_t i = 0; i < scan.node.size(); i++)
        if (scan.origin[i] == kFromWood) seen[static_cast<size_t>(scan.node[i])] = 1;
    double all = 0.0, found = 0.0;
    for (NodeId id : tree.depth_first()) {
        const Node& node = tree.node(id);
        if (node.parent == kNoNode) continue;
        const double length = glm::distance(node.position, tree.node(node.parent).position);
        all += length;
        if (seen[static_cast<size_t>(id)]) found += length;
    }
    return found / all;
}

std::string name_of(const AccuracyCase& setting) {
    char text[160];
    std::snprintf(text, sizeof text, "%s, seed %llu, noise %g cm, %g %% hidden, %g %% leaves",
                  habit_name(setting.habit).c_str(), static_cast<unsigned long long>(setting.seed),
                  100.0 * setting.noise, 100.0 * setting.occlusion, 100.0 * setting.leaves);
    return text;
}

bool same_case(const AccuracyCase& a, const AccuracyCase& b) {
    const auto near = [](double x, double y) { return std::abs(x - y) < 1e-9; };
    return a.habit == b.habit && a.seed == b.seed && near(a.noise, b.noise) &&
           near(a.occlusion, b.occlusion) && near(a.leaves, b.leaves) && a.points == b.points;
}

struct Figure {
    const char* name;
    double AccuracyRow::*value;
    bool more_is_better;  // otherwise its size counts, whatever its sign
    double row_tolerance, mean_tolerance;
};

constexpr Figure kFigures[] = {
    {"precision", &AccuracyRow::precision, true, kRowShare, kMeanShare},
    {"recall", &AccuracyRow::recall, true, kRowShare, kMeanShare},
    {"F", &AccuracyRow::f, true, kRowShare, kMeanShare},
    {"radius error", &AccuracyRow::radius_error, false, kRowRadius, kMeanRadius},
    {"DBH error", &AccuracyRow::dbh_error, false, kRowDbh, kMeanRadius},
};

void compare_row(const AccuracyRow& old, const AccuracyRow& now, const std::string& where, bool means,
                 std::vector<std::string>& worse) {
    for (const Figure& figure : kFigures) {
        const auto goodness = [&](const AccuracyRow& row) {
            const double value = row.*figure.value;
            return figure.more_is_better ? value : -std::min(kLargestError, std::abs(value));
        };
        const double before = goodness(old), after = goodness(now);
        const double tolerance = means ? figure.mean_tolerance : figure.row_tolerance;
        if (after >= before - tolerance) continue;
        char text[200];
        std::snprintf(text, sizeof text, ": %s was %.3f and is %.3f", figure.name, std::abs(before),
                      std::abs(after));
        worse.push_back(where + text);
    }
    if (!now.failure.empty() && old.failure.empty()) worse.push_back(where + ": " + now.failure);
}

}  // namespace

VirtualScanOptions scan_options_of(const AccuracyCase& setting) {
    VirtualScanOptions options = scan_options_for(setting.habit);
    options.seed = setting.seed;
    options.points = setting.points;
    options.noise = setting.noise;
    options.occlusion = setting.occlusion;
    options.leaves = setting.leaves;
    return options;
}

size_t points_for(Habit habit, double leaves, size_t bare_points) {
    // About what grown trees return, and a palm's fronds are always there.
    const double foliage = habit == Habit::kPalm ? 0.8 : leaves;
    return static_cast<size_t>(std::lround((1.0 + 3.0 * foliage) * static_cast<double>(bare_points)));
}

GrownScan::GrownScan(const AccuracyCase& setting, bool labelled)
    : truth_(grow_tree({setting.habit, 0.0, setting.seed})), file_(folder_.file("scan.ply")) {
    seen_.setting = setting;
    VirtualScan scan = scan_tree(truth_, scan_options_of(setting));
    size_t leaf_points = 0;
    for (uint8_t origin : scan.origin)
        leaf_points += origin == kFromLeaf;
    seen_.leafy = static_cast<double>(leaf_points) / static_cast<double>(scan.origin.size());
    seen_.seen = seen_share(truth_, scan);
    // Most real scans have none, and grown leaves are greener than real ones.
    scan.cloud.colors.clear();
    if (labelled && leaf_points > 0) {
        scan.cloud.labels.leaf_is_one = true;
        for (uint8_t origin : scan.origin)
            scan.cloud.labels.values.push_back(origin == kFromLeaf ? 1 : 0);
    }
    write_cloud(file_, scan.cloud);
}

AccuracyRow GrownScan::measure(const ReconstructOptions& options, ReconstructCache* cache) const {
    AccuracyRow row = seen_;
    const double true_dbh = treerec::measure(truth_).dbh;
    try {
        const Reconstruction result = reconstruct_tree(file_, options, nullptr, cache);
        const SkeletonScore score = score_skeleton(result.tree, truth_, nullptr, kSampleStep);
        row.precision = score.match.precision;
        row.recall = score.match.recall;
        row.f = score.match.f;
        row.length_error = score.length_error;
        row.radius_error = score.radius_error_abs;
        if (true_dbh > 0.0) row.dbh_error = treerec::measure(result.tree).dbh / true_dbh - 1.0;
        for (size_t i = 0; i < kThicknessClasses; i++) {
            row.radius_bias[i] = score.radius_by_thickness[i].error;
            row.class_length[i] = score.radius_by_thickness[i].length;
        }
    } catch (const Error& error) {
        row.failure = error.what();
        row.length_error = row.dbh_error = -1.0;
        row.radius_error = 1.0;
    }
    return row;
}

AccuracyRow measure_accuracy(const AccuracyCase& setting, bool labelled) {
    return GrownScan(setting, labelled).measure();
}

std::vector<AccuracyCase> guard_cases() {
    std::vector<AccuracyCase> cases;
    for (Habit habit : all_habits())
        for (int kind = 0; kind < 4; kind++) {
            AccuracyCase one;
            one.habit = habit;
            one.seed = 11;
            one.noise = kind == 1 ? 0.02 : 0.003;
            one.occlusion = kind == 2 ? 0.6 : 0.0;
            one.leaves = kind == 3 ? 0.8 : 0.0;
            one.points = points_for(habit, one.leaves, 15000);
            cases.push_back(one);
        }
    return cases;
}

std::vector<std::string> compare_accuracy(const std::vector<AccuracyRow>& recorded,
                                          const std::vector<AccuracyRow>& now) {
    std::vector<std::string> worse;
    if (recorded.size() != now.size() || now.empty())
        return {"the recorded table has " + std::to_string(recorded.size()) + " rows, this one " +
                std::to_string(now.size())};
    for (size_t i = 0; i < now.size(); i++) {
        const std::string where = name_of(now[i].setting);
        if (same_case(recorded[i].setting, now[i].setting))
            compare_row(recorded[i], now[i], where, false, worse);
        else
            worse.push_back(where + ": not in the recorded table");
    }
    compare_row(mean_of(recorded), mean_of(now), "the mean of all", true, worse);
    return worse;
}

std::string accuracy_table(const std::vector<AccuracyRow>& rows) {
    std::string text = std::string(kHeader) + "\n";
    for (const AccuracyRow& row : rows) {
        const AccuracyCase& s = row.setting;
        char line[300];
        std::snprintf(line, sizeof line, "%s\t%llu\t%g\t%g\t%g\t%zu\t%.4f\t%.4f\t%.4f\t%.4f\t%.4f\t%.4f\n",
                      habit_name(s.habit).c_str(), static_cast<unsigned long long>(s.seed), s.noise,
                      s.occlusion, s.leaves, s.points, row.precision, row.recall, row.f, row.length_error,
                      row.radius_error, row.dbh_error);
        text += line;
    }
    return text;
}

std::vector<AccuracyRow> parse_accuracy_table(const std::string& text) {
    std::istringstream lines(text);
    std::string line;
    if (!std::getline(lines, line) || line != kHeader)
        throw Error("The recorded accuracy table has another header than this program's.");
    std::vector<AccuracyRow> rows;
    while (std::getline(lines, line)) {
        std::istringstream words(line);
        std::string habit;
        AccuracyRow row;
        AccuracyCase& s = row.setting;
        if (!(words >> habit >> s.seed >> s.noise >> s.occlusion >> s.leaves >> s.points >> row.precision >>
              row.recall >> row.f >> row.length_error >> row.radius_error >> row.dbh_error))
            throw Error("The recorded accuracy table has a line that is none: " + line);
        s.habit = parse_habit(habit);
        rows.push_back(row);
    }
    return rows;
}

AccuracyRow mean_of(const std::vector<AccuracyRow>& rows) {
    AccuracyRow mean;
    const double count = static_cast<double>(rows.size());
    for (const AccuracyRow& row : rows) {
        for (double AccuracyRow::*value : {&AccuracyRow::leafy, &AccuracyRow::seen, &AccuracyRow::precision,
                                           &AccuracyRow::recall, &AccuracyRow::f, &AccuracyRow::radius_error})
            mean.*value += row.*value / count;
        // Errors to both sides would cancel, and one that is wildly wrong would drown all others.
        mean.length_error += std::min(1.0, std::abs(row.length_error)) / count;
        mean.dbh_error += std::min(kLargestError, std::abs(row.dbh_error)) / count;
        for (size_t i = 0; i < kThicknessClasses; i++) {
            mean.radius_bias[i] += row.radius_bias[i] * row.class_length[i];
            mean.class_length[i] += row.class_length[i];
        }
    }
    for (size_t i = 0; i < kThicknessClasses; i++)
        if (mean.class_length[i] > 0.0) mean.radius_bias[i] /= mean.class_length[i];
    return mean;
}

}  // namespace treerec::bench
