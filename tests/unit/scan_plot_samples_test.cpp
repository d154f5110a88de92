#include <gtest/gtest.h>

#include "geometry/random.h"
#include "scan/samples.h"

namespace treerec {
namespace {

std::vector<Vec3> box_of(double width, double height, double depth, int count) {
    Random random(1);
    std::vector<Vec3> points;
    for (int i = 0; i < count; i++)
        points.emplace_back(random.uniform(0.0, width), random.uniform(0.0, height),
                            random.uniform(0.0, depth));
    return points;
}

TEST(SamplesFor, ATreeAndAPlotShowTheSameDetail) {
    EXPECT_EQ(samples_for(box_of(8.0, 20.0, 9.0, 500000)), 400000u);
    const size_t plot = samples_for(box_of(40.0, 20.0, 30.0, 500000));
    EXPECT_NEAR(static_cast<double>(plot), 1.2e6, 3e4);
    EXPECT_EQ(samples_for(box_of(400.0, 20.0, 300.0, 500000)), 3000000u);
}

TEST(SamplesFor, FlatAndSmallCloudsHaveALimitToo) {
    EXPECT_EQ(samples_for({}), 400000u);
    EXPECT_EQ(samples_for(box_of(400.0, 20.0, 300.0, 1000)), 400000u);
    EXPECT_EQ(samples_for(box_of(40.0, 0.0, 30.0, 500000)), 3000000u);
    EXPECT_EQ(samples_for(std::vector<Vec3>(500000, Vec3(1.0f))), 400000u);
}

}  // namespace
}  // namespace treerec
