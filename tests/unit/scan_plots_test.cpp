// Plots of trees whose crowns touch: every stem is found, and the points go to the right ones.
#include <gtest/gtest.h>

#include <string>

#include "grown_plots.h"

namespace treerec {
namespace {

using namespace grown_plots;

PlotScore score_of(const PlotOptions& options) {
    const GrownPlot plot = make_plot(options);
    PickReport pick;
    return judge(plot, label_trees(plot.cloud, {}, pick), pick);
}

// Five street trees in a row once became one.
TEST(ScanPlots, AStreetIsFiveTrees) {
    for (const double overlap : {0.0, 0.6})
        for (const bool ground : {false, true}) {
            SCOPED_TRACE(std::to_string(overlap) + (ground ? " ground" : ""));
            const PlotScore score =
                score_of({.overlap = overlap, .ground = ground, .points = 6000, .seed = 6});
            EXPECT_EQ(score.found, 5U);
            EXPECT_EQ(score.false_ones, 0U);
            EXPECT_GE(score.right, overlap > 0.5 ? 0.85 : 0.93);
        }
}

TEST(ScanPlots, TreesInLeafStandApart) {
    const PlotScore score = score_of({.trees = 4,
                                      .row = false,
                                      .overlap = 0.2,
                                      .ground = true,
                                      .leaves = 0.5,
                                      .points = 10000,
                                      .seed = 2});
    EXPECT_EQ(score.found, 4U);
    EXPECT_EQ(score.false_ones, 0U);
    EXPECT_GE(score.right, 0.95);
}

// Stray beams below the feet are not where the ground is.
TEST(ScanPlots, DustBelowTheFeetHidesNoStem) {
    GrownPlot plot = make_plot({.trees = 3, .points = 10000, .seed = 3});
    for (int i = 0; i < 4; i++) {
        plot.cloud.positions.emplace_back(2.0F * static_cast<float>(i), -1.5F, 0.5F);
        plot.owner.push_back(kNoTree);
    }
    PickReport pick;
    const PlotScore score = judge(plot, label_trees(plot.cloud, {}, pick), pick);
    EXPECT_EQ(score.found, 3U);
    EXPECT_GE(score.right, 0.95);
}

}  // namespace
}  // namespace treerec
