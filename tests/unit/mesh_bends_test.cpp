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

// A limb that leaves a stem along the stem's way, and so starts thin within it, keeps the smooth bends of its
// own thickness.
TEST(BranchTubes, ALimbThatStartsThinBendsAsSmoothlyAsItIsThick) {
    Tree tree;
    NodeId at = tree.add_root({0, 0, 0}, 0.03, kTrunkFlag);
    NodeId fork = kNoNode;
    for (int i = 1; i <= 8; i++) {
        at = tree.add_child(at, {0, 0.25 * i, 0}, 0.03, kTrunkFlag);
        if (i == 4) fork = at;
    }
    // Half a circle of 10 cm, tangent to the stem.
    NodeId limb = fork;
    for (int i = 1; i <= 40; i++) {
        const double angle = kPi * i / 40.0;
        limb =
            tree.add_child(limb, DVec3(0.1 - 0.1 * std::cos(angle), 1.0 + 0.1 * std::sin(angle), 0.0), 0.024);
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

}  // namespace
}  // namespace treerec
