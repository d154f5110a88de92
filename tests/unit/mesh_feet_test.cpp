#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "mesh/branch_tubes.h"
#include "mesh/root_flare.h"
#include "mesh_tubes.h"
#include "tree/tree.h"

namespace treerec {
namespace {

using test::TubeRange;
using test::tubes_of;

// The outline of a trunk's foot at its ring so high: by corner, the distance from the axis.
std::vector<double> outline_at(const Mesh& mesh, double height) {
    const TubeRange trunk = tubes_of(mesh)[0];
    uint32_t stride = 0;
    while (mesh.colors[stride].g == 0.0f)
        stride++;
    std::vector<double> best;
    double nearest = 1e9;
    for (uint32_t row = 0; (row + 1) * stride <= trunk.end_vertex; row++) {
        const double off = std::abs(mesh.positions[row * stride].y - height);
        if (off >= nearest) continue;
        nearest = off;
        best.clear();
        for (uint32_t j = 0; j + 1 < stride; j++)
            best.push_back(
                std::hypot(mesh.positions[row * stride + j].x, mesh.positions[row * stride + j].z));
    }
    return best;
}

// As many corners stand further out than their neighbours.
size_t backs_of(const std::vector<double>& outline) {
    size_t backs = 0;
    const size_t count = outline.size();
    for (size_t j = 0; j < count; j++)
        backs += outline[j] > outline[(j + 1) % count] && outline[j] > outline[(j + count - 1) % count];
    return backs;
}

TEST(Feet, OfTallTreesGoDeeper) {
    EXPECT_NEAR(foot_depth(0.4), 0.2, 1e-9);
    EXPECT_NEAR(foot_depth(3.0), 0.6, 1e-9);
    EXPECT_NEAR(foot_depth(12.0), 1.2, 1e-9);
    EXPECT_NEAR(foot_depth(50.0), 2.0, 1e-9);
}

TEST(Feet, ATrunkRunsOutIntoRootsOfItsOwn) {
    std::set<size_t> counts;
    std::set<double> widest;
    for (int place = 0; place < 20; place++) {
        SCOPED_TRACE(place);
        const double radius = 0.2;
        Tree tree;
        NodeId at = tree.add_root({0, 0, 0}, radius, kTrunkFlag);
        for (int i = 1; i <= 20; i++)
            at = tree.add_child(at, {0, 0.5 * i, 0}, radius * (1.0 - 0.04 * i), kTrunkFlag);
        ScanFrame frame;
        frame.origin = {1.0 * place, 2.0, 0.0};
        tree.set_frame(frame);
        const std::vector<double> pole = outline_at(build_branch_tubes(tree), 0.0);
        EXPECT_LT(*std::max_element(pole.begin(), pole.end()) / *std::min_element(pole.begin(), pole.end()),
                  1.001)
            << "without a branch it is a palm or a pole";
        tree.add_child(tree.node(at).parent, {1, 10.5, 0}, 0.02);
        const Mesh mesh = build_branch_tubes(tree);
        const std::vector<double> ground = outline_at(mesh, 0.0), under = outline_at(mesh, -0.07);
        const size_t backs = backs_of(ground);
        EXPECT_GE(backs, 4u);
        EXPECT_LE(backs, kMostRoots);
        counts.insert(backs);
        widest.insert(*std::max_element(ground.begin(), ground.end()));
        for (size_t j = 0; j < ground.size(); j++) {
            EXPECT_GE(ground[j], radius);
            EXPECT_LT(ground[j], 3.2 * radius);
            EXPECT_GE(under[j], radius);
        }
        EXPECT_GT(*std::max_element(under.begin(), under.end()),
                  *std::max_element(ground.begin(), ground.end()) + 0.02);
        // Two diameters up it is the trunk that was measured.
        for (size_t v = 0; v < mesh.positions.size(); v++)
            if (mesh.positions[v].y > 4.0 * radius && mesh.custom0[v].w == 0.0f) {
                EXPECT_LE(std::hypot(mesh.positions[v].x, mesh.positions[v].z), radius + 1e-6);
            }
        // From somewhat further away it is the same foot.
        const std::vector<double> coarse = outline_at(build_branch_tubes(tree, {.level = 1}), 0.0);
        EXPECT_NEAR(*std::max_element(coarse.begin(), coarse.end()),
                    *std::max_element(ground.begin(), ground.end()), 1e-6);
    }
    EXPECT_GE(counts.size(), 3u);
    EXPECT_EQ(widest.size(), 20u);
}

TEST(Feet, ASpurAtTheBaseDoesNotTurnTheTrunkOver) {
    Tree tree;
    NodeId at = tree.add_root({0.1, 0, 0}, 0.2, kTrunkFlag);
    for (int i = 0; i < 20; i++)
        at = tree.add_child(at, {0, 0.1 + 0.2 * i, 0}, 0.2, kTrunkFlag);
    const Mesh mesh = build_branch_tubes(tree);
    for (uint32_t v = 0; mesh.colors[v].g == 0.0f; v++) {
        EXPECT_LT(std::abs(mesh.positions[v].x - 0.1f), 0.35f);
        EXPECT_NEAR(mesh.positions[v].y, -foot_depth(3.9), 1e-5);
    }
}

}  // namespace
}  // namespace treerec
