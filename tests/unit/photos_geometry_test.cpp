// Which matches of two photos can be true together.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "geometry/symmetric_eigen.h"
#include "photos/pair_geometry.h"
#include "photos_warps.h"

namespace treerec {
namespace {

constexpr double kFocal = 1700.0;

DVec2 seen(const DVec3& p) {
    return kFocal * DVec2(p) / p.z + DVec2(800.0, 1200.0);
}

// A walker's two photos of a tree, the ground and what stands behind, `wrong` of the matches from anywhere to
// anywhere, the others off by `noise` pixels. The first ones are right.
std::vector<PlacePair> matches_of(Random& random, size_t count, double wrong, double noise) {
    const double angle = random.uniform(0.05, 0.35), side = std::sin(angle), ahead = std::cos(angle);
    std::vector<PlacePair> matches;
    const auto right = static_cast<size_t>((1.0 - wrong) * static_cast<double>(count));
    while (matches.size() < right) {
        DVec3 p;
        switch (matches.size() % 3) {
            case 0:
                p = {random.uniform(-3, 3), random.uniform(-7, 1.5), 11.0 + random.uniform(-3, 3)};
                break;
            case 1:
                p = {random.uniform(-6, 6), 1.6, random.uniform(4, 25)};
                break;
            default:
                p = {random.uniform(-20, 20), random.uniform(-4, 1), 40.0 + random.uniform(-3, 3)};
        }
        // Turned around what stands 11 in front of the first camera.
        const DVec3 about(p.x, p.y, p.z - 11.0);
        const DVec3 q(ahead * about.x + side * about.z, about.y, -side * about.x + ahead * about.z + 11.3);
        matches.push_back({seen(p) + noise * DVec2(random.normal(), random.normal()),
                           seen(q) + noise * DVec2(random.normal(), random.normal())});
    }
    while (matches.size() < count)
        matches.push_back({{random.uniform(0, 1600), random.uniform(0, 2400)},
                           {random.uniform(0, 1600), random.uniform(0, 2400)}});
    return matches;
}

TEST(PairGeometry, TellsRightMatchesFromWrongOnes) {
    Random random(3);
    for (const double wrong : {0.0, 0.2, 0.4, 0.5})
        for (int round = 0; round < 4; round++) {
            const size_t count = 60 + random.below(600);
            const std::vector<PlacePair> matches = matches_of(random, count, wrong, 0.4);
            const auto right = static_cast<ptrdiff_t>((1.0 - wrong) * static_cast<double>(count));
            const std::vector<uint8_t> agreeing = agreeing_on_geometry(matches);
            const double kept = std::accumulate(agreeing.begin(), agreeing.begin() + right, 0.0);
            const double slipped = std::accumulate(agreeing.begin() + right, agreeing.end(), 0.0);
            EXPECT_GT(kept, 0.9 * static_cast<double>(right)) << count << " " << wrong;
            EXPECT_LE(slipped, 1.0 + 0.04 * static_cast<double>(agreeing.end() - agreeing.begin() - right));
        }
}

TEST(PairGeometry, WhatHasNothingInCommonDoesNotAgree) {
    Random random(4);
    const std::vector<PlacePair> strangers = matches_of(random, 300, 1.0, 0.0);
    const std::vector<PlacePair> few = matches_of(random, 14, 0.0, 0.1);
    for (const auto& matches : {strangers, few, std::vector<PlacePair>{}}) {
        const std::vector<uint8_t> agreeing = agreeing_on_geometry(matches);
        ASSERT_EQ(agreeing.size(), matches.size());
        EXPECT_EQ(std::count(agreeing.begin(), agreeing.end(), uint8_t{1}), 0);
    }
    // One place for all, and places that are no numbers, are told nothing of, and end.
    const std::vector<PlacePair> same(100, {{5.0, 5.0}, {7.0, 7.0}});
    EXPECT_EQ(agreeing_on_geometry(same).size(), 100u);
    const std::vector<PlacePair> none(100, {{NAN, 5.0}, {7.0, INFINITY}});
    const std::vector<uint8_t> agreeing = agreeing_on_geometry(none);
    EXPECT_EQ(std::count(agreeing.begin(), agreeing.end(), uint8_t{1}), 0);
}

TEST(PairGeometry, IsTheSameEachTime) {
    Random random(5);
    const std::vector<PlacePair> matches = matches_of(random, 400, 0.5, 0.5);
    EXPECT_EQ(agreeing_on_geometry(matches), agreeing_on_geometry(matches));
}

// Tiles of one picture over and over, as a fence has them, below what is different everywhere.
Image fence(const DVec2& shift) {
    Image image(test::kDrawnWidth, test::kDrawnHeight, 1);
    for (int y = 0; y < image.height; y++)
        for (int x = 0; x < image.width; x++) {
            DVec2 p = DVec2(x, y) - shift;
            if (p.y > 200.0) p.x -= 60.0 * std::floor(p.x / 60.0);
            *image.at(x, y) = static_cast<uint8_t>(test::drawn_grey(p, 8) + 0.5);
        }
    return image;
}

TEST(PairGeometry, WhatIsThereTwiceIsNoMatch) {
    // Moved by half a tile, so that the next tile is as near as the true one.
    const PhotoFeatures one = features_of(fence({0.0, 0.0}), {}), other = features_of(fence({31.0, 2.0}), {});
    size_t tiles[2] = {0, 0};
    for (const size_t rivals : {0, 2}) {
        MatchOptions options;
        options.geometry.reset();
        options.rivals = rivals;
        size_t above = 0;
        for (const PointMatch& match : match_pair(one, other, options).matches)
            if (match.kept) (one.corners[match.corner].place.y > 215.0 ? tiles[rivals / 2] : above)++;
        EXPECT_GT(above, 60u);
    }
    EXPECT_GT(tiles[0], 30u) << "The picture is no trap.";
    EXPECT_LT(5 * tiles[1], tiles[0]);
}

TEST(SymmetricEigen, TakesAnyMatrixApart) {
    Random random(6);
    for (int round = 0; round < 200; round++) {
        SquareMatrix<9> matrix{};
        const double size = std::pow(10.0, random.uniform(-8, 8));
        // Of any rank, none included.
        for (uint32_t k = random.below(12); k > 0; k--) {
            std::array<double, 9> way;
            for (double& value : way)
                value = random.normal();
            for (size_t i = 0; i < 9; i++)
                for (size_t j = 0; j < 9; j++)
                    matrix[i][j] += size * way[i] * way[j];
        }
        const SymmetricEigen<9> eigen = symmetric_eigen(matrix);
        for (size_t k = 0; k < 9; k++) {
            EXPECT_GE(eigen.values[k], eigen.values[eigen.smallest()]);
            for (size_t i = 0; i < 9; i++) {
                double turned = 0.0, product = 0.0;
                for (size_t j = 0; j < 9; j++) {
                    turned += matrix[i][j] * eigen.vectors[j][k];
                    product += eigen.vectors[j][i] * eigen.vectors[j][k];
                }
                EXPECT_NEAR(turned, eigen.values[k] * eigen.vectors[i][k], 1e-12 * size * 200.0);
                EXPECT_NEAR(product, i == k ? 1.0 : 0.0, 1e-12);
            }
        }
    }
}

}  // namespace
}  // namespace treerec
