#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <fstream>
#include <iterator>
#include <string>

#include "foliage/crown.h"
#include "foliage/leaves.h"
#include "foliage/wind.h"
#include "mesh/branch_tubes.h"
#include "mesh/leaf_cards.h"
#include "synth/grow.h"
#include "tree/branches.h"

namespace treerec {
namespace {

// A constant of the shaders, which stand beside the tests in the project.
double shader_constant(const std::string& name) {
    std::ifstream file("addons/tree_reconstruction/shaders/tree_wind.gdshaderinc");
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    const size_t at = text.find(name + " = ");
    return at == std::string::npos ? std::nan("") : std::stod(text.substr(at + name.size() + 3));
}

struct Group {
    int phase;
    double out;
};

// As tree_wind_group() of the shaders.
Group decoded(float code) {
    const auto bits = std::bit_cast<uint32_t>(code);
    return {static_cast<int>(bits >> 23) - 113, std::bit_cast<float>((bits & 0x7fffffu) | 0x3f800000u) - 1.0};
}

// How far apart, in metres, two points that share a place may be driven at full strength: as far as each
// moves in its own group where those have different phases, and by the difference where they agree. The other
// motions are functions of the place alone. reach: of a group's motion, metres at the code's 1 (a length of
// about 1.5 lies in the sum of waves of tree_wind_swing()).
double parted(const Vec2& a, const Vec2& b, const double (&reach)[2]) {
    double sum = 0.0;
    for (int group = 0; group < 2; group++) {
        const Group one = decoded(a[group]), other = decoded(b[group]);
        const double here = one.out * one.out, there = other.out * other.out;
        sum += reach[group] * (one.phase == other.phase ? std::abs(here - there) : here + there);
    }
    return sum;
}

struct Swing {
    double primary = 1.7 * shader_constant("TREE_PRIMARY_SWING");
    double secondary = 1.8 * shader_constant("TREE_SECONDARY_SWING");
};

TEST(Wind, WhatTouchesStaysTogetherAtFullWind) {
    const Swing swing;
    ASSERT_GT(swing.primary, 0.0);
    ASSERT_GT(swing.secondary, 0.0);
    for (const Habit habit : all_habits()) {
        GrowOptions options;
        options.habit = habit;
        const Tree tree = grow_tree(options);
        const BranchList list = list_branches(tree);
        const Crown crown = measure_crown(tree);
        const WindGroups wind(tree, list, crown.height);
        const double reach[2] = {swing.primary * crown.height, swing.secondary * crown.height};
        double worst = 0.0, most = 0.0;
        std::vector<double> way(static_cast<size_t>(tree.id_end()), 0.0);
        for (size_t i = 0; i < list.branches.size(); i++) {
            const Branch& branch = list.branches[i];
            NodeId last =
                branch.attach != kNoNode ? branch.attach : list.nodes[static_cast<size_t>(branch.begin)];
            double along = 0.0;
            for (const NodeId id : list.nodes_of(branch)) {
                along += glm::distance(tree.node(id).position, tree.node(last).position);
                way[static_cast<size_t>(id)] = along;
                last = id;
            }
            const Vec2 tip = wind.codes(i, along);
            most = std::max(most, parted(tip, wind.codes(0, 0.0), reach));
            if (branch.attach == kNoNode) continue;
            // All around where the branch comes out of its parent's bark, and within it.
            const Node& attach = tree.node(branch.attach);
            const Node& first = tree.node(list.nodes[static_cast<size_t>(branch.begin)]);
            const DVec3 own = first.position - attach.position;
            const double length = glm::length(own);
            DVec3 before =
                attach.parent != kNoNode ? attach.position - tree.node(attach.parent).position : own;
            before = normalized_or(before, DVec3(0.0, 1.0, 0.0));
            const DVec3 direction = own / length, across = any_perpendicular(direction);
            const DVec3 other = glm::cross(direction, across);
            const double sine = std::max(glm::length(glm::cross(direction, before)), 0.3);
            for (double deep : {0.0, 0.5, 1.0}) {
                const double at = std::min({deep * attach.radius / sine, length, 0.7 * branch.length});
                for (int side = 0; side < 8; side++) {
                    const double angle = kPi / 4.0 * side;
                    const DVec3 off = (across * std::cos(angle) + other * std::sin(angle)) *
                                      std::min(first.radius, attach.radius);
                    const DVec3 place = direction * at + off;
                    // The parent's bark beside it.
                    const double beside = way[static_cast<size_t>(branch.attach)] + glm::dot(place, before);
                    const Vec2 there = wind.codes(static_cast<size_t>(branch.parent), std::max(beside, 0.0));
                    worst = std::max(worst, parted(wind.codes(i, at, off), there, reach));
                }
            }
        }
        EXPECT_LT(worst, 1e-3) << habit_name(habit);
        // It must not be so because nothing moves.
        EXPECT_TRUE(habit == Habit::kPalm || most > 0.05) << habit_name(habit);
    }
}

// The nearest point of a triangle, as shares of its corners (Ericson, Real-Time Collision Detection, 5.1.5).
Vec3 nearest_on(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
    const float d1 = glm::dot(ab, ap), d2 = glm::dot(ac, ap), d3 = glm::dot(ab, bp), d4 = glm::dot(ac, bp);
    const float d5 = glm::dot(ab, cp), d6 = glm::dot(ac, cp);
    if (d1 <= 0.0f && d2 <= 0.0f) return {1.0f, 0.0f, 0.0f};
    if (d3 >= 0.0f && d4 <= d3) return {0.0f, 1.0f, 0.0f};
    if (d6 >= 0.0f && d5 <= d6) return {0.0f, 0.0f, 1.0f};
    const float vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
    if (vc <= 0.0f && d1 >= 0.0f && d3 <= 0.0f) return {1.0f - d1 / (d1 - d3), d1 / (d1 - d3), 0.0f};
    if (vb <= 0.0f && d2 >= 0.0f && d6 <= 0.0f) return {1.0f - d2 / (d2 - d6), 0.0f, d2 / (d2 - d6)};
    const float w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    if (va <= 0.0f && d4 - d3 >= 0.0f && d5 - d6 >= 0.0f) return {0.0f, 1.0f - w, w};
    return Vec3(va, vb, vc) / (va + vb + vc);
}

// As the graphics card does it: motions of corners, blended over a triangle.
TEST(Wind, LeavesStayOnTheirTwigs) {
    const Swing swing;
    for (const Habit habit : {Habit::kBroadleaf, Habit::kConifer, Habit::kForked}) {
        GrowOptions options;
        options.habit = habit;
        const Tree tree = grow_tree(options);
        const double height = measure_crown(tree).height;
        const double reach[2] = {swing.primary * height, swing.secondary * height};
        const Mesh bark = build_branch_tubes(tree);
        const std::vector<LeafPlacement> leaves = place_leaves(tree, LeafRules(), 1);
        ASSERT_GT(leaves.size(), 1000u);
        double worst = 0.0;
        std::vector<double> gaps;
        size_t foreigners = 0;
        for (size_t i = 0; i < leaves.size(); i += leaves.size() / 300) {
            const LeafPlacement& leaf = leaves[i];
            double nearest = 1e30, gap = 0.0;
            bool foreign = false;
            for (size_t t = 0; t < bark.indices.size(); t += 3) {
                const uint32_t* corner = &bark.indices[t];
                const Vec3 &a = bark.positions[corner[0]], &b = bark.positions[corner[1]],
                           &c = bark.positions[corner[2]];
                if (glm::distance(a, leaf.position) > nearest + glm::distance(a, b) + glm::distance(a, c))
                    continue;
                const Vec3 share = nearest_on(leaf.position, a, b, c);
                const double distance = glm::distance(a * share.x + b * share.y + c * share.z, leaf.position);
                if (distance >= nearest) continue;
                nearest = distance;
                gap = 0.0;
                bool other = false;  // bark of a branch that it does not stand on
                for (int group = 0; group < 2; group++) {
                    const Group own = decoded(leaf.wind[group]);
                    double there = 0.0;
                    for (int k = 0; k < 3; k++) {
                        const Group at = decoded(bark.wind[corner[k]][group]);
                        there += share[k] * at.out * at.out;
                        if (at.out > 0.0 && (own.out > 0.0 ? at.phase != own.phase : at.out > 0.05))
                            other = true;
                    }
                    if (own.out > 0.05 && there == 0.0) other = true;
                    gap += reach[group] * std::abs(own.out * own.out - there);
                }
                if (other) gap = 0.0;
                foreign = other;
            }
            EXPECT_LT(nearest, 0.02);
            foreigners += foreign;
            if (foreign) continue;
            gaps.push_back(gap);
            worst = std::max(worst, gap);
        }
        std::sort(gaps.begin(), gaps.end());
        // Bark is straight between its rings, of which a leaf knows nothing; it moves on the curve.
        EXPECT_LT(gaps[gaps.size() / 2], 0.012) << habit_name(habit);
        EXPECT_LT(worst, 0.06) << habit_name(habit);
        // Few stand nearer to another branch than to their own.
        EXPECT_LT(foreigners * 10, gaps.size()) << habit_name(habit);
    }
}

TEST(Wind, CodesSurviveHalfPrecision) {
    for (int phase = 0; phase < kWindPhases; phase++)
        for (double out : {0.0, 0.25, 0.5, 0.999, 1.0, 7.0}) {
            const float code = wind_code(phase, out);
            EXPECT_GE(code, 0x1p-14f);  // a half's smallest that is no denormal
            EXPECT_LE(code, 65504.0f);  // and its largest
            const Group group = decoded(code);
            EXPECT_EQ(group.phase, phase);
            EXPECT_NEAR(group.out, std::min(out, 1.0), 1e-3);
            EXPECT_EQ(std::ldexp(1.0 + (half_code(code) & 0x3ff) / 1024.0, (half_code(code) >> 10) - 15),
                      std::bit_cast<float>(std::bit_cast<uint32_t>(code) & ~0x1fffu));
            // Rounded as a half is, it keeps its phase.
            const auto bits = std::bit_cast<uint32_t>(code);
            const Group rounded = decoded(std::bit_cast<float>((bits + 0x1000u) & ~0x1fffu));
            EXPECT_EQ(rounded.phase, phase);
            EXPECT_NEAR(rounded.out, group.out, 0.0005);
        }
}

}  // namespace
}  // namespace treerec
