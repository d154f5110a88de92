#include <cstdio>
#include <functional>

#include "accuracy.h"
#include "bench.h"
#include "error.h"
#include "file_bytes.h"

namespace treerec::bench {

namespace {

constexpr size_t kBarePoints = 20000;  // without leaves
constexpr double kNoises[] = {0.0, 0.01, 0.02};
constexpr double kOcclusions[] = {0.0, 0.3, 0.6};
constexpr double kLeaves[] = {0.0, 0.4, 0.8};

void print_header(const char* first) {
    std::printf(
        "| %-11s | noise cm | hidden %% | leaves %% | on leaves %% | seen %% | precision | recall |     F | "
        "length %% | radius %% | DBH %% | bias of radius %%, up to 5 mm 1 cm 2.5 cm 5 cm more |\n",
        first);
    std::printf(
        "|-------------|----------|----------|----------|-------------|--------|-----------|--------|-------|"
        "----------|----------|-------|--------------------------------------------------|\n");
}

std::string number(double value, const char* format) {
    char text[40];
    std::snprintf(text, sizeof text, format, value);
    return text;
}

// setting: nullptr for a mean over several.
void print_row(const std::string& name, const AccuracyCase* setting, const AccuracyRow& row) {
    const auto of_setting = [&](double AccuracyCase::*value) {
        return setting ? number(100.0 * setting->*value, "%g") : std::string("all");
    };
    std::string bias;
    for (size_t i = 0; i < kThicknessClasses; i++)
        bias += row.class_length[i] > 0.0 ? number(100.0 * row.radius_bias[i], " %+8.0f") : "        -";
    std::printf(
        "| %-11s | %8s | %8s | %8s | %11.0f | %6.0f | %9.3f | %6.3f | %5.3f | %8.1f | %8.1f | %5.1f | %48s "
        "|\n",
        name.c_str(), of_setting(&AccuracyCase::noise).c_str(), of_setting(&AccuracyCase::occlusion).c_str(),
        of_setting(&AccuracyCase::leaves).c_str(), 100.0 * row.leafy, 100.0 * row.seen, row.precision,
        row.recall, row.f, 100.0 * row.length_error, 100.0 * row.radius_error, 100.0 * row.dbh_error,
        bias.c_str());
}

using Filter = std::function<bool(const AccuracyCase&)>;

std::vector<AccuracyRow> filtered(const std::vector<AccuracyRow>& rows, const Filter& filter) {
    std::vector<AccuracyRow> result;
    for (const AccuracyRow& row : rows)
        if (filter(row.setting)) result.push_back(row);
    return result;
}

void print_summaries(const std::vector<AccuracyRow>& rows) {
    std::printf(
        "\nMeans over all habits but the palm; length (at most 100 %%) and DBH errors (at most 30 %%) "
        "without sign:\n\n");
    print_header("habits");
    for (double noise : kNoises)
        for (double occlusion : kOcclusions)
            for (double leaves : kLeaves) {
                const std::vector<AccuracyRow> some = filtered(rows, [&](const AccuracyCase& s) {
                    return s.habit != Habit::kPalm && s.noise == noise && s.occlusion == occlusion &&
                           s.leaves == leaves;
                });
                print_row("all", &some.front().setting, mean_of(some));
            }
    std::printf("\nMeans over all noises, occlusions and leaves, and of the cleanest scans:\n\n");
    print_header("habit");
    for (Habit habit : all_habits()) {
        const std::vector<AccuracyRow> some =
            filtered(rows, [&](const AccuracyCase& s) { return s.habit == habit; });
        const std::vector<AccuracyRow> clean = filtered(some, [&](const AccuracyCase& s) {
            return s.noise == 0.0 && s.occlusion == 0.0 && s.leaves == 0.0;
        });
        print_row(habit_name(habit), nullptr, mean_of(some));
        print_row(habit_name(habit), &clean.front().setting, mean_of(clean));
    }
    print_row("all", nullptr, mean_of(rows));
}

std::vector<AccuracyRow> measured_guard() {
    std::vector<AccuracyRow> rows;
    for (const AccuracyCase& one : guard_cases()) {
        rows.push_back(measure_accuracy(one));
        print_row(habit_name(one.habit), &one, rows.back());
        if (!rows.back().failure.empty()) std::printf("  %s\n", rows.back().failure.c_str());
        std::fflush(stdout);
    }
    return rows;
}

// A guard that cannot fail guards nothing: the table just measured must fail against a better one.
bool fails_against_better(std::vector<AccuracyRow> rows) {
    const std::vector<AccuracyRow> now = rows;
    rows[rows.size() / 2].recall += 0.1;
    return compare_accuracy(now, now).empty() && !compare_accuracy(rows, now).empty();
}

}  // namespace

void bench_synth(const Settings& settings) {
    std::printf(
        "Grown trees, %d of each habit in each setting, no colours; %zu points without leaves, up to %zu "
        "with them.\n"
        "Precision and recall of length within the larger of 1 cm and the radius.\n\n",
        settings.seeds, kBarePoints, points_for(Habit::kBroadleaf, 0.8, kBarePoints));
    print_header("habit");
    std::vector<AccuracyRow> rows;
    for (Habit habit : all_habits())
        for (double noise : kNoises)
            for (double occlusion : kOcclusions)
                for (double leaves : kLeaves) {
                    std::vector<AccuracyRow> same;
                    for (int seed = 1; seed <= settings.seeds; seed++)
                        same.push_back(measure_accuracy({habit, static_cast<uint64_t>(seed), noise, occlusion,
                                                         leaves, points_for(habit, leaves, kBarePoints)},
                                                        settings.labelled));
                    print_row(habit_name(habit), &same.front().setting, mean_of(same));
                    for (const AccuracyRow& row : same)
                        if (!row.failure.empty()) std::printf("  %s\n", row.failure.c_str());
                    std::fflush(stdout);
                    rows.insert(rows.end(), same.begin(), same.end());
                }
    print_summaries(rows);
}

bool guard_accuracy(const Settings& settings) {
    const std::vector<AccuracyRow> recorded =
        parse_accuracy_table(std::string(read_file(settings.record).view()));
    print_header("habit");
    const std::vector<AccuracyRow> rows = measured_guard();
    const std::vector<std::string> worse = compare_accuracy(recorded, rows);
    for (const std::string& sentence : worse)
        std::printf("WORSE: %s\n", sentence.c_str());
    const AccuracyRow before = mean_of(recorded), now = mean_of(rows);
    std::printf("mean F %.3f (recorded %.3f), radius error %.1f %% (%.1f %%), DBH error %.1f %% (%.1f %%)\n",
                now.f, before.f, 100.0 * now.radius_error, 100.0 * before.radius_error, 100.0 * now.dbh_error,
                100.0 * before.dbh_error);
    if (!worse.empty())
        std::printf("If that is the price of something better, record it and say so: ./dev bench --record\n");
    else if (now.f > before.f + 0.01 || now.radius_error < before.radius_error - 0.01)
        std::printf("That is better than recorded; keep it: ./dev bench --record\n");
    if (!fails_against_better(rows)) {
        std::printf("WORSE: the comparison itself lets a worse table pass\n");
        return false;
    }
    return worse.empty();
}

void record_accuracy(const Settings& settings) {
    print_header("habit");
    write_file(settings.record, accuracy_table(measured_guard()));
    std::printf("recorded in %s\n", settings.record.c_str());
}

}  // namespace treerec::bench
