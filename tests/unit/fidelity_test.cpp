#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "error.h"
#include "fidelity/score.h"
#include "geometry/capsule_tree.h"
#include "geometry/parallel.h"
#include "geometry/random.h"
#include "synth/grow.h"
#include "tree/wood_segments.h"

namespace treerec {
namespace {

Tree grown(uint64_t seed) {
    return grow_tree({Habit::kBroadleaf, 5.0, seed});
}

// Points on the bark of `tree`, moved by `noise` along the normal.
PointCloud bark_points(const Tree& tree, size_t count, double noise, uint64_t seed) {
    const std::vector<WoodSegment> wood = wood_segments(tree);
    Random random(seed);
    PointCloud cloud;
    cloud.frame = tree.frame();
    for (size_t i = 0; i < count; i++) {
        const WoodSegment& segment = wood[random.below(static_cast<uint32_t>(wood.size()))];
        const DVec3 axis = glm::normalize(segment.to - segment.from);
        const DVec3 side = any_perpendicular(axis);
        const double angle = random.uniform(0.0, 2.0 * kPi);
        const DVec3 out = std::cos(angle) * side + std::sin(angle) * glm::cross(axis, side);
        cloud.positions.emplace_back(glm::mix(segment.from, segment.to, random.uniform()) +
                                     (segment.radius + noise * random.normal()) * out);
    }
    return cloud;
}

TEST(CapsuleTree, FindsWhatASlowSearchFinds) {
    const std::vector<WoodSegment> wood = wood_segments(grown(3));
    const CapsuleTree tree(wood);
    Random random(5);
    int32_t hint = -1, surface_hint = -1;
    for (int i = 0; i < 300; i++) {
        const DVec3 p(random.uniform(-3, 3), random.uniform(-1, 6), random.uniform(-3, 3));
        double axis = std::numeric_limits<double>::max(), surface = axis;
        for (const WoodSegment& segment : wood) {
            const double d = distance_to_segment(p, segment.from, segment.to);
            axis = std::min(axis, d);
            surface = std::min(surface, std::abs(d - segment.radius));
        }
        const CapsuleTree::Hit hit = tree.nearest_axis(p, hint);
        hint = hit.segment;
        EXPECT_DOUBLE_EQ(hit.distance, axis);
        int32_t none = -1;
        EXPECT_DOUBLE_EQ(tree.surface_distance(p, none), surface);
        EXPECT_DOUBLE_EQ(tree.surface_distance(p, surface_hint), surface);
        const WoodSegment& found = tree.segment(surface_hint);
        EXPECT_DOUBLE_EQ(std::abs(distance_to_segment(p, found.from, found.to) - found.radius), surface);
    }
}

TEST(Score, ATreeAgainstItselfIsPerfect) {
    for (uint64_t seed = 1; seed < 4; seed++) {
        const Tree tree = grown(seed);
        const SkeletonScore score = score_skeleton(tree, tree);
        for (const Agreement& agreement : score.by_radius)
            EXPECT_EQ(agreement.f, 1.0) << agreement.threshold;
        for (const Agreement& agreement : score.by_distance)
            EXPECT_EQ(agreement.f, 1.0) << agreement.threshold;
        EXPECT_LT(score.chamfer_mm, 1e-6);
        EXPECT_EQ(score.length_error, 0.0);
        EXPECT_EQ(score.volume_error, 0.0);
        EXPECT_EQ(score.radius_error_abs, 0.0);
    }
}

TEST(Score, FallsAsTheTreeIsShaken) {
    const Tree tree = grown(2);
    double last_f = 1.0, last_chamfer = 0.0;
    for (double amount : {0.002, 0.01, 0.05}) {
        Tree shaken = tree;
        Random random(8);
        for (NodeId id : tree.depth_first())
            shaken.set_position(id, tree.node(id).position + amount * random.direction());
        const SkeletonScore score = score_skeleton(shaken, tree);
        EXPECT_LT(score.by_radius[2].f, last_f);
        EXPECT_GT(score.chamfer_mm, last_chamfer);
        EXPECT_LT(score.chamfer_mm, 1000.0 * amount);
        last_f = score.by_radius[2].f;
        last_chamfer = score.chamfer_mm;
    }
}

TEST(Score, AMissingBranchCostsRecallAndAnExtraOneCostsPrecision) {
    Tree whole;
    const NodeId root = whole.add_root(DVec3(0.0), 0.1);
    const NodeId top = whole.add_child(root, DVec3(0, 3, 0), 0.1);
    Tree part = whole;
    whole.add_child(top, DVec3(1, 3, 0), 0.02);
    const SkeletonScore missing = score_skeleton(part, whole);
    EXPECT_EQ(missing.by_radius[0].precision, 1.0);
    EXPECT_NEAR(missing.by_radius[0].recall, 0.75, 1e-3);
    EXPECT_NEAR(missing.by_distance[1].recall, 3.01 / 4.0, 1e-3);
    EXPECT_NEAR(missing.length_error, -0.25, 1e-12);
    EXPECT_NEAR(missing.chamfer_mm, 1000.0 * 0.5 * (0.5 * 1.0 / 4.0), 0.1);
    const SkeletonScore extra = score_skeleton(whole, part);
    EXPECT_EQ(extra.by_radius[0].recall, 1.0);
    EXPECT_NEAR(extra.by_radius[0].precision, 0.75, 1e-3);
    // The reference's radius is the yardstick: its own is 10 cm at the top.
    EXPECT_NEAR(extra.by_radius[4].precision, 3.1 / 4.0, 1e-3);
}

TEST(Score, MeasuresTheRadiusError) {
    const Tree tree = grown(1);
    Tree thick = tree;
    for (NodeId id : tree.depth_first())
        thick.set_radius(id, 1.1 * tree.node(id).radius);
    const SkeletonScore score = score_skeleton(thick, tree);
    EXPECT_NEAR(score.radius_error, 0.1, 1e-9);
    EXPECT_NEAR(score.radius_error_abs, 0.1, 1e-9);
    EXPECT_NEAR(score.volume_error, 0.21, 1e-9);
}

TEST(Score, TellsRadiusErrorsByThickness) {
    // One stem, and one twig that came out twice as thick; a second twig that was missed.
    Tree truth;
    const NodeId root = truth.add_root(DVec3(0.0), 0.1);
    const NodeId top = truth.add_child(root, DVec3(0, 2, 0), 0.1);
    const NodeId twig = truth.add_child(top, DVec3(1, 2, 0), 0.004);
    Tree found = truth;
    found.set_radius(twig, 0.008);
    truth.add_child(root, DVec3(0, 0, 2), 0.02);
    const SkeletonScore score = score_skeleton(found, truth);
    ASSERT_EQ(score.radius_by_thickness.size(), 5u);
    EXPECT_NEAR(score.radius_by_thickness[0].error, 1.0, 1e-9);
    EXPECT_NEAR(score.radius_by_thickness[0].error_abs, 1.0, 1e-9);
    EXPECT_NEAR(score.radius_by_thickness[0].length, 1.0, 0.01);
    EXPECT_NEAR(score.radius_by_thickness[2].length, 0.02, 0.002);
    EXPECT_EQ(score.radius_by_thickness[4].error, 0.0);
    EXPECT_NEAR(score.radius_by_thickness[4].length, 2.0, 0.01);
    // What was found is true; of 5 m, 2 m were missed, but for what lies within the stem's radius.
    EXPECT_EQ(score.match.precision, 1.0);
    EXPECT_NEAR(score.match.recall, 3.1 / 5.0, 1e-3);
    EXPECT_NEAR(score_skeleton(found, truth, nullptr, 0.01).match.recall, score.match.recall, 0.01);
    EXPECT_THROW(score_skeleton(found, truth, nullptr, 0.0), Error);
}

TEST(Score, ScanErrorIsTheNoise) {
    const Tree tree = grown(2);
    EXPECT_LT(score_scan(tree, bark_points(tree, 5000, 0.0, 3)).p95_mm, 0.01);
    double last = 0.0;
    for (double noise : {0.001, 0.003, 0.01}) {
        const ScanScore score = score_scan(tree, bark_points(tree, 5000, noise, 3), noise);
        EXPECT_LT(score.median_mm,
                  1000.0 * noise * 0.70);  // of |normal| it is 0.6745; other wood may be nearer
        EXPECT_GT(score.median_mm, last);
        EXPECT_GE(score.explained_2cm_noise, score.explained_2cm);
        last = score.median_mm;
    }
}

TEST(Score, DoesNotDependOnFramesOrderOrThreads) {
    const Tree tree = grown(2);
    PointCloud cloud = bark_points(tree, 3000, 0.004, 3);
    const ScanScore before = score_scan(tree, cloud);
    std::reverse(cloud.positions.begin(), cloud.positions.end());
    set_thread_count(1);
    const ScanScore reversed = score_scan(tree, cloud);
    const SkeletonScore one = score_skeleton(grown(1), tree);
    set_thread_count(3);
    const SkeletonScore three = score_skeleton(grown(1), tree);
    set_thread_count(0);
    EXPECT_EQ(before.mean_mm, reversed.mean_mm);
    EXPECT_EQ(one.chamfer_mm, three.chamfer_mm);
    // The same tree kept in another axis, unit and origin.
    Tree moved = tree;
    moved.rebase(DVec3(1.0, 2.0, 3.0));
    EXPECT_NEAR(score_scan(moved, cloud).mean_mm, before.mean_mm, 1e-3);
    EXPECT_EQ(score_skeleton(moved, tree).by_radius[0].f, 1.0);
}

TEST(Score, ASampleStandsForTheCloud) {
    const Tree tree = grown(2);
    PointCloud cloud = bark_points(tree, 40000, 0.01, 3);
    const ScanScore all = score_scan(tree, cloud);
    const ScanScore some = score_scan(tree, cloud, 0.0, nullptr, 4000);
    EXPECT_EQ(all.points, 40000u);
    EXPECT_NEAR(static_cast<double>(some.points), 4000.0, 300.0);
    EXPECT_NEAR(some.median_mm, all.median_mm, 0.05 * all.median_mm);
    EXPECT_NEAR(some.explained_2cm, all.explained_2cm, 0.02);
    std::reverse(cloud.positions.begin(), cloud.positions.end());
    EXPECT_EQ(score_scan(tree, cloud, 0.0, nullptr, 4000).mean_mm, some.mean_mm);
    EXPECT_EQ(score_scan(tree, cloud, 0.0, nullptr, 80000).points, 40000u);
}

TEST(Score, RefusesWhatHasNoWood) {
    Tree root_only;
    root_only.add_root(DVec3(0.0), 0.1);
    const Tree tree = grown(1);
    EXPECT_THROW(score_skeleton(root_only, tree), Error);
    EXPECT_THROW(score_skeleton(tree, root_only), Error);
    EXPECT_THROW(score_scan(tree, PointCloud{}), Error);
    Tree huge = root_only;
    huge.add_child(huge.root(), DVec3(0, 1e9, 0), 0.1);
    EXPECT_THROW(score_skeleton(huge, tree), Error);
}

}  // namespace
}  // namespace treerec
