#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "geometry/portable_math.h"
#include "mesh/branch_tubes.h"
#include "mesh/polygon.h"

namespace treerec {
namespace {

TEST(Polygons, HaveTheirCornersOnACircle) {
    for (uint32_t sides = 3; sides <= kMostSides; sides++) {
        const DVec2* const corners = polygon(sides);
        EXPECT_EQ(corners[0], DVec2(1.0, 0.0));
        EXPECT_EQ(corners[sides], corners[0]) << sides;
        for (uint32_t j = 0; j < sides; j++) {
            const double angle = 2.0 * kPi * j / sides;
            EXPECT_EQ(corners[j], DVec2(portable::cos(angle), portable::sin(angle))) << j << " of " << sides;
            const DVec2 middle = 0.5 * (corners[j] + corners[j + 1]);
            EXPECT_NEAR(polygon_flat(sides), glm::length(middle), 1e-12) << sides;
        }
    }
}

// A branch that leaves a stem along the stem's way, and so starts thin within it, keeps the smooth bends of
// its own thickness.
TEST(BranchTubes, ABranchThatStartsThinBendsAsSmoothlyAsItIsThick) {
    Tree tree;
    NodeId at = tree.add_root({0, 0, 0}, 0.03, kTrunkFlag);
    NodeId fork = kNoNode;
    for (int i = 1; i <= 8; i++) {
        at = tree.add_child(at, {0, 0.25 * i, 0}, 0.03, kTrunkFlag);
        if (i == 4) fork = at;
    }
    // Half a circle of 10 cm, tangent to the stem.
    NodeId branch = fork;
    for (int i = 1; i <= 40; i++) {
        const double angle = kPi * i / 40.0;
        branch = tree.add_child(branch, DVec3(0.1 - 0.1 * std::cos(angle), 1.0 + 0.1 * std::sin(angle), 0.0),
                                0.024);
    }
    const Mesh mesh = build_branch_tubes(tree);
    std::vector<DVec3> centres;
    for (size_t v = 0; v < mesh.positions.size();) {
        size_t end = v;
        DVec3 sum(0.0);
        while (end < mesh.positions.size() && mesh.uvs[end].y == mesh.uvs[v].y &&
               mesh.custom0[end] == mesh.custom0[v])
            sum += DVec3(mesh.positions[end++]);
        // The last vertex of a ring repeats the first. A collar's rows slant: no two of their vertices are as
        // far along.
        if (end - v > 3 && mesh.custom0[v].w == 1.0f && mesh.colors[v].g < 1.0f)
            centres.push_back((sum - DVec3(mesh.positions[end - 1])) / static_cast<double>(end - v - 1));
        v = end;
    }
    ASSERT_GT(centres.size(), 5u);
    for (size_t i = 1; i + 1 < centres.size(); i++) {
        const DVec3 before = glm::normalize(centres[i] - centres[i - 1]);
        const DVec3 after = glm::normalize(centres[i + 1] - centres[i]);
        EXPECT_LT(std::acos(std::clamp(glm::dot(before, after), -1.0, 1.0)), 0.45) << i;
    }
}

// A trunk with a twig whose nodes lie on an arc of `bend` radians.
Mesh twig_mesh(double bend, double tip) {
    Tree tree;
    const NodeId fork =
        tree.add_child(tree.add_root({0, 0, 0}, 0.05, kTrunkFlag), {0, 2, 0}, 0.05, kTrunkFlag);
    tree.add_child(fork, {0, 4, 0}, 0.02, kTrunkFlag);
    NodeId at = fork;
    DVec3 place = tree.node(fork).position;
    for (int i = 1; i <= 10; i++) {
        place += 0.03 * DVec3(std::cos(bend * i / 10.0), std::sin(bend * i / 10.0), 0.0);
        at = tree.add_child(at, place, 0.003 + (tip - 0.003) * i / 10.0);
    }
    return build_branch_tubes(tree);
}

TEST(BranchTubes, AStraightTwigIsOneCone) {
    const Mesh mesh = twig_mesh(0.0, 0.001);
    size_t triangles = 0;
    for (size_t t = 0; t < mesh.indices.size(); t += 3)
        triangles += mesh.custom0[mesh.indices[t]].w > 0.0F ? 1 : 0;
    EXPECT_EQ(triangles, 3U);
}

TEST(BranchTubes, ABentTwigHasNoElbow) {
    const Mesh mesh = twig_mesh(2.0, 0.003);
    // The middles of its rings: vertices at one height of the bark's picture, but for the last, which is the
    // first anew.
    std::vector<DVec3> middles;
    for (size_t v = 0; v + 3 < mesh.positions.size(); v++) {
        if (mesh.custom0[v].w <= 0.0F || mesh.uvs[v].y != mesh.uvs[v + 3].y) continue;
        middles.push_back(DVec3(mesh.positions[v] + mesh.positions[v + 1] + mesh.positions[v + 2]) / 3.0);
        v += 3;
    }
    ASSERT_GE(middles.size(), 4U);
    for (size_t i = 1; i + 1 < middles.size(); i++) {
        const DVec3 in = glm::normalize(middles[i] - middles[i - 1]);
        const DVec3 out = glm::normalize(middles[i + 1] - middles[i]);
        EXPECT_GT(glm::dot(in, out), std::cos(glm::radians(27.0))) << i;
    }
}

// A swept trunk shows no corners: what bends by a quarter turn within a metre has rings enough for it.
TEST(BranchTubes, AStoutTrunkBendsWithoutCorners) {
    for (const double radius : {0.09, 0.15, 0.3}) {
        Tree tree;
        NodeId at = tree.add_root({0, 0, 0}, radius, kTrunkFlag);
        for (int i = 1; i <= 30; i++) {
            const double angle = 0.5 * kPi * i / 30.0, reach = 4.0 * radius;
            at = tree.add_child(at, DVec3(reach - reach * std::cos(angle), reach * std::sin(angle), 0.0),
                                radius * (1.0 - 0.01 * i), kTrunkFlag);
        }
        const Mesh mesh = build_branch_tubes(tree);
        std::vector<DVec3> centres;
        for (size_t v = 0; v < mesh.positions.size();) {
            size_t end = v;
            DVec3 sum(0.0);
            while (end < mesh.positions.size() && mesh.uvs[end].y == mesh.uvs[v].y)
                sum += DVec3(mesh.positions[end++]);
            // The base below the ground and the cut at the end are no part of the bend.
            const DVec3 centre = (sum - DVec3(mesh.positions[end - 1])) / std::max<double>(1.0, end - v - 1);
            if (end - v > 3 && mesh.positions[v].y > 0.5 * radius) centres.push_back(centre);
            v = end;
        }
        ASSERT_GT(centres.size(), 6u);
        for (size_t i = 1; i + 2 < centres.size(); i++) {
            const DVec3 before = glm::normalize(centres[i] - centres[i - 1]);
            const DVec3 after = glm::normalize(centres[i + 1] - centres[i]);
            EXPECT_LT(std::acos(std::clamp(glm::dot(before, after), -1.0, 1.0)), 0.2) << radius << " " << i;
        }
    }
}

// Where a trunk widens into its roots, its bark runs on down, and does not wind about it.
TEST(BranchTubes, TheBarkOfABaseDoesNotSlant) {
    for (const double base : {0.17, 0.2, 0.25}) {
        Tree tree;
        NodeId at = tree.add_root({0, 0, 0}, base, kTrunkFlag);
        for (int i = 1; i <= 40; i++) {
            const double y = 0.1 * i, left = std::max(0.0, 1.0 - y / 0.4);
            at = tree.add_child(at, {0, y, 0}, 0.16 - 0.01 * y + (base - 0.16) * left, kTrunkFlag);
        }
        const TubeOptions options;
        const Mesh mesh = build_branch_tubes(tree, options);
        std::vector<Vec2> ends;  // of each round: metres around, metres along
        for (size_t i = 0; i < mesh.uvs.size(); i++) {
            const Vec2 end(mesh.uvs[i].x * static_cast<float>(options.bark_width), mesh.uvs[i].y);
            if (end.y > 2.0f || end.y < 0.0f) continue;
            if (ends.empty() || std::abs(ends.back().y - end.y) > 1e-4f)
                ends.push_back(end);
            else
                ends.back() = end;
        }
        ASSERT_GT(ends.size(), 2u);
        for (size_t i = 1; i < ends.size(); i++) {
            ASSERT_GT(ends[i].y, ends[i - 1].y);
            EXPECT_LT(std::abs(ends[i].x - ends[i - 1].x) / (ends[i].y - ends[i - 1].y), 0.32f) << ends[i].y;
            // And is not stretched out of shape either.
            const double around = 2.0 * kPi * (0.16 - 0.01 * ends[i].y);
            EXPECT_NEAR(ends[i].x, around, 0.3 * around) << ends[i].y;
        }
    }
}

// Nor does that of a branch wind about it where it comes out of its parent: the picture is neither sheared
// nor stretched beyond what an eye takes for bark.
TEST(BranchTubes, TheBarkOfACollarDoesNotWind) {
    for (const double thick : {0.025, 0.035, 0.05}) {
        Tree tree;
        NodeId at = tree.add_root({0, 0, 0}, 0.1, kTrunkFlag), fork = kNoNode;
        for (int i = 1; i <= 30; i++) {
            at = tree.add_child(at, {0, 0.1 * i, 0}, 0.1 - 0.001 * i, kTrunkFlag);
            if (i == 20) fork = at;
        }
        for (int i = 1; i <= 8; i++)
            fork = tree.add_child(fork, DVec3(0.12 * i, 2.0 + 0.08 * i, 0.02 * i), thick * (1.0 - 0.05 * i));
        const TubeOptions options;
        const Mesh mesh = build_branch_tubes(tree, options);
        size_t looked_at = 0;
        for (size_t i = 0; i < mesh.indices.size(); i += 3) {
            const uint32_t a = mesh.indices[i], b = mesh.indices[i + 1], c = mesh.indices[i + 2];
            // The parent's picture begins 2 m along.
            const auto own = [&](uint32_t v) {
                return mesh.custom0[v].w == 1.0f && mesh.uvs[v].y < 0.5f && mesh.colors[v].g < 1.0f;
            };
            if (!own(a) || !own(b) || !own(c)) continue;
            const DVec3 along(mesh.positions[b] - mesh.positions[a]);
            const DVec3 across(mesh.positions[c] - mesh.positions[a]);
            const double length = glm::length(along), x = glm::dot(across, along) / length;
            const double y = glm::length(across - along * (x / length));
            if (length < 1e-3 || y < 1e-3) continue;
            const DVec2 scale(options.bark_width, 1.0);
            const DVec2 p = DVec2(mesh.uvs[b] - mesh.uvs[a]) * scale / length;
            const DVec2 q = (DVec2(mesh.uvs[c] - mesh.uvs[a]) * scale - p * x) / y;
            // Metres of picture per metre of bark, in the ways where they are most and fewest.
            const double squares = glm::dot(p, p) + glm::dot(q, q), area = std::abs(p.x * q.y - p.y * q.x);
            ASSERT_GT(area, 0.0);
            const double most = std::sqrt(0.5 * (squares + std::sqrt(squares * squares - 4.0 * area * area)));
            EXPECT_LT(most * most / area, 2.5) << mesh.uvs[a].y << " m along, of " << thick;
            looked_at++;
        }
        EXPECT_GT(looked_at, 50u);
    }
}

// How far the drawn bark of an upright stem is from its nodes' radii, at most, over these, from the first
// ring above the ground on: below it the stem is drawn down into the ground.
double left_out(const std::vector<double>& radii, double apart, double from) {
    Tree tree;
    NodeId at = tree.add_root({0, 0, 0}, radii[0], kTrunkFlag);
    for (size_t i = 1; i < radii.size(); i++)
        at = tree.add_child(at, {0.0, apart * static_cast<double>(i), 0.0}, radii[i], kTrunkFlag);
    const Mesh mesh = build_branch_tubes(tree);
    std::vector<DVec2> rings;  // height and radius
    for (size_t v = 0; v < mesh.positions.size(); v++) {
        const DVec3 p(mesh.positions[v]);
        if (rings.empty() || p.y > rings.back().x + 1e-6) rings.emplace_back(p.y, std::hypot(p.x, p.z));
    }
    double most = 0.0;
    size_t next = 1, seen = 0;
    for (size_t i = 1; i + 2 < radii.size(); i++) {
        const double y = apart * static_cast<double>(i);
        if (y < std::max(from, rings[1].x)) continue;
        while (next + 1 < rings.size() && rings[next].x < y)
            next++;
        const DVec2 &low = rings[next - 1], &high = rings[next];
        const double drawn = glm::mix(low.y, high.y, (y - low.x) / (high.x - low.x));
        most = std::max(most, std::abs(drawn / radii[i] - 1.0));
        seen++;
    }
    EXPECT_GT(seen, radii.size() / 2);
    return most;
}

// A base gets thinner fast at first and then ever more slowly, and a trunk at once above a fork; from ring to
// ring it is a cone.
TEST(BranchTubes, AStoutTrunkIsAsThickAsItWasMeasured) {
    for (const double radius : {0.06, 0.15, 0.4}) {
        for (const double reach : {0.2, 0.4, 0.8}) {
            std::vector<double> flare;
            for (int i = 0; i <= 80; i++)
                flare.push_back(radius * (1.0 - 0.002 * i + 0.9 * std::exp(-0.05 * i / reach)));
            EXPECT_LT(left_out(flare, 0.05, 0.0), 0.07) << radius << ", a base of " << reach << " m";
        }
        for (const double above : {0.85, 0.75, 0.65}) {
            std::vector<double> forked;
            for (int i = 0; i <= 80; i++)
                forked.push_back(radius * (1.0 - 0.002 * i) * (i > 40 ? above : 1.0));
            // It has no base, and is given one.
            EXPECT_LT(left_out(forked, 0.5 * radius, 2.0 * radius), 0.07)
                << radius << ", above a fork " << above;
        }
    }
}

}  // namespace
}  // namespace treerec
