// Thresholds of the repairs on messy sketches: tried on even seeds, reported on odd ones.
//     tune_repairs [SKETCHES]      of each half; 300
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "error.h"
#include "messy_sketches.h"
#include "sketch/repair.h"

namespace {

using namespace treerec;
using namespace treerec::test;

struct Score {
    size_t strokes = 0, right = 0;                       // by role
    size_t hooks = 0, found = 0, plain = 0, false_ = 0;  // tails with a hook or loop, without one
    std::vector<double> errors;                          // of attach points, pixels of a canvas 1,000 high
    std::array<std::vector<double>, kMesses> by_mess;
};

double quantile(std::vector<double> values, double share) {
    if (values.empty()) return 0.0;
    std::sort(values.begin(), values.end());
    return values[static_cast<size_t>(share * static_cast<double>(values.size() - 1) + 0.5)];
}

double share_within(const std::vector<double>& values, double most) {
    const auto within = std::count_if(values.begin(), values.end(), [&](double v) { return v <= most; });
    return values.empty() ? 1.0 : static_cast<double>(within) / static_cast<double>(values.size());
}

Score score(const std::vector<MessySketch>& sketches, const RepairOptions& options) {
    Score all;
    for (const MessySketch& messy : sketches) {
        const UnderstoodSketch understood = understand_sketch(messy.sketch, options);
        for (size_t i = 0; i < messy.truth.size(); i++) {
            const StrokeTruth& truth = messy.truth[i];
            const StrokeReading& told = understood.strokes[i];
            all.strokes++;
            if (told.role != truth.role) {
                if (std::getenv("TELL"))
                    std::printf("seed %llu stroke %zu: %s, read as %s (%s)\n",
                                static_cast<unsigned long long>(messy.sketch.seed), i,
                                stroke_role_name(truth.role), stroke_role_name(told.role),
                                told.fault.c_str());
                continue;
            }
            all.right++;
            if (!truth.attach) continue;
            const double error = told.attach ? glm::length(*told.attach - *truth.attach) * kCanvasHeight /
                                                   messy.sketch.canvas.y
                                             : 1e3;
            all.errors.push_back(error);
            all.by_mess[static_cast<size_t>(truth.mess)].push_back(error);
            const bool hook = std::count(told.repairs.begin(), told.repairs.end(), StrokeRepair::kHook) > 0;
            const bool meant = truth.mess >= Mess::kHook;
            (meant ? all.hooks : all.plain)++;
            if (hook) (meant ? all.found : all.false_)++;
            if (error > 8.0 && std::getenv("TELL")) {
                std::printf("seed %llu stroke %zu: %s%s, %.1f px:",
                            static_cast<unsigned long long>(messy.sketch.seed), i, mess_name(truth.mess),
                            truth.reversed ? ", reversed" : "", error);
                for (const StrokeRepair repair : told.repairs)
                    std::printf(" %s", stroke_repair_name(repair));
                std::printf(" %s\n", told.fault.c_str());
            }
        }
    }
    return all;
}

void print_head() {
    std::printf("%-34s %7s %7s %7s %7s %7s %7s %7s\n", "", "roles%", "median", "95%", "99%", "in 8px%",
                "hooks%", "false%");
}

double percent(size_t part, size_t whole) {
    return whole == 0 ? 0.0 : 100.0 * static_cast<double>(part) / static_cast<double>(whole);
}

void print_row(const std::string& name, const Score& s) {
    std::printf("%-34s %7.2f %7.2f %7.2f %7.2f %7.2f %7.2f %7.2f\n", name.c_str(),
                percent(s.right, s.strokes), quantile(s.errors, 0.5), quantile(s.errors, 0.95),
                quantile(s.errors, 0.99), 100.0 * share_within(s.errors, 8.0), percent(s.found, s.hooks),
                percent(s.false_, s.plain));
}

void tune(size_t count) {
    std::vector<MessySketch> even, odd;
    for (size_t k = 0; k < count; k++) {
        even.push_back(messy_sketch(2 * k));
        odd.push_back(messy_sketch(2 * k + 1));
    }
    std::printf("even seeds\n");
    print_head();
    const auto table = [&](const char* name, double RepairOptions::*value,
                           std::initializer_list<double> values) {
        for (const double v : values) {
            RepairOptions options;
            options.*value = v;
            char row[64];
            std::snprintf(row, sizeof(row), "%s %g", name, v);
            print_row(row, score(even, options));
        }
    };
    table("relative density", &RepairOptions::relative_density,
          {1.3, 1.4, 1.5, 1.6, 1.7, 1.8, 2.0, 2.3, 2.7, 3.5});
    table("reach of a hook, pixels", &RepairOptions::cluster_reach, {30.0, 45.0, 60.0, 80.0, 100.0});
    table("reach of a hook, share", &RepairOptions::cluster_share, {0.15, 0.2, 0.3, 0.4});
    table("gap, share of the length", &RepairOptions::gap_share, {0.05, 0.1, 0.15, 0.2, 0.3});
    table("tail's direction from, pixels", &RepairOptions::tail, {12.0, 20.0, 30.0, 40.0, 60.0});
    const Score told = score(even, RepairOptions());
    print_row("even seeds, as it is", told);
    std::printf("odd seeds\n");
    const auto before = std::chrono::steady_clock::now();
    const Score result = score(odd, RepairOptions());
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count();
    print_head();
    print_row("all", result);
    for (int k = 0; k < kMesses; k++) {
        const std::vector<double>& errors = result.by_mess[static_cast<size_t>(k)];
        std::printf("%-26s %7zu %7s %7.2f %7.2f %7.2f %7.2f\n", mess_name(static_cast<Mess>(k)),
                    errors.size(), "", quantile(errors, 0.5), quantile(errors, 0.95), quantile(errors, 0.99),
                    100.0 * share_within(errors, 8.0));
    }
    std::printf("%zu strokes; %.3f ms a sketch\n", result.strokes,
                1e3 * seconds / static_cast<double>(count));
}

}  // namespace

int main(int count, char** words) {
    try {
        const int sketches = count > 1 ? std::atoi(words[1]) : 300;
        tune(static_cast<size_t>(std::clamp(sketches, 1, 100000)));
    } catch (const treerec::Error& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
    return 0;
}
