#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "mesh/branch_tubes.h"
#include "tree/tree.h"

namespace treerec {
namespace {

// A log that leans, and thins to its upper end.
Tree leaning_log(uint8_t flags) {
    Tree tree;
    NodeId at = tree.add_root({1.0, 0.5, 2.0}, 0.2, flags);
    for (int i = 1; i <= 8; i++)
        at = tree.add_child(at, {1.0 + 0.1 * i, 0.5 + 0.25 * i, 2.0}, 0.2 - 0.01 * i, flags);
    return tree;
}

bool is_cut(const Mesh& mesh, size_t vertex) {
    return mesh.uvs[vertex].y < -0.5 * kCutMark;
}

TEST(Cuts, AFaceKnowsHowFarItIsFromThePith) {
    for (const bool pivots : {true, false}) {
        const Tree tree = leaning_log(0);
        const Mesh mesh = build_branch_tubes(tree, {.pivots = pivots});
        const DVec3 ends[] = {tree.node(tree.root()).position, {1.8, 2.5, 2.0}};
        const double radii[] = {0.2, 0.12};
        size_t rims[2] = {}, middles[2] = {};
        for (size_t v = 0; v < mesh.positions.size(); v++) {
            if (!is_cut(mesh, v)) continue;
            const DVec3 at(mesh.positions[v]);
            const size_t end = glm::distance(at, ends[0]) < glm::distance(at, ends[1]) ? 0 : 1;
            const double away = std::hypot(mesh.uvs[v].x, mesh.uvs[v].y + kCutMark);
            EXPECT_NEAR(away, glm::distance(at, ends[end]), 1e-4);
            (away > 0.5 * radii[end] ? rims : middles)[end]++;
            if (away > 0.5 * radii[end]) {
                EXPECT_NEAR(away, radii[end], 1e-4);
            }
            if (pivots) {
                EXPECT_NEAR(mesh.radii[v], radii[end], 1e-5);
            }
            // It faces along the wood.
            const double along = glm::dot(DVec3(mesh.normals[v]), glm::normalize(ends[1] - ends[0]));
            EXPECT_GT(end == 1 ? along : -along, 0.95);
        }
        for (const size_t end : {0, 1}) {
            EXPECT_GE(rims[end], 12u);
            EXPECT_GE(middles[end], 1u);
        }
    }
}

TEST(Cuts, NoTriangleIsHalfBark) {
    for (const int level : {0, 1, 2}) {
        const Mesh mesh = build_branch_tubes(leaning_log(0), {.level = level});
        size_t cuts = 0;
        for (size_t i = 0; i < mesh.indices.size(); i += 3) {
            const bool cut = is_cut(mesh, mesh.indices[i]);
            EXPECT_EQ(cut, is_cut(mesh, mesh.indices[i + 1]));
            EXPECT_EQ(cut, is_cut(mesh, mesh.indices[i + 2]));
            cuts += cut;
        }
        EXPECT_GE(cuts, 6u) << level;
    }
}

TEST(Cuts, ATrunkThatStandsIsCutAboveAlone) {
    const Mesh mesh = build_branch_tubes(leaning_log(kTrunkFlag));
    for (size_t v = 0; v < mesh.positions.size(); v++)
        if (is_cut(mesh, v)) {
            EXPECT_GT(mesh.positions[v].y, 2.0f);
        }
}

}  // namespace
}  // namespace treerec
