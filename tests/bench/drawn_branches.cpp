// Branches drawn over scans: how near they come to the ones that were there.
#include <cstdio>

#include "../unit/branch_trials.h"
#include "bench.h"
#include "error.h"

namespace treerec::bench {

namespace {

using namespace branch_trials;

void print_row(const char* name, const std::vector<Figures>& shown, const std::vector<Figures>& unseen,
               size_t refused) {
    if (shown.empty() || unseen.empty()) {
        std::printf("%-11s nothing was drawn, %zu refused\n", name, refused);
        return;
    }
    const auto mean = [](const std::vector<Figures>& all, const auto& value) {
        double sum = 0.0;
        for (const Figures& one : all)
            sum += value(one);
        return sum / static_cast<double>(all.size());
    };
    std::vector<double> angles;
    for (const Figures& one : unseen)
        angles.push_back(one.angle);
    const double below = mean(unseen, [](const Figures& f) { return f.angle <= 20.0 ? 1.0 : 0.0; });
    const auto ratio = [&](const auto& made, const auto& own) {
        return 100.0 * (mean(shown, made) / mean(shown, own) - 1.0);
    };
    std::printf(
        "%-11s %5zu %3zu  %3.0f %% %5.2f  %4.1f %% %4.1f %%  %6.1f %5.1f %3.0f %%  %6.2f %6.2f  ", name,
        shown.size(), refused, 100.0 * mean(shown, [](const Figures& f) { return f.host ? 1.0 : 0.0; }),
        mean(shown, [](const Figures& f) { return f.host_off; }),
        100.0 * mean(shown, [](const Figures& f) { return f.within; }),
        100.0 * mean(shown, [](const Figures& f) { return f.measured_right; }), spread_of(angles).median,
        spread_of(angles).mean, 100.0 * below, mean(shown, [](const Figures& f) { return f.length_ratio; }),
        mean(shown, [](const Figures& f) { return f.radius_ratio; }));
    // The mean, the median, and how far off one branch's mean is.
    std::printf("%+5.1f %+5.1f %% %4.1f %%  ",
                ratio([](const Figures& f) { return f.angles.mean; },
                      [](const Figures& f) { return f.angles_own.mean; }),
                ratio([](const Figures& f) { return f.angles.median; },
                      [](const Figures& f) { return f.angles_own.median; }),
                100.0 * mean(shown, [](const Figures& f) { return off(f.angles.mean, f.angles_own.mean); }));
    // Where most twigs stand in pairs the median internode is 0, and nothing can be said of it.
    const auto paired = [](const Figures& f) { return f.internodes_own.median < 0.01; };
    const auto median = [&](const Figures& f) { return paired(f) ? 0.0 : f.internodes.median; };
    const auto own_median = [&](const Figures& f) { return paired(f) ? 0.0 : f.internodes_own.median; };
    const bool all_paired = std::all_of(shown.begin(), shown.end(), paired);
    std::printf(
        "%+5.1f %+5.1f %% %4.1f %%\n",
        ratio([](const Figures& f) { return f.internodes.mean; },
              [](const Figures& f) { return f.internodes_own.mean; }),
        all_paired ? 0.0 : ratio(median, own_median),
        100.0 * mean(shown, [](const Figures& f) { return off(f.internodes.mean, f.internodes_own.mean); }));
}

void bench_kind(const Settings& settings, bool reconstructed) {
    std::vector<Figures> all_shown, all_unseen;
    size_t all_refused = 0;
    for (const Habit habit : {Habit::kBroadleaf, Habit::kConifer, Habit::kBirch, Habit::kForked,
                              Habit::kLeaning, Habit::kShrub, Habit::kButtressed}) {
        std::vector<Figures> shown, unseen;
        size_t refused = 0;
        for (int seed = 1; seed <= settings.seeds; seed++) {
            const auto trial = make_trial(habit, static_cast<uint64_t>(seed), 3.0, 60000, reconstructed);
            if (!trial) continue;
            try {
                const Figures a = judge(*trial, sketch_branch(trial->tree, &trial->cloud, trial->stroke));
                const Figures b = judge(*trial, sketch_branch(trial->tree, &trial->cloud_cut, trial->stroke));
                shown.push_back(a);
                unseen.push_back(b);
                if (settings.repetitions > 0)
                    std::printf(
                        "  %s %d: host %d, %.2f m off; %.2f of it drawn, %.2f of what was told right; "
                        "unseen %.1f degrees off, %.2f told\n",
                        habit_name(habit).c_str(), seed, a.host, a.host_off, a.within, a.measured_right,
                        b.angle, b.measured);
            } catch (const Error& error) {
                refused++;
                std::printf("  %s %d: %s\n", habit_name(habit).c_str(), seed, error.what());
            }
        }
        print_row(habit_name(habit).c_str(), shown, unseen, refused);
        all_shown.insert(all_shown.end(), shown.begin(), shown.end());
        all_unseen.insert(all_unseen.end(), unseen.begin(), unseen.end());
        all_refused += refused;
    }
    print_row("all", all_shown, all_unseen, all_refused);
}

}  // namespace

void bench_drawn_branches(const Settings& settings) {
    std::printf(
        "branches drawn with 3 px of jitter on 1000 px, from 1.2 to 2.5 heights away. drawn: share of the "
        "axis, "
        "where\npoints are, within 5 cm; told: share of what is said to be measured; unseen: degrees off, "
        "without its points\n");
    for (const bool reconstructed : {false, true}) {
        std::printf("\n%s\n", reconstructed ? "onto trees made from the scan without the branch"
                                            : "onto the true trees without the branch");
        std::printf("%-11s %5s %3s  %5s %5s  %6s %6s  %6s %5s %5s  %6s %6s  %-21s %s\n", "", "drawn", "not",
                    "host", "m", "drawn", "told", "unseen", "mean", "<20", "length", "radius",
                    "twigs' angles, each", "internodes, each");
        bench_kind(settings, reconstructed);
    }
}

}  // namespace treerec::bench
