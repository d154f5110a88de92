#include "geometry/kd_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "geometry/random.h"

namespace treerec {
namespace {

float square_of(const Vec3& a, const Vec3& b) {
    const Vec3 d = a - b;
    return d.x * d.x + d.y * d.y + d.z * d.z;
}

// Clouds that split badly as well: on a lattice, all at one place, on a line, over many scales.
std::vector<Vec3> cloud_of(int kind, size_t count, Random& random) {
    std::vector<Vec3> points(count);
    for (Vec3& p : points) {
        const auto next = [&] { return static_cast<float>(random.uniform(-1.0, 1.0)); };
        if (kind == 0) p = {next(), next(), next()};
        if (kind == 1) p = {std::round(2.0f * next()), std::round(2.0f * next()), std::round(2.0f * next())};
        if (kind == 2) p = {1.0f, 2.0f, 3.0f};
        if (kind == 3) p = {next(), 0.0f, -5.0f};
        if (kind == 4) p = {std::exp2(20.0f * next()), next(), 1e4f * next()};
    }
    return points;
}

TEST(KdTree, FindsTheNearestAndAllWithinADistance) {
    Random random(7);
    for (int trial = 0; trial < 300; trial++) {
        const size_t count = 1 + static_cast<size_t>(random.uniform(0.0, 400.0));
        const std::vector<Vec3> points = cloud_of(trial % 5, count, random);
        const KdTree tree(points, std::array<size_t, 3>{1, 10, 16}[static_cast<size_t>(trial) % 3]);
        for (int look = 0; look < 20; look++) {
            const Vec3 far(static_cast<float>(random.uniform(-3.0, 3.0)), 0.5f, -1.0f);
            const Vec3 p = look % 2 != 0 ? far : points[static_cast<size_t>(look * 31) % count];
            std::vector<float> squares(count);
            for (size_t i = 0; i < count; i++)
                squares[i] = square_of(p, points[i]);
            std::vector<float> sorted = squares;
            std::sort(sorted.begin(), sorted.end());

            std::array<uint32_t, 12> index{};
            std::array<float, 12> found{};
            const size_t wanted = 1 + static_cast<size_t>(look) % 12;
            const size_t got = tree.nearest(p, wanted, index.data(), found.data());
            ASSERT_EQ(got, std::min(wanted, count));
            EXPECT_EQ(std::set<uint32_t>(index.begin(), index.begin() + static_cast<ptrdiff_t>(got)).size(),
                      got);
            for (size_t i = 0; i < got; i++) {
                EXPECT_EQ(found[i], sorted[i]);
                EXPECT_EQ(found[i], squares[index[i]]);
            }

            const float reach = sorted[count / 2];
            std::vector<std::pair<uint32_t, float>> within{{0u, 0.0f}};
            tree.within(p, reach, within);
            const auto expected = std::lower_bound(sorted.begin(), sorted.end(), reach) - sorted.begin();
            ASSERT_EQ(static_cast<ptrdiff_t>(within.size()), expected);
            for (size_t i = 0; i < within.size(); i++) {
                EXPECT_EQ(within[i].second, sorted[i]);
                EXPECT_EQ(within[i].second, squares[within[i].first]);
            }
        }
    }
}

TEST(KdTree, OfNoPointsFindsNone) {
    const KdTree tree(std::vector<Vec3>{});
    uint32_t index = 0;
    float squared = 0.0f;
    EXPECT_EQ(tree.nearest(Vec3(0.0f), 1, &index, &squared), 0u);
    std::vector<std::pair<uint32_t, float>> within{{0u, 0.0f}};
    tree.within(Vec3(0.0f), 1e30f, within);
    EXPECT_TRUE(within.empty());
}

TEST(KdTree, LimitsThatFallAreKeptTo) {
    Random random(8);
    const std::vector<Vec3> points = cloud_of(0, 5000, random);
    const KdTree tree(points);
    struct Odd {  // the nearest point of an odd index
        float best = 1e9f;
        uint32_t index = 0;
        size_t looked_at = 0;
        float limit() const { return best; }
        void add(float squared, uint32_t candidate) {
            looked_at++;
            if (candidate % 2 == 0 || squared >= best) return;
            best = squared;
            index = candidate;
        }
    };
    for (size_t v = 0; v < points.size(); v += 50) {
        Odd odd;
        tree.search(points[v], odd);
        float best = 1e9f;
        for (size_t i = 1; i < points.size(); i += 2)
            best = std::min(best, square_of(points[v], points[i]));
        EXPECT_EQ(odd.best, best);
        EXPECT_EQ(square_of(points[v], points[odd.index]), best);
        EXPECT_LT(odd.looked_at, points.size() / 4);
    }
}

}  // namespace
}  // namespace treerec
