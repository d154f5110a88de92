// Limbs drawn over scans: how near they come to the ones that were there.
#include <cstdio>

#include "../unit/limb_trials.h"
#include "bench.h"
#include "error.h"

namespace treerec::bench {

namespace {

using namespace limb_trials;

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
    // Twigs of all limbs of the kind together, and limb by limb.
    const auto together = [&](const auto& of) {
        double own = 0.0, made = 0.0;
        for (const Figures& one : shown) {
            made += of(one, true);
            own += of(one, false);
        }
        return made / own - 1.0;
    };
    std::printf(
        "%-11s %3zu %2zu  %4.0f %% %5.2f  %5.1f %% %5.1f %% %4.0f %%  %4.1f %4.1f  %4.1f %4.1f %3.0f %%  "
        "%4.2f %4.2f  "
        "%+5.1f %+5.1f %% %4.1f %%  %+5.1f %+5.1f %% %4.1f %%\n",
        name, shown.size(), refused, 100.0 * mean(shown, [](const Figures& f) { return f.host ? 1.0 : 0.0; }),
        mean(shown, [](const Figures& f) { return f.host_off; }),
        100.0 * mean(shown, [](const Figures& f) { return f.within; }),
        100.0 * mean(shown, [](const Figures& f) { return f.measured_right; }),
        100.0 * mean(shown, [](const Figures& f) { return f.measured; }),
        mean(shown, [](const Figures& f) { return f.angle; }),
        mean(unseen, [](const Figures& f) { return f.measured; }) * 100.0, spread_of(angles).median,
        spread_of(angles).mean, 100.0 * below, mean(shown, [](const Figures& f) { return f.length_ratio; }),
        mean(shown, [](const Figures& f) { return f.radius_ratio; }),
        100.0 *
            together([](const Figures& f, bool made) { return made ? f.angles.mean : f.angles_own.mean; }),
        100.0 * together(
                    [](const Figures& f, bool made) { return made ? f.angles.median : f.angles_own.median; }),
        100.0 * mean(shown, [](const Figures& f) { return off(f.angles.mean, f.angles_own.mean); }),
        100.0 * together([](const Figures& f, bool made) {
            return made ? f.internodes.mean : f.internodes_own.mean;
        }),
        100.0 * together([](const Figures& f, bool made) {
            return made ? f.internodes.median : f.internodes_own.median;
        }),
        100.0 * mean(shown, [](const Figures& f) { return off(f.internodes.mean, f.internodes_own.mean); }));
}

}  // namespace

void bench_limbs(const Settings& settings) {
    std::printf("limbs drawn over their scan with 3 px of jitter, from 1.2 to 2.5 heights, 1000 px\n");
    std::printf("%-11s %3s %2s  %6s %5s  %7s %7s %6s  %4s %4s  %9s %5s  %9s  %14s %6s  %14s %6s\n", "habit",
                "n", "no", "host", "off", "<5cm", "told", "shown", "deg", "sh0", "unseen", "<20", "len rad",
                "twig angle", "each", "internode", "each");
    std::vector<Figures> all_shown, all_unseen;
    size_t all_refused = 0;
    for (const Habit habit : {Habit::kBroadleaf, Habit::kConifer, Habit::kBirch, Habit::kForked,
                              Habit::kLeaning, Habit::kShrub, Habit::kButtressed}) {
        std::vector<Figures> shown, unseen;
        size_t refused = 0;
        for (int seed = 1; seed <= settings.seeds; seed++) {
            const auto trial = make_trial(habit, static_cast<uint64_t>(seed));
            if (!trial) continue;
            try {
                const Figures a = judge(*trial, draw_limb(trial->tree, &trial->cloud, trial->stroke));
                const Figures b = judge(*trial, draw_limb(trial->tree, &trial->cloud_cut, trial->stroke));
                shown.push_back(a);
                unseen.push_back(b);
                if (settings.repetitions > 0)
                    std::printf("  %s %d host %d %.2f within %.2f told %.2f shown %.2f | unseen %.1f deg\n",
                                habit_name(habit).c_str(), seed, a.host, a.host_off, a.within,
                                a.measured_right, a.measured, b.angle);
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

}  // namespace treerec::bench
