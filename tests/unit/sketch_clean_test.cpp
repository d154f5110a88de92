// Strokes without noise (Ma and Liu 2020, 2.1).
#include "sketch/clean.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "cases.h"
#include "geometry/random.h"

namespace treerec {
namespace {

TEST(SketchClean, PointsNearTheLastKeptGo) {
    Random random(1);
    for (int k = 0; k < test::cases(500); k++) {
        FlatLine line;
        DVec2 p(0.0);
        const double step = random.uniform(0.05, 8.0);
        for (int i = 0; i < 200; i++, p += step * DVec2(random.uniform(0.2, 1.0), random.normal()))
            line.push_back(p);
        const FlatLine thin = thin_line(line, 3.0);
        EXPECT_EQ(thin.front(), line.front());
        EXPECT_EQ(thin.back(), line.back());
        for (size_t i = 0; i + 2 < thin.size(); i++)
            EXPECT_GE(glm::length(thin[i + 1] - thin[i]), 3.0);
        // Each that went lay near one that stayed.
        for (const DVec2& q : line)
            EXPECT_LT(nearest_on_line(thin, q).distance, 3.0);
    }
}

// A slow stroke's points are all near the one before; against that one, all would go.
TEST(SketchClean, SlowStrokesKeepTheirShape) {
    FlatLine slow;
    for (int i = 0; i <= 3000; i++)
        slow.emplace_back(0.2 * i, 100.0 * std::sin(0.01 * i));
    const std::vector<FlatLine> clean = clean_lines(std::vector<FlatLine>{slow});
    EXPECT_GT(clean[0].size(), 150u);
    for (const DVec2& p : slow)
        EXPECT_LT(nearest_on_line(clean[0], p).distance, 1.0);
}

TEST(SketchClean, Equation1) {
    Random random(2);
    FlatLine line;
    for (int i = 0; i < 40; i++)
        line.emplace_back(4.0 * i, random.normal());
    const FlatLine smooth = smooth_line(line, std::vector<bool>(line.size(), false));
    ASSERT_EQ(smooth.size(), line.size());
    for (size_t i = 2; i + 2 < line.size(); i++) {
        const DVec2 mean = 0.07 * line[i - 2] + 0.13 * line[i - 1] + 0.60 * line[i] + 0.13 * line[i + 1] +
                           0.07 * line[i + 2];
        EXPECT_LT(glm::length(smooth[i] - mean), 1e-12);
    }
    for (const size_t end : {size_t{0}, size_t{1}, line.size() - 2, line.size() - 1})
        EXPECT_EQ(smooth[end], line[end]);
}

// Corners that somebody put, with nothing between them, are no noise.
TEST(SketchClean, DrawnCornersStay) {
    const FlatLine corners = {{0, 0}, {100, 0}, {100, 80}, {20, 80}, {60, 10}};
    const std::vector<FlatLine> clean = clean_lines(std::vector<FlatLine>{corners});
    for (const DVec2& p : corners)
        EXPECT_LT(nearest_on_line(clean[0], p).distance, 1e-9);
    for (const DVec2& p : clean[0])
        EXPECT_LT(nearest_on_line(corners, p).distance, 1.0);
    EXPECT_GT(clean[0].size(), 80u);
}

TEST(SketchClean, WorkStaysBounded) {
    Random random(3);
    std::vector<FlatLine> lines(20);
    for (FlatLine& line : lines)
        for (int i = 0; i < 10000; i++)
            line.emplace_back(random.uniform(-1e7, 1e7), random.uniform(-1e7, 1e7));
    size_t points = 0;
    for (const FlatLine& line : clean_lines(lines))
        points += line.size();
    EXPECT_LT(points, 100000u);
}

}  // namespace
}  // namespace treerec
