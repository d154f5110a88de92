// Where branches leave their parents, and what bends tighter than wood can.
#include "skeleton/branches/forks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "geometry/segment.h"
#include "skeleton/branches/bends.h"
#include "skeleton/skeleton.h"
#include "skeleton/twigs/hugging_shoots.h"
#include "skeleton_test_clouds.h"
#include "tree/branches.h"

namespace treerec {
namespace {

struct Branches {
    std::vector<SkeletonBranch> branches;
    std::vector<std::vector<Station>> axes;

    void add(int32_t parent, int32_t attach, const std::vector<DVec3>& places, double radius) {
        SkeletonBranch branch;
        branch.parent = parent;
        branch.attach = attach;
        branches.push_back(branch);
        std::vector<Station>& line = axes.emplace_back();
        for (const DVec3& place : places)
            line.push_back({place, radius});
    }
};

std::vector<DVec3> straight(const DVec3& from, const DVec3& to, int steps) {
    std::vector<DVec3> line;
    for (int i = 0; i <= steps; i++)
        line.push_back(from + static_cast<double>(i) / steps * (to - from));
    return line;
}

double angle_between(const DVec3& a, const DVec3& b) {
    return std::acos(std::clamp(glm::dot(glm::normalize(a), glm::normalize(b)), -1.0, 1.0)) * 180.0 / kPi;
}

double sharpest_turn(const std::vector<Station>& line, const DVec3& base) {
    double most = 0.0;
    DVec3 before = base;
    for (size_t i = 0; i + 1 < line.size(); i++) {
        const DVec3 in = line[i].position - before;
        if (glm::length(in) > 0.0)
            most = std::max(most, angle_between(in, line[i + 1].position - line[i].position));
        before = line[i].position;
    }
    return most;
}

// Points on the cone that lie within none of the others.
struct Cone {
    DVec3 a, b;
    double from, to;
};

PointCloud bark_of(const std::vector<Cone>& cones, double spacing, double noise, uint64_t seed) {
    Random random(seed);
    PointCloud cloud;
    for (size_t c = 0; c < cones.size(); c++) {
        PointCloud own;
        test::add_cone(own, random, cones[c].a, cones[c].b, cones[c].from, cones[c].to, spacing, noise);
        for (const Vec3& p : own.positions) {
            bool hidden = false;
            for (size_t o = 0; o < cones.size(); o++) {
                if (o == c) continue;
                double t;
                const double off = std::sqrt(square_to_segment(DVec3(p), cones[o].a, cones[o].b, t));
                hidden = hidden || off < cones[o].from + t * (cones[o].to - cones[o].from) - 3.0 * noise;
            }
            if (!hidden) cloud.positions.push_back(p);
        }
    }
    return cloud;
}

// The arms of a V part slowly, and are one piece of bark for many radii.
TEST(Forks, AVLeavesAsItGoesOn) {
    for (const double degrees : {12.0, 18.0, 25.0})
        for (uint64_t seed = 1; seed <= 3; seed++) {
            SCOPED_TRACE(std::to_string(degrees) + " " + std::to_string(seed));
            const double angle = degrees * kPi / 180.0;
            const DVec3 fork(0.0, 1.5, 0.0);
            const DVec3 way(std::sin(angle), std::cos(angle), 0.0);
            const PointCloud cloud = bark_of({{DVec3(0.0), fork, 0.1, 0.09},
                                              {fork, fork + 2.0 * DVec3(-way.x, way.y, 0.0), 0.075, 0.03},
                                              {fork, fork + 1.8 * way, 0.065, 0.025}},
                                             0.012, 0.003, seed);
            const SkeletonResult result = skeletonize(cloud, {});
            const Tree& tree = result.tree;
            const BranchList list = list_branches(tree);
            ASSERT_EQ(list.branches.size(), 2u);
            const Branch& side = list.branches[1];
            const DVec3 from = tree.node(side.attach).position;
            const std::span<const NodeId> nodes = list.nodes_of(side);
            // It leaves no wider than it is, and nothing of it is off the arm that it is.
            EXPECT_LT(angle_between(tree.node(nodes[0]).position - from, DVec3(0, 1, 0)), degrees + 10.0);
            for (const NodeId id : nodes) {
                const DVec3 p = result.tree.frame().origin + tree.node(id).position;
                EXPECT_LT(std::min(distance_to_segment(p, fork, fork + 2.0 * way),
                                   distance_to_segment(p, fork, fork + 2.1 * DVec3(-way.x, way.y, 0.0))),
                          0.03);
            }
        }
}

// The branch does leave at a right angle, and rises later.
TEST(Forks, AnElbowStays) {
    for (uint64_t seed = 1; seed <= 3; seed++) {
        const DVec3 fork(0.0, 1.5, 0.0), elbow(0.6, 1.55, 0.0), tip(0.8, 2.8, 0.0);
        const PointCloud cloud = bark_of(
            {{DVec3(0.0), {0.0, 3.5, 0.0}, 0.1, 0.05}, {fork, elbow, 0.045, 0.04}, {elbow, tip, 0.04, 0.02}},
            0.01, 0.002, seed);
        const SkeletonResult result = skeletonize(cloud, {});
        const Tree& tree = result.tree;
        for (const DVec3& p : straight(fork + 0.3 * (elbow - fork), elbow, 6)) {
            double least = 1e9;
            for (const NodeId id : tree.depth_first())
                if (id != tree.root())
                    least =
                        std::min(least, distance_to_segment(p - tree.frame().origin, tree.node(id).position,
                                                            tree.node(tree.node(id).parent).position));
            EXPECT_LT(least, 0.03) << seed;
        }
    }
}

TEST(Bends, AClawIsEvenedOutAndAnArcIsNot) {
    Branches grown;
    grown.add(-1, 0, straight(DVec3(0.0), {0.0, 1.0, 0.0}, 10), 0.05);
    std::vector<DVec3> claw;
    for (int i = 1; i <= 12; i++)
        claw.emplace_back(0.05 + 0.02 * i, 0.5 + (i % 2 ? 0.03 : 0.0), 0.0);
    grown.add(0, 5, claw, 0.003);
    std::vector<DVec3> arc;
    for (int i = 1; i <= 20; i++)
        arc.emplace_back(-0.5 * std::sin(0.07 * i), 0.5 + 0.5 * (1.0 - std::cos(0.07 * i)), 0.0);
    grown.add(0, 5, arc, 0.02);
    const std::vector<Station> before = grown.axes[2];
    ASSERT_GT(sharpest_turn(grown.axes[1], {0.0, 0.5, 0.0}), 100.0);
    smooth_bends(grown.branches, grown.axes);
    EXPECT_LE(sharpest_turn(grown.axes[1], {0.0, 0.5, 0.0}), 60.0);
    EXPECT_EQ(glm::distance(grown.axes[1].back().position, claw.back()), 0.0);
    for (size_t i = 0; i < claw.size(); i++)
        EXPECT_LT(glm::distance(grown.axes[1][i].position, claw[i]), 0.03);
    for (size_t i = 0; i < arc.size(); i++)
        EXPECT_EQ(glm::distance(grown.axes[2][i].position, before[i].position), 0.0);
}

TEST(Bends, StoutWoodBendsNoTighterThanItIsThick) {
    Branches grown;
    std::vector<DVec3> line = straight(DVec3(0.0), {0.0, 1.0, 0.0}, 20);
    for (int i = 11; i <= 20; i++)
        line[static_cast<size_t>(i)].x += 0.05;
    grown.add(-1, 0, line, 0.06);
    smooth_bends(grown.branches, grown.axes);
    const std::vector<Station>& own = grown.axes[0];
    for (size_t i = 1; i + 1 < own.size(); i++) {
        const DVec3 in = own[i].position - own[i - 1].position, out = own[i + 1].position - own[i].position;
        EXPECT_LE(angle_between(in, out) * kPi / 180.0 * 0.06, 0.5 * (glm::length(in) + glm::length(out)));
    }
}

TEST(HuggingShoots, ThoseInTheCrotchAndAlongTheBarkGo) {
    Branches grown;
    const DVec3 fork(0.0, 1.0, 0.0);
    grown.add(-1, 0, straight(DVec3(0.0), {-0.2, 2.0, 0.0}, 40), 0.06);
    grown.branches[0] = {};
    for (size_t i = 0; i < grown.axes[0].size(); i++) {
        const double y = 0.05 * static_cast<double>(i);
        grown.axes[0][i].position = {y > 1.0 ? -0.3 * (y - 1.0) : 0.0, y, 0.0};
    }
    grown.add(0, 20, straight({0.015, 1.05, 0.0}, {0.3, 2.0, 0.0}, 19), 0.05);
    // In the crotch; along the bark; away from it; along the bark, but it bears what goes away; and a spur.
    grown.add(0, 21, {{0.0, 1.12, 0.0}, {0.0, 1.2, 0.0}}, 0.003);
    grown.add(0, 10, {{0.07, 0.5, 0.0}, {0.09, 0.55, 0.0}, {0.1, 0.6, 0.0}}, 0.003);
    grown.add(0, 10, {{-0.07, 0.5, 0.0}, {-0.2, 0.55, 0.0}}, 0.003);
    grown.add(0, 12, {{0.0, 0.6, 0.07}, {0.0, 0.65, 0.09}, {0.0, 0.7, 0.1}}, 0.003);
    grown.add(5, 1, {{0.0, 0.7, 0.2}, {0.0, 0.75, 0.3}}, 0.002);
    grown.add(0, 8, {{-0.07, 0.4, 0.0}, {-0.15, 0.4, 0.0}}, 0.003);
    drop_hugging_shoots(grown.branches, grown.axes);
    ASSERT_EQ(grown.branches.size(), 5u);
    EXPECT_EQ(grown.axes[2].back().position, DVec3(-0.2, 0.55, 0.0));
    EXPECT_EQ(grown.axes[3].back().position, DVec3(0.0, 0.7, 0.1));
    EXPECT_EQ(grown.axes[4].back().position, DVec3(0.0, 0.75, 0.3));
    EXPECT_EQ(grown.branches[4].parent, 3);
}

TEST(HuggingShoots, SproutsOfAStoutTrunkStayHoweverNearToItsAxis) {
    Branches grown;
    grown.add(-1, 0, straight(DVec3(0.0), {0.0, 4.0, 0.0}, 40), 0.3);
    grown.branches[0] = {};
    // Out of the bark by .05, by .2 and by .5 m: 1.2 to 2.7 radii from the axis.
    for (const double out : {0.05, 0.2, 0.5}) {
        const int32_t at = static_cast<int32_t>(10.0 * (1.0 + 2.0 * out));
        const double y = 0.1 * at;
        grown.add(0, at, straight({0.3, y, 0.0}, {0.3 + out, y + 0.5 * out, 0.0}, 4), 0.004);
    }
    drop_hugging_shoots(grown.branches, grown.axes);
    ASSERT_EQ(grown.branches.size(), 3u);
    EXPECT_EQ(grown.axes[1].back().position.x, 0.5);
    EXPECT_EQ(grown.axes[2].back().position.x, 0.8);
}

}  // namespace
}  // namespace treerec
