// Plots of grown trees: which stems are found, and how many points are given to the right tree.
#include <array>
#include <cstdio>

#include "../unit/grown_plots.h"
#include "bench.h"

namespace treerec::bench {

namespace {

using namespace grown_plots;

struct Sum {
    double trees = 0.0, found = 0.0, false_ones = 0.0, right = 0.0, plots = 0.0, good = 0.0;

    void add(const PlotScore& score) {
        trees += static_cast<double>(score.trees);
        found += static_cast<double>(score.found);
        false_ones += static_cast<double>(score.false_ones);
        right += score.right;
        good += score.found == score.trees && score.false_ones == 0 && score.right >= 0.95;
        plots += 1.0;
    }
    void print(const char* name) const {
        std::printf("| %s | %.0f | %.3f | %.3f | %.3f | %.2f |\n", name, trees, found / trees,
                    false_ones / trees, right / plots, good / plots);
        std::fflush(stdout);
    }
};

}  // namespace

void bench_plots(const Settings& settings) {
    std::printf(
        "| plots | trees | stems found | false stems per tree | points right | plots that are right |\n"
        "|---|---|---|---|---|---|\n");
    constexpr std::array kOverlaps{0.0, 0.2, 0.4, 0.6};
    std::array<Sum, 4> by_overlap;
    Sum all;
    for (size_t o = 0; o < kOverlaps.size(); o++)
        for (const bool row : {true, false})
            for (const bool ground : {false, true})
                for (const double leaves : {0.0, 0.5}) {
                    Sum sum;
                    for (int seed = 1; seed <= settings.seeds; seed++)
                        for (const double noise : {0.003, 0.01}) {
                            PlotOptions options;
                            options.seed = static_cast<uint64_t>(2 * seed) + (noise > 0.005 ? 1 : 0);
                            options.trees = 2 + (5 * options.seed + 3 * o) % 11;
                            options.row = row;
                            options.overlap = kOverlaps[o];
                            options.ground = ground;
                            options.leaves = leaves;
                            options.noise = noise;
                            const GrownPlot plot = make_plot(options);
                            PickReport pick;
                            const PlotScore score = judge(plot, label_trees(plot.cloud, {}, pick), pick);
                            sum.add(score);
                            by_overlap[o].add(score);
                            all.add(score);
                            if (settings.repetitions > 0)
                                std::printf(
                                    "  seed %d, %g m noise: %zu trees, %zu found, %zu false, %.3f right\n",
                                    seed, noise, score.trees, score.found, score.false_ones, score.right);
                        }
                    std::array<char, 100> name;
                    std::snprintf(name.data(), name.size(), "%s, %.0f %%, %s, %s", row ? "row" : "scattered",
                                  100.0 * kOverlaps[o], ground ? "ground" : "no ground",
                                  leaves > 0.0 ? "leafy" : "bare");
                    sum.print(name.data());
                }
    for (size_t o = 0; o < kOverlaps.size(); o++) {
        std::array<char, 40> name;
        std::snprintf(name.data(), name.size(), "all, %.0f %%", 100.0 * kOverlaps[o]);
        by_overlap[o].print(name.data());
    }
    all.print("all");
}

}  // namespace treerec::bench
