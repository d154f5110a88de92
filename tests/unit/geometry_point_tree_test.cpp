#include "geometry/point_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "geometry/parallel.h"
#include "geometry/random.h"

namespace treerec {
namespace {

float square_of(const Vec3& a, const Vec3& b) {
    const Vec3 d = a - b;
    return d.x * d.x + d.y * d.y + d.z * d.z;
}

constexpr int kKinds = 8;

// Clouds that split badly as well: on a lattice, all at one place, on a line, on a plane, over many scales.
std::vector<Vec3> cloud_of(int kind, size_t count, Random& random) {
    std::vector<Vec3> points(count);
    for (Vec3& p : points) {
        const auto next = [&] { return static_cast<float>(random.uniform(-1.0, 1.0)); };
        if (kind == 0) p = {next(), next(), next()};
        if (kind == 1) p = {std::round(2.0F * next()), std::round(2.0F * next()), std::round(2.0F * next())};
        if (kind == 2) p = {1.0F, 2.0F, 3.0F};
        if (kind == 3) p = {next(), 0.0F, -5.0F};
        if (kind == 4) p = {next(), next(), 7.0F};
        if (kind == 5) p = {std::exp2(20.0F * next()), next(), 1e4F * next()};
        // Knots far smaller than the finest cell of the whole, and lone points.
        if (kind == 6) p = std::round(3.0F * next()) * Vec3(1e3F) + 1e-3F * Vec3(next(), next(), next());
        if (kind == 7) p = std::exp2(30.0F * next()) * Vec3(next(), next(), next());
    }
    return points;
}

using Near = std::pair<float, uint32_t>;

// All points by distance, of equals the first one first.
std::vector<Near> by_distance(const std::vector<Vec3>& points, const Vec3& p) {
    std::vector<Near> near;
    for (size_t i = 0; i < points.size(); i++)
        near.emplace_back(square_of(p, points[i]), static_cast<uint32_t>(i));
    std::sort(near.begin(), near.end());
    return near;
}

TEST(PointTree, FindsTheNearestOfAPlace) {
    Random random(7);
    for (int trial = 0; trial < 400; trial++) {
        const size_t count = 1 + random.below(400);
        const std::vector<Vec3> points = cloud_of(trial % kKinds, count, random);
        const PointTree tree(points);
        for (uint32_t look = 0; look < 20; look++) {
            const Vec3 far(static_cast<float>(random.uniform(-3.0, 3.0)), 0.5F, -1.0F);
            const Vec3 p = look % 2 != 0 ? far : points[look * 31 % count];
            const std::vector<Near> expected = by_distance(points, p);
            std::array<uint32_t, 12> index{};
            std::array<float, 12> squared{};
            const size_t wanted = 1 + look % 12;
            ASSERT_EQ(tree.nearest(p, wanted, index.data(), squared.data()), std::min(wanted, count));
            for (size_t i = 0; i < std::min(wanted, count); i++)
                ASSERT_EQ(Near(squared[i], index[i]), expected[i]);
        }
    }
}

TEST(PointTree, FindsTheNearestOfAllPoints) {
    Random random(8);
    const SubProgress progress(nullptr, 0.0, 1.0);
    for (int trial = 0; trial < 120; trial++) {
        const size_t count = 2 + random.below(trial < 100 ? 100 : 800);
        const std::vector<Vec3> points = cloud_of(trial % kKinds, count, random);
        const size_t wanted =
            std::min<size_t>(trial % 10 == 9 ? PointTree::kMostNearest : 1 + trial % 10, count - 1);
        set_thread_count(1 + trial % 3);
        const std::vector<uint32_t> nearest = PointTree(points).nearest_of_all(wanted, progress);
        ASSERT_EQ(nearest.size(), count * wanted);
        for (uint32_t v = 0; v < count; v++) {
            std::vector<Near> expected = by_distance(points, points[v]);
            std::erase(expected, Near(0.0F, v));
            for (size_t i = 0; i < wanted; i++)
                ASSERT_EQ(nearest[v * wanted + i], expected[i].second) << trial << ' ' << v << ' ' << i;
        }
    }
    set_thread_count(0);
}

// Collects all within a distance.
struct Within {
    float squared;
    std::vector<Near> found;
    float limit() const { return squared; }
    void add(float distance, uint32_t v) { found.emplace_back(distance, v); }
};

TEST(PointTree, FindsAllWithinADistanceButInNodesNotEntered) {
    Random random(9);
    for (int trial = 0; trial < 200; trial++) {
        const size_t count = 1 + random.below(600);
        const std::vector<Vec3> points = cloud_of(trial % kKinds, count, random);
        const PointTree tree(points);
        // The points of every group, and the nodes of every block, come once.
        std::vector<int> seen(count, 0), held(tree.node_count(), 0);
        // Nodes whose points are all of an even index.
        std::vector<uint8_t> even(tree.node_count(), 1);
        for (size_t node = 0; node < tree.node_count(); node++) {
            if (node < tree.group_count()) {
                for (const uint32_t v : tree.in_group(node)) {
                    seen[v]++;
                    even[node] &= v % 2 == 0;
                }
            } else {
                for (const uint32_t child : tree.in_block(node)) {
                    ASSERT_LT(child, node);
                    held[child]++;
                    even[node] &= even[child];
                }
            }
        }
        EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), static_cast<ptrdiff_t>(count));
        EXPECT_EQ(std::count(held.begin(), held.end() - 1, 1), static_cast<ptrdiff_t>(tree.node_count() - 1));
        EXPECT_EQ(held.back(), 0);
        const Vec3 p = points[random.below(static_cast<uint32_t>(count))];
        const std::vector<Near> sorted = by_distance(points, p);
        Within all{sorted[count / 2].first, {}}, odd{sorted[count / 2].first, {}};
        tree.search(p, all);
        tree.search(p, odd, [&](uint32_t node) { return !even[node]; });
        std::sort(all.found.begin(), all.found.end());
        std::vector<Near> expected = sorted;
        std::erase_if(expected, [&](const Near& near) { return near.first > all.squared; });
        EXPECT_EQ(all.found, expected);
        std::erase_if(odd.found, [](const Near& near) { return near.second % 2 == 0; });
        std::erase_if(expected, [](const Near& near) { return near.second % 2 == 0; });
        std::sort(odd.found.begin(), odd.found.end());
        EXPECT_EQ(odd.found, expected);
    }
}

TEST(PointTree, OfNoPointsFindsNone) {
    const PointTree tree(std::vector<Vec3>{});
    uint32_t index = 0;
    float squared = 0.0F;
    EXPECT_EQ(tree.nearest(Vec3(0.0F), 1, &index, &squared), 0U);
    Within within{1e30F, {}};
    tree.search(Vec3(0.0F), within);
    EXPECT_TRUE(within.found.empty());
}

TEST(PointTree, PointsTooFarApartForAFloatDoNotSeeEachOther) {
    const std::vector<Vec3> points{Vec3(0.0F), Vec3(1.0F), Vec3(3e38F), Vec3(-3e38F)};
    const PointTree tree(points);
    std::array<uint32_t, 4> index{};
    std::array<float, 4> squared{};
    EXPECT_EQ(tree.nearest(points[1], 4, index.data(), squared.data()), 2U);
    EXPECT_EQ(index[0], 1U);
    EXPECT_EQ(index[1], 0U);
    const SubProgress progress(nullptr, 0.0, 1.0);
    EXPECT_EQ(tree.nearest_of_all(1, progress), (std::vector<uint32_t>{1, 0, 0, 0}));
}

TEST(PointTree, LimitsThatFallAreKeptTo) {
    Random random(10);
    const std::vector<Vec3> points = cloud_of(0, 5000, random);
    const PointTree tree(points);
    struct Odd {  // the nearest point of an odd index
        float best = 1e9F;
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
        float best = 1e9F;
        for (size_t i = 1; i < points.size(); i += 2)
            best = std::min(best, square_of(points[v], points[i]));
        EXPECT_EQ(odd.best, best);
        EXPECT_EQ(square_of(points[v], points[odd.index]), best);
        EXPECT_LT(odd.looked_at, points.size() / 20);
    }
}

}  // namespace
}  // namespace treerec
