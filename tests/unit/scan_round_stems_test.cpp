#include "scan/stems/round_stems.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "geometry/random.h"
#include "pipeline/reconstruct.h"
#include "scan/cleaning/samples.h"
#include "scan/formats/read_cloud.h"
#include "scan/leaves/wood_leaf.h"
#include "scan/stems/separate_trees.h"
#include "scan_samples.h"

namespace treerec {
namespace {

constexpr double kHeight = 12.0;

double stem_radius(double y) {
    return 0.13 * (1.0 - y / kHeight) + 0.01;
}

DVec2 stem_centre(double y) {
    return {0.02 * y, 0.3 - 0.01 * y};
}

struct Spruce {
    std::vector<Vec3> points;
    std::vector<uint8_t> bark;  // by point
};

// Boughs to the ground, and grass. The scanner stands to one side and sees less than half of the stem between
// them, less and less of it further up.
Spruce make_spruce(uint64_t seed, bool with_stem, int points_per_twig = 16, double needles = 0.015) {
    Random random(seed);
    Spruce spruce;
    const auto add = [&](const DVec3& p, bool bark) {
        spruce.points.emplace_back(p + 0.003 * DVec3(random.normal(), random.normal(), random.normal()));
        spruce.bark.push_back(bark);
    };
    for (int i = 0; with_stem && i < 12000; i++) {
        const double y = kHeight * random.uniform();
        if (random.uniform() < y / kHeight) continue;
        const double turn = random.uniform(-1.3, 1.3);
        const DVec2 at = stem_centre(y) + stem_radius(y) * DVec2(std::cos(turn), std::sin(turn));
        add({at.x, y, at.y}, true);
    }
    for (double y = 0.3; y < kHeight; y += 0.25) {
        const double turn = random.uniform(0.0, 2.0 * kPi);
        for (int k = 0; k < 5; k++) {
            const double angle = turn + 2.0 * kPi * k / 5 + random.uniform(-0.3, 0.3);
            const double length = 0.15 + 1.3 * (1.0 - y / kHeight) * random.uniform(0.8, 1.2);
            const DVec3 out(std::cos(angle), 0.0, std::sin(angle)), side(-out.z, 0.0, out.x);
            for (int twig = 0; twig < 14; twig++) {
                const double along = length * random.uniform(0.1, 1.0);
                const DVec2 stem = stem_centre(y);
                const DVec3 start = DVec3(stem.x, y - 0.3 * along * along, stem.y) + along * out;
                const DVec3 way = 0.7 * out + (random.uniform() < 0.5 ? -1.0 : 1.0) * side - DVec3(0, 0.6, 0);
                for (int i = 0; i < points_per_twig; i++)
                    add(start + 0.35 * (length - 0.6 * along) * random.uniform() * way +
                            needles * DVec3(random.normal(), random.normal(), random.normal()),
                        false);
            }
        }
    }
    for (int i = 0; i < 2000; i++) {
        const double turn = random.uniform(0.0, 2.0 * kPi), away = std::sqrt(random.uniform());
        add({away * std::cos(turn), random.uniform(0.0, 0.15), away * std::sin(turn)}, false);
    }
    return spruce;
}

TEST(RoundStems, AStemIsFoundBetweenBoughs) {
    for (const uint64_t seed : {1, 2}) {
        SCOPED_TRACE(seed);
        const Samples samples = take_samples(make_spruce(seed, true).points, 400000, nullptr);
        const std::vector<RoundStem> stems = find_round_stems(samples.points, nullptr);
        ASSERT_EQ(stems.size(), 1U);
        EXPECT_LT(stems[0].front().y, 0.05 * kHeight);
        EXPECT_GT(stems[0].back().y, 0.5 * kHeight);
        for (const StemRing& ring : stems[0]) {
            if (ring.y > 0.7 * kHeight) break;  // its tip is hardly seen
            EXPECT_NEAR(ring.radius, stem_radius(ring.y), 0.015 + 0.1 * stem_radius(ring.y)) << ring.y;
            EXPECT_LT(glm::distance(ring.centre, stem_centre(ring.y)), 0.03) << ring.y;
        }
    }
}

TEST(RoundStems, LeavesAloneHaveNone) {
    for (const uint64_t seed : {1, 2}) {
        const Samples samples = take_samples(make_spruce(seed, false).points, 400000, nullptr);
        EXPECT_TRUE(find_round_stems(samples.points, nullptr).empty()) << seed;
    }
    EXPECT_TRUE(find_round_stems({}, nullptr).empty());
    EXPECT_TRUE(find_round_stems(std::vector<Vec3>(1), nullptr).empty());
}

// Boughs to the ground hide from above and from the side that two trees stand there.
// As mobile scanners see it: by 36 points of 3000 in a slice, a centimetre off.
TEST(RoundStems, FewPointsOfRoughBarkAmongManyLeavesAreSeen) {
    constexpr double kTall = 24.0, kRadius = 0.2;
    Random random(4);
    std::vector<Vec3> points;
    for (int i = 0; i < 240000; i++) {
        const double y = kTall * random.uniform(), turn = random.uniform(0.0, 2.0 * kPi);
        const double away = std::sqrt(random.uniform(0.5, 9.0));
        points.emplace_back(away * std::cos(turn), y, away * std::sin(turn));
    }
    for (int i = 0; i < 120 * static_cast<int>(kTall); i++) {
        const double turn = random.uniform(-1.5, 1.5), away = kRadius + 0.01 * random.normal();
        points.emplace_back(away * std::cos(turn), kTall * random.uniform(), away * std::sin(turn));
    }
    const std::vector<RoundStem> stems = find_round_stems(points, nullptr, kRoughBark);
    ASSERT_FALSE(stems.empty());
    for (const StemRing& ring : stems.front()) {
        EXPECT_LT(glm::length(ring.centre), 0.06) << "at " << ring.y;
        EXPECT_NEAR(ring.radius, kRadius, 0.05) << "at " << ring.y;
    }
}

TEST(RoundStems, TreesInAThicketStandApart) {
    const DVec3 apart(2.4, 0.0, 0.4);
    std::vector<Vec3> all = make_spruce(1, true).points;
    for (const Vec3& p : make_spruce(2, true).points)
        all.push_back(p + Vec3(apart));
    const Samples samples = take_samples(all, 400000, nullptr);
    std::vector<float> above;
    for (const Vec3& p : samples.points)
        above.push_back(p.y);
    std::vector<Stem> stems;
    add_round_stems(samples.points, above, kHeight, stems, nullptr);
    ASSERT_EQ(stems.size(), 2U);
    const DVec3 first(stem_centre(0.0).x, 0.0, stem_centre(0.0).y);
    for (const DVec3& foot : {first, first + apart})
        EXPECT_TRUE(std::any_of(stems.begin(), stems.end(), [&](const Stem& stem) {
            return glm::distance(stem.foot, foot) < 0.1 && std::abs(stem.radius - 0.1) < 0.04;
        })) << foot.x;
    // Those that are known already are not taken twice.
    add_round_stems(samples.points, above, kHeight, stems, nullptr);
    EXPECT_EQ(stems.size(), 2U);
}

TEST(RoundStems, TheSkeletonFollowsThem) {
    // The second one's boughs are so dense that by themselves they look like a blurred scan.
    for (const int points_per_twig : {16, 30}) {
        SCOPED_TRACE(points_per_twig);
        const Spruce spruce = make_spruce(1, true, points_per_twig, points_per_twig > 20 ? 0.03 : 0.015);
        PointCloud cloud;
        cloud.positions = spruce.points;
        const WoodLeaf told = tell_wood_from_leaves(cloud);
        ASSERT_TRUE(told.foliage);
        double bark = 0.0, found = 0.0, grass = 0.0;  // grass: that is taken for wood or leaves
        for (size_t i = 0; i < spruce.points.size(); i++) {
            const Vec3& p = spruce.points[i];
            if (spruce.bark[i] && p.y < 0.5 * kHeight) {
                bark += 1.0;
                found += told.wood_path[i];
            }
            if (!spruce.bark[i] && p.y < 0.15F && std::hypot(p.x, p.z - 0.3) > 0.5)
                grass += told.wood_path[i] + told.leaf[i];
        }
        EXPECT_GT(found, 0.95 * bark);
        EXPECT_EQ(grass, 0.0);
        const scan_test::Folder folder;
        write_cloud(folder.file("spruce.xyz"), cloud);
        ReconstructOptions options;
        options.orient.up = UpAxis::kY;
        const Reconstruction made = reconstruct_file(folder.file("spruce.xyz"), options);
        EXPECT_NEAR(made.measured.dbh, 2.0 * stem_radius(1.3), 0.1 * 2.0 * stem_radius(1.3));
        EXPECT_NEAR(made.measured.height, kHeight, 0.05 * kHeight);
        // Its boughs are branches, and not only those that are longer than a spruce's ever are.
        EXPECT_GT(made.measured.tips, 60U);
    }
}

}  // namespace
}  // namespace treerec
