#include "skeleton/cylinders/sections.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "geometry/parallel.h"
#include "geometry/random.h"
#include "scan/point_cloud.h"
#include "skeleton/cylinders/section_outline.h"
#include "skeleton/skeleton.h"

namespace treerec {
namespace {

// Over the mean radius, by the second to the fifth harmonic.
constexpr std::array<double, 4> kCosine = {0.10, -0.05, 0.03, 0.0};
constexpr std::array<double, 4> kSine = {0.04, 0.06, 0.0, 0.0};

double lobed(double angle) {
    double sum = 1.0;
    for (size_t i = 0; i < kCosine.size(); i++) {
        const double order = static_cast<double>(i + 2);
        sum += kCosine[i] * std::cos(order * angle) + kSine[i] * std::sin(order * angle);
    }
    return sum;
}

double shown(const SectionShape& shape, double angle) {
    double sum = 1.0;
    for (size_t i = 0; i < shape.cosine.size(); i++) {
        const double order = static_cast<double>(i + 2);
        sum += static_cast<double>(shape.cosine[i]) * std::cos(order * angle) +
               static_cast<double>(shape.sine[i]) * std::sin(order * angle);
    }
    return sum;
}

double farthest_off(const SectionShape& shape) {
    double most = 0.0;
    for (int i = 0; i < 360; i++)
        most = std::max(most, std::abs(shown(shape, i * kPi / 180.0) - lobed(i * kPi / 180.0)));
    return most;
}

// Points about a lobed section, from the share of directions that is seen.
std::vector<DVec2> points_around(size_t count, double noise, double seen, uint64_t seed,
                                 const DVec2& middle = DVec2(0.0)) {
    Random random(seed);
    std::vector<DVec2> points;
    for (size_t i = 0; i < count; i++) {
        const double angle = 0.7 + 2.0 * kPi * seen * random.uniform(0.0, 1.0);
        const double radius = lobed(angle) + noise * random.normal();
        points.push_back(middle + radius * DVec2(std::cos(angle), std::sin(angle)));
    }
    return points;
}

TEST(SectionOutline, ALobedSectionComesBack) {
    for (uint64_t seed = 1; seed <= 10; seed++) {
        const auto whole = outline_of(points_around(600, 0.03, 1.0, seed));
        ASSERT_TRUE(whole);
        EXPECT_LT(farthest_off(*whole), 0.03);
        const auto most = outline_of(points_around(600, 0.03, 0.85, seed));
        ASSERT_TRUE(most);
        EXPECT_LT(farthest_off(*most), 0.06);
    }
}

TEST(SectionOutline, AnAxisBesideTheMiddleChangesLittle) {
    const auto outline = outline_of(points_around(600, 0.02, 1.0, 3, DVec2(0.15, -0.1)));
    ASSERT_TRUE(outline);
    EXPECT_LT(farthest_off(*outline), 0.03);
}

TEST(SectionOutline, NothingIsInventedWhereTooLittleIsSeen) {
    EXPECT_TRUE(outline_of(points_around(600, 0.02, 0.75, 5)));
    EXPECT_FALSE(outline_of(points_around(600, 0.02, 0.65, 5)));
    EXPECT_FALSE(outline_of(points_around(600, 0.02, 0.4, 5)));
    EXPECT_FALSE(outline_of({}));
    EXPECT_FALSE(outline_of(points_around(30, 0.02, 1.0, 5)))
        << "most directions have a single point or none";
}

// A round section with noise shows no more than the noise could, and mostly nothing.
TEST(SectionOutline, NoiseIsNoShape) {
    size_t none = 0, all = 0;
    for (uint64_t seed = 1; seed <= 40; seed++) {
        Random random(seed);
        std::vector<DVec2> points;
        for (int i = 0; i < 300; i++) {
            const double angle = random.uniform(0.0, 2.0 * kPi), radius = 1.0 + 0.1 * random.normal();
            points.push_back(radius * DVec2(std::cos(angle), std::sin(angle)));
        }
        const auto outline = outline_of(points);
        ASSERT_TRUE(outline);
        for (size_t i = 0; i < SectionShape::kHarmonics; i++) {
            const double size = std::hypot(outline->cosine[i], outline->sine[i]);
            none += size == 0.0;
            all++;
            EXPECT_LT(size, 0.05);
        }
    }
    EXPECT_GT(none, all / 2);
}

TEST(SectionOutline, IvyOnOneSideAndLeavesGo) {
    std::vector<DVec2> points = points_around(900, 0.02, 1.0, 8);
    Random random(9);
    for (int i = 0; i < 200; i++) {
        const double angle = random.uniform(1.0, 1.5), radius = random.uniform(1.5, 2.1);
        points.push_back(radius * DVec2(std::cos(angle), std::sin(angle)));
    }
    const auto outline = outline_of(points);
    ASSERT_TRUE(outline);
    EXPECT_LT(farthest_off(*outline), 0.05);
}

TEST(SectionOutline, TheOrderOfPointsDoesNotMatter) {
    std::vector<DVec2> points = points_around(500, 0.03, 0.9, 11);
    const auto one = outline_of(points);
    std::reverse(points.begin(), points.end());
    EXPECT_EQ(one, outline_of(points));
}

// A leaning trunk of 4 m with a lobed section, seen from such a share of the directions, and a round branch.
struct Scanned {
    Tree tree;
    std::vector<Vec3> points;
};

Scanned scanned_trunk(double seen) {
    Scanned made;
    const DVec3 way = glm::normalize(DVec3(0.2, 1.0, -0.1)), zero = section_zero(way);
    const DVec3 across = glm::cross(way, zero);
    constexpr double kRadius = 0.2;
    NodeId at = made.tree.add_root({1, 0, 2}, kRadius, kTrunkFlag);
    const DVec3 base = made.tree.node(at).position;
    for (int i = 1; i <= 16; i++)
        at = made.tree.add_child(at, base + way * (0.25 * i), kRadius, kTrunkFlag);
    const NodeId branch = made.tree.add_child(8, base + way * 2.3 + zero * 0.6, 0.02);
    made.tree.add_child(branch, base + way * 2.5 + zero * 1.2, 0.02);
    Random random(21);
    for (int i = 0; i < 30000; i++) {
        const double angle = 0.3 + 2.0 * kPi * seen * random.uniform(0.0, 1.0);
        const double radius = kRadius * lobed(angle) + 0.004 * random.normal();
        made.points.emplace_back(base + way * random.uniform(0.0, 4.0) +
                                 radius * (zero * std::cos(angle) + across * std::sin(angle)));
    }
    return made;
}

TEST(Sections, ATrunkGetsThoseItsPointsShow) {
    for (const double seen : {1.0, 0.85}) {
        SCOPED_TRACE(seen);
        Scanned made = scanned_trunk(seen);
        const Tree before = made.tree;
        measure_sections(made.tree, made.points, Progress());
        EXPECT_EQ(made.tree.check(), std::nullopt);
        for (const NodeId id : made.tree.depth_first()) {
            EXPECT_EQ(made.tree.node(id).position, before.node(id).position);
            EXPECT_EQ(made.tree.node(id).radius, before.node(id).radius);
            const SectionShape* const shape = made.tree.section_of(id);
            if (made.tree.node(id).radius < 0.04) {
                EXPECT_EQ(shape, nullptr) << "thin wood has none";
                continue;
            }
            ASSERT_NE(shape, nullptr) << id;
            EXPECT_LT(farthest_off(*shape), seen == 1.0 ? 0.03 : 0.06) << id;
        }
    }
    Scanned half = scanned_trunk(0.55);
    measure_sections(half.tree, half.points, Progress());
    EXPECT_TRUE(half.tree.sections().empty());
}

TEST(Sections, AreTheSameWhateverTheOrderAndTheThreads) {
    Scanned one = scanned_trunk(0.9), other = one;
    std::reverse(other.points.begin(), other.points.end());
    measure_sections(one.tree, one.points, Progress());
    set_thread_count(1);
    measure_sections(other.tree, other.points, Progress());
    set_thread_count(0);
    ASSERT_FALSE(one.tree.sections().empty());
    EXPECT_EQ(one.tree.sections(), other.tree.sections());
}

TEST(Sections, ASkeletonHasThem) {
    PointCloud cloud;
    cloud.positions = scanned_trunk(1.0).points;
    for (Vec3& p : cloud.positions)
        p -= Vec3(1, 0, 2);
    const Tree tree = skeletonize(cloud, {}).tree;
    size_t measured = 0;
    for (const NodeId id : tree.depth_first())
        if (const SectionShape* const shape = tree.section_of(id)) {
            measured++;
            EXPECT_LT(farthest_off(*shape), 0.06);
        }
    EXPECT_GE(2 * measured, tree.size());
}

}  // namespace
}  // namespace treerec
