// How faithful a tree is (fidelity/fidelity.h), and what stays the same whichever way it is measured.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "edit/lighten/lighten.h"
#include "error.h"
#include "fidelity/fidelity.h"
#include "fidelity/score.h"
#include "geometry/capsule_tree.h"
#include "geometry/parallel.h"
#include "geometry/random.h"
#include "random_tree.h"
#include "tree/branches.h"
#include "tree/wood_segments.h"

namespace treerec {
namespace {

// Points on the bark of `tree`, as many as its area asks for, moved outwards by noise.
PointCloud bark_points(const Tree& tree, size_t count, double noise, uint64_t seed) {
    const std::vector<WoodSegment> wood = wood_segments(tree);
    std::vector<double> area{0.0};
    for (const WoodSegment& s : wood)
        area.push_back(area.back() + s.radius * glm::distance(s.from, s.to));
    Random random(seed);
    PointCloud cloud;
    cloud.frame = tree.frame();
    while (cloud.size() < count) {
        const double at = random.uniform(0.0, area.back());
        const size_t i =
            static_cast<size_t>(std::upper_bound(area.begin(), area.end() - 1, at) - area.begin()) - 1;
        const WoodSegment& segment = wood[i];
        if (segment.from == segment.to) continue;
        const DVec3 axis = glm::normalize(segment.to - segment.from);
        const DVec3 side = any_perpendicular(axis);
        const double angle = random.uniform(0.0, 2.0 * kPi);
        const DVec3 out = std::cos(angle) * side + std::sin(angle) * glm::cross(axis, side);
        cloud.positions.emplace_back(glm::mix(segment.from, segment.to, random.uniform()) +
                                     (segment.radius + noise * random.normal()) * out);
    }
    return cloud;
}

// From the text of definition 7.4 alone: in a ball, or between the planes of a frustum's ends and no farther
// from its axis than its radius there; with a tolerance, near a place of which that holds.
bool slowly_held(const WoodSegment& s, const DVec3& p, double tolerance) {
    double least = std::min(glm::distance(p, s.from) - s.from_radius, glm::distance(p, s.to) - s.radius);
    const DVec3 axis = normalized_or(s.to - s.from, DVec3(0.0, 1.0, 0.0));
    const double length = glm::distance(s.from, s.to);
    const double x = glm::dot(p - s.from, axis), y = glm::length(p - s.from - x * axis);
    for (int i = 0; i <= 20000 && length > 0.0; i++) {
        const double t = i / 20000.0;
        const double across = std::max(0.0, y - glm::mix(s.from_radius, s.radius, t));
        least = std::min(least, std::hypot(x - t * length, across));
    }
    return least <= tolerance;
}

TEST(Fidelity, TheSolidIsBallsAndFrusta) {
    Random random(4);
    for (int i = 0; i < 300; i++) {
        WoodSegment s;
        s.from = random.direction();
        s.to = s.from + random.uniform(0.0, 2.0) * random.direction();
        s.radius = random.uniform(0.01, 0.6);
        s.from_radius = random.uniform(0.01, 0.6);
        for (double tolerance : {0.0, 0.1}) {
            const DVec3 p = s.from + random.uniform(0.0, 2.0) * random.direction();
            // Not where the slow way's steps decide.
            if (slowly_held(s, p, tolerance + 3e-4) != slowly_held(s, p, std::max(0.0, tolerance - 3e-4)))
                continue;
            EXPECT_EQ(solid_holds(s, p, tolerance), slowly_held(s, p, tolerance + 3e-4)) << i;
        }
    }
}

TEST(Fidelity, TheSearchFindsWhatLookingAtAllFinds) {
    for (uint64_t seed = 1; seed < 6; seed++) {
        const Tree tree = test::wild_tree(seed, 150);
        const std::vector<WoodSegment> wood = wood_segments(tree);
        const CapsuleTree search(wood);
        Random random(seed);
        for (int i = 0; i < 300; i++) {
            const DVec3 p = random.uniform(0.0, 4.0) * random.direction();
            BarkHit slow;
            bool held = false;
            for (const WoodSegment& s : wood) {
                const double error = bark_error(s, p);
                if (std::abs(error) < std::abs(slow.error) ||
                    (std::abs(error) == std::abs(slow.error) && s.child < slow.child))
                    slow = {s.child, error, 0};
                held = held || solid_holds(s, p, 0.05);
            }
            BarkHit quick;
            search.find_bark(p, quick);
            EXPECT_EQ(quick.child, slow.child);
            EXPECT_EQ(quick.error, slow.error);
            EXPECT_EQ(search.find_solid(p, 0.05) >= 0, held);
        }
    }
}

TEST(Fidelity, IsOneForATreesOwnSamplesAndFallsWithNoise) {
    for (uint64_t seed = 1; seed < 6; seed++) {
        const Tree tree = test::random_tree(seed, 600, 8.0);
        FidelityOptions options;
        options.tolerance = 1e-4;
        const Fidelity exact = measure_fidelity(tree, bark_points(tree, 20000, 0.0, seed), options);
        EXPECT_EQ(exact.skeleton, 1.0);
        EXPECT_EQ(exact.all.explained, 1.0);
        EXPECT_LT(exact.all.p95, 1e-5);
        for (const FidelityPart& order : exact.by_order)
            EXPECT_EQ(order.explained, order.points > 0 ? 1.0 : 0.0);
        options.tolerance = 0.02;
        double skeleton = 1.0, explained = 1.0, median = 0.0, coverage = 2.0;
        for (double noise : {0.02, 0.04, 0.08, 0.16, 0.32}) {
            const Fidelity noisy = measure_fidelity(tree, bark_points(tree, 20000, noise, seed), options);
            EXPECT_LT(noisy.skeleton, skeleton) << seed << " " << noise;
            EXPECT_LT(noisy.all.explained, explained);
            EXPECT_GT(noisy.all.median, median);
            EXPECT_LT(noisy.all.coverage, coverage);
            skeleton = noisy.skeleton;
            explained = noisy.all.explained;
            median = noisy.all.median;
            coverage = noisy.all.coverage;
        }
    }
}

TEST(Fidelity, AgreesWithTheScanScore) {
    const Tree tree = test::random_tree(3, 400, 6.0);
    const PointCloud cloud = bark_points(tree, 5000, 0.03, 9);
    const ScanScore score = score_scan(tree, cloud);
    const Fidelity fidelity = measure_fidelity(tree, cloud);
    EXPECT_EQ(fidelity.points, score.points);
    EXPECT_NEAR(1000.0 * fidelity.all.median, score.median_mm, 1e-9);
    EXPECT_NEAR(1000.0 * fidelity.all.p95, score.p95_mm, 1e-9);
    EXPECT_NEAR(1000.0 * fidelity.all.mean, score.mean_mm, 1e-4);
    EXPECT_NEAR(fidelity.all.explained, score.explained_2cm, 1e-12);
}

TEST(Fidelity, PartsAddUpToTheWhole) {
    const Tree tree = test::random_tree(7, 500, 8.0);
    const PointCloud cloud = bark_points(tree, 8000, 0.02, 2);
    const Fidelity f = measure_fidelity(tree, cloud);
    const BranchList list = list_branches(tree);
    ASSERT_EQ(f.branches.size(), list.branches.size());
    for (const std::vector<FidelityPart>* parts : {&f.by_order, &f.branches}) {
        size_t points = 0;
        double explained = 0.0, length = 0.0, bark = 0.0, covered = 0.0, mean = 0.0;
        for (const FidelityPart& part : *parts) {
            points += part.points;
            explained += part.explained * static_cast<double>(part.points);
            mean += part.mean * static_cast<double>(part.points);
            length += part.length;
            bark += part.bark;
            covered += part.coverage * part.bark;
            EXPECT_LE(part.median, part.p95);
            EXPECT_LE(part.coverage, 1.0 + 1e-12);
        }
        EXPECT_EQ(points, f.points);
        EXPECT_NEAR(explained / 8000.0, f.all.explained, 1e-12);
        EXPECT_NEAR(mean / 8000.0, f.all.mean, 1e-9);
        EXPECT_NEAR(length, f.all.length, 1e-9);
        EXPECT_NEAR(bark, f.all.bark, 1e-9);
        EXPECT_NEAR(covered / bark, f.all.coverage, 1e-9);
    }
    uint64_t by_node = 0;
    for (uint32_t count : f.node_points)
        by_node += count;
    EXPECT_EQ(by_node, f.points);
    for (size_t i = 0; i < cloud.size(); i += 97) {
        const Node& node = tree.node(f.point_node[i]);
        const double error =
            distance_to_segment(DVec3(cloud.positions[i]), tree.node(node.parent).position, node.position) -
            node.radius;
        EXPECT_NEAR(f.point_error[i], error, 1e-6);
        EXPECT_EQ(f.explains(i), std::abs(f.point_error[i]) <= 0.02);
    }
}

TEST(Fidelity, CoverageIsTheShareOfBarkThatWasSeen) {
    Tree tree;
    NodeId at = tree.add_root(DVec3(0.0), 0.2);
    for (int i = 1; i <= 40; i++)
        at = tree.add_child(at, DVec3(0.0, 0.05 * i, 0.0), 0.2);
    // All around, from one side, and the lower half alone.
    const auto scanned = [&](double around, double height) {
        PointCloud cloud;
        for (double y = 0.005; y < height; y += 0.01)
            for (double angle = 0.0; angle < around; angle += 0.02)
                cloud.positions.emplace_back(0.2 * std::cos(angle), y, 0.2 * std::sin(angle));
        return measure_fidelity(tree, cloud).all;
    };
    const FidelityPart whole = scanned(2.0 * kPi, 2.0);
    EXPECT_EQ(whole.coverage, 1.0);
    EXPECT_NEAR(whole.bark, 2.0 * kPi * 0.2 * 2.0, 1e-9);
    EXPECT_NEAR(scanned(kPi, 2.0).coverage, 0.5, 0.05);
    EXPECT_NEAR(scanned(2.0 * kPi, 1.0).coverage, 0.5, 0.03);
}

TEST(Fidelity, BarkInsideTheParentIsNotAskedFor) {
    Tree tree;
    const NodeId root = tree.add_root(DVec3(0.0), 0.3);
    const NodeId fork = tree.add_child(root, DVec3(0, 1, 0), 0.3);
    tree.add_child(fork, DVec3(0, 2, 0), 0.3);
    tree.add_child(fork, DVec3(1, 1, 0), 0.02);
    const Fidelity f = measure_fidelity(tree, bark_points(tree, 1000, 0.0, 1));
    ASSERT_EQ(f.by_order.size(), 2u);
    EXPECT_NEAR(f.by_order[1].bark, 2.0 * kPi * 0.02 * 0.7, 1e-9);
    EXPECT_NEAR(f.by_order[1].length, 1.0, 1e-9);
}

void expect_same(const Fidelity& a, const Fidelity& b) {
    EXPECT_EQ(a.skeleton, b.skeleton);
    EXPECT_EQ(a.skeleton_strict, b.skeleton_strict);
    EXPECT_EQ(a.point_error, b.point_error);
    EXPECT_EQ(a.point_node, b.point_node);
    EXPECT_EQ(a.node_points, b.node_points);
    EXPECT_EQ(a.node_error, b.node_error);
    ASSERT_EQ(a.branches.size(), b.branches.size());
    ASSERT_EQ(a.by_order.size(), b.by_order.size());
    for (size_t i = 0; i < a.branches.size(); i++) {
        EXPECT_EQ(a.branches[i].median, b.branches[i].median);
        EXPECT_EQ(a.branches[i].coverage, b.branches[i].coverage);
    }
    EXPECT_EQ(a.all.median, b.all.median);
    EXPECT_EQ(a.all.p95, b.all.p95);
    EXPECT_EQ(a.all.mean, b.all.mean);
    EXPECT_EQ(a.all.coverage, b.all.coverage);
}

// One random edit of a kind that editors make.
void edit(Tree& tree, Random& random) {
    const std::vector<NodeId> ids = tree.depth_first();
    const NodeId id = ids[1 + random.below(static_cast<uint32_t>(ids.size() - 1))];
    switch (random.below(6)) {
        case 0:
            tree.set_position(id, tree.node(id).position + 0.3 * random.direction());
            break;
        case 1:
            tree.set_radius(id, tree.node(id).radius * random.uniform(0.5, 2.0));
            break;
        case 2:
            tree.add_child(id, tree.node(id).position + 0.5 * random.direction(), 0.01);
            break;
        case 3:
            if (ids.size() > 30) tree.remove_subtree(id);
            break;
        case 4:
            if (ids.size() > 30) tree.dissolve(id);
            break;
        default:
            tree.insert_before(id, 0.5 * (tree.node(id).position + tree.node(tree.node(id).parent).position),
                               0.02);
    }
}

TEST(FidelityTracker, GivesWhatANewMeasurementGives) {
    for (uint64_t seed = 1; seed < 5; seed++) {
        Tree tree = seed % 2 ? test::random_tree(seed, 400, 6.0) : test::wild_tree(seed, 120);
        const PointCloud cloud = bark_points(tree, 3000, 0.05, seed);
        FidelityTracker tracker(cloud);
        tracker.update(tree);
        Random random(seed);
        for (int step = 0; step < 25; step++) {
            const Tree before = tree;
            for (int i = 0; i < 1 + step % 3; i++)
                edit(tree, random);
            const Fidelity& tracked = tracker.update(tree);
            expect_same(tracked, measure_fidelity(tree, cloud));
            expect_same(*tracker.previous(), measure_fidelity(before, cloud));
            if (HasFailure()) FAIL() << "seed " << seed << ", step " << step;
        }
    }
}

TEST(FidelityTracker, LooksOnlyAtWhatChanged) {
    Tree tree = test::random_tree(2, 2000, 10.0);
    const PointCloud cloud = bark_points(tree, 20000, 0.01, 2);
    FidelityTracker tracker(cloud);
    tracker.update(tree);
    EXPECT_EQ(tracker.points_measured(), cloud.size());
    EXPECT_FALSE(tracker.previous());
    const NodeId tip = tree.nodes_of_kind(NodeKind::kLeaf).front();
    tree.set_position(tip, tree.node(tip).position + DVec3(0.0, 0.02, 0.0));
    tracker.update(tree);
    EXPECT_LT(tracker.points_measured(), cloud.size() / 100);
    tracker.update(tree);
    EXPECT_EQ(tracker.points_measured(), 0u);
}

TEST(FidelityTracker, FollowsTheTreeIntoAnotherFrame) {
    Tree tree = test::random_tree(3, 300, 5.0);
    const PointCloud cloud = bark_points(tree, 2000, 0.01, 3);
    FidelityTracker tracker(cloud);
    const double median = tracker.update(tree).all.median;
    tree.rebase(DVec3(3.0, -1.0, 2.0));
    EXPECT_NEAR(tracker.update(tree).all.median, median, 1e-9);
    tree.scale(2.0);
    expect_same(tracker.update(tree), measure_fidelity(tree, cloud));
    EXPECT_NEAR(tracker.current().all.median, 2.0 * median, 1e-9);
}

struct Stop : Progress {
    bool cancelled() const override { return true; }
};

TEST(FidelityTracker, KeepsItsFiguresWhenItIsStopped) {
    Tree tree = test::random_tree(4, 300, 5.0);
    const PointCloud cloud = bark_points(tree, 2000, 0.01, 3);
    FidelityTracker tracker(cloud);
    const Fidelity before = tracker.update(tree);
    tree.set_radius(tree.node(tree.root()).first_child, 0.5);
    Stop stop;
    EXPECT_THROW(tracker.update(tree, &stop), Cancelled);
    expect_same(tracker.current(), before);
    expect_same(tracker.update(tree), measure_fidelity(tree, cloud));
}

TEST(FidelityTracker, NeitherThreadsNorTheOrderOfThePointsMatter) {
    const Tree tree = test::random_tree(5, 300, 5.0);
    PointCloud cloud = bark_points(tree, 5000, 0.02, 5);
    set_thread_count(1);
    const Fidelity one = measure_fidelity(tree, cloud);
    set_thread_count(3);
    const Fidelity three = measure_fidelity(tree, cloud);
    std::reverse(cloud.positions.begin(), cloud.positions.end());
    Fidelity reversed = measure_fidelity(tree, cloud);
    set_thread_count(0);
    expect_same(one, three);
    std::reverse(reversed.point_error.begin(), reversed.point_error.end());
    std::reverse(reversed.point_node.begin(), reversed.point_node.end());
    expect_same(one, reversed);
}

TEST(Fidelity, LighterTreesAreLessFaithful) {
    const Tree tree = test::random_tree(6, 3000, 10.0);
    const std::vector<LevelFidelity> levels = measure_levels(tree, bark_points(tree, 20000, 0.0, 1), 4);
    ASSERT_EQ(levels.size(), 4u);
    EXPECT_EQ(levels[0].nodes, tree.size());
    EXPECT_EQ(levels[0].all.explained, 1.0);
    for (size_t i = 1; i < levels.size(); i++) {
        EXPECT_LE(levels[i].nodes, levels[i - 1].nodes / 2 + 1);
        EXPECT_LT(levels[i].all.explained, levels[i - 1].all.explained);
        EXPECT_GT(levels[i].all.p95, levels[i - 1].all.p95);
    }
}

TEST(Fidelity, BadInputIsASentence) {
    const Tree tree = test::random_tree(1, 50, 3.0);
    EXPECT_THROW(measure_fidelity(tree, PointCloud()), Error);
    const PointCloud cloud = bark_points(tree, 10, 0.0, 1);
    Tree lone;
    lone.add_root(DVec3(0.0), 0.1);
    EXPECT_THROW(measure_fidelity(lone, cloud), Error);
    for (FidelityOptions options : {FidelityOptions{-1.0, 0.05}, FidelityOptions{NAN, 0.05},
                                    FidelityOptions{0.02, 0.0}, FidelityOptions{0.02, NAN}})
        EXPECT_THROW(measure_fidelity(tree, cloud, options), Error);
}

}  // namespace
}  // namespace treerec
