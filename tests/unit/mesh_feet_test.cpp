#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "mesh/above_ground.h"
#include "mesh/branch_tubes.h"
#include "mesh/root_flare.h"
#include "mesh_tubes.h"
#include "tree/tree.h"

namespace treerec {
namespace {

using test::TubeRange;
using test::tubes_of;

// The corners of a trunk's foot at its ring so high.
std::vector<DVec2> corners_at(const Mesh& mesh, double height) {
    const TubeRange trunk = tubes_of(mesh)[0];
    uint32_t stride = 0;
    while (mesh.colors[stride].g == 0.0f)
        stride++;
    std::vector<DVec2> best;
    double nearest = 1e9;
    for (uint32_t row = 0; (row + 1) * stride <= trunk.end_vertex; row++) {
        const double off = std::abs(mesh.positions[row * stride].y - height);
        if (off >= nearest) continue;
        nearest = off;
        best.clear();
        for (uint32_t j = 0; j + 1 < stride; j++)
            best.emplace_back(mesh.positions[row * stride + j].x, mesh.positions[row * stride + j].z);
    }
    return best;
}

// By corner, the distance from the axis.
std::vector<double> outline_at(const Mesh& mesh, double height) {
    std::vector<double> outline;
    for (const DVec2& corner : corners_at(mesh, height))
        outline.push_back(glm::length(corner));
    return outline;
}

double widest_of(const std::vector<double>& outline) {
    return *std::max_element(outline.begin(), outline.end());
}

double narrowest_of(const std::vector<double>& outline) {
    return *std::min_element(outline.begin(), outline.end());
}

// Radians: the most that an outline turns within a third of the trunk's radius.
double sharpest_turn(const std::vector<DVec2>& corners, double radius) {
    const size_t count = corners.size();
    const auto side = [&](size_t j) { return corners[(j + 1) % count] - corners[j % count]; };
    const auto turn_at = [&](size_t j) {
        const DVec2 a = side(j + count - 1), b = side(j);
        return std::atan2(a.x * b.y - a.y * b.x, glm::dot(a, b));
    };
    double most = 0.0;
    for (size_t j = 0; j < count; j++) {
        double turned = 0.0, way = 0.0;
        for (size_t k = j; k < j + count && way < radius / 3.0; k++) {
            turned += turn_at(k);
            way += glm::length(side(k));
            most = std::max(most, std::abs(turned));
        }
    }
    return most;
}

// A trunk with a branch, which stands at such a place.
Tree standing(double radius, int place) {
    Tree tree;
    NodeId at = tree.add_root({0, 0, 0}, radius, kTrunkFlag);
    for (int i = 1; i <= 20; i++)
        at = tree.add_child(at, {0, 2.5 * radius * i, 0}, radius * (1.0 - 0.04 * i), kTrunkFlag);
    ScanFrame frame;
    frame.origin = {1.0 * place, 2.0, 0.0};
    tree.set_frame(frame);
    tree.add_child(tree.node(at).parent, {5.0 * radius, 52.5 * radius, 0}, 0.1 * radius);
    return tree;
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

// Pictures draw no ground that would hide it.
TEST(Feet, AboveTheGroundIsWhatIsSeen) {
    for (const double radius : {0.02, 0.2, 0.6}) {
        SCOPED_TRACE(radius);
        const Tree tree = standing(radius, 3);
        const Mesh bark = build_branch_tubes(tree), seen = above_ground(bark, tree);
        const auto lowest = [](const Mesh& mesh) {
            return std::min_element(mesh.positions.begin(), mesh.positions.end(),
                                    [](const Vec3& a, const Vec3& b) { return a.y < b.y; })
                ->y;
        };
        EXPECT_LT(lowest(bark), -0.15F);
        EXPECT_GT(lowest(seen), -0.1F * static_cast<float>(radius));
        // All that is higher is there, with all that it has.
        size_t above = 0;
        for (size_t i = 0; i + 2 < bark.indices.size(); i += 3)
            above += std::any_of(&bark.indices[i], &bark.indices[i] + 3,
                                 [&](uint32_t corner) { return bark.positions[corner].y > 1e-3F; });
        EXPECT_EQ(seen.triangle_count(), above);
        for (const size_t count :
             {seen.normals.size(), seen.tangents.size(), seen.uvs.size(), seen.colors.size(),
              seen.custom0.size(), seen.radii.size(), seen.wind.size()})
            EXPECT_EQ(count, seen.positions.size());
        EXPECT_LT(seen.positions.size(), bark.positions.size());
        const uint32_t last = bark.indices.back(), same = seen.indices.back();
        EXPECT_EQ(seen.positions[same], bark.positions[last]);
        EXPECT_EQ(seen.wind[same], bark.wind[last]);
    }
    // A branch that was cut off hangs where it likes.
    Tree branch;
    NodeId at = branch.add_root({0, 0, 0}, 0.05);
    for (int i = 1; i < 5; i++)
        at = branch.add_child(at, {0.01 * i, -0.1 * i, 0}, 0.04);
    const Mesh bark = build_branch_tubes(branch);
    EXPECT_EQ(above_ground(bark, branch).triangle_count(), bark.triangle_count());
    EXPECT_EQ(above_ground(Mesh(), Tree()).triangle_count(), 0U);
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

TEST(Feet, AYoungStemEndsInASoftFlare) {
    for (const double radius : {0.02, 0.035, 0.05, 0.075}) {
        for (int place = 0; place < 20; place++) {
            SCOPED_TRACE(radius);
            SCOPED_TRACE(place);
            const std::vector<double> ground = outline_at(build_branch_tubes(standing(radius, place)), 0.0);
            EXPECT_GE(narrowest_of(ground), 1.1 * radius);
            EXPECT_GE(widest_of(ground), 1.15 * radius);
            EXPECT_LE(widest_of(ground), 1.4 * radius);
            EXPECT_LE(widest_of(ground), 1.25 * narrowest_of(ground));
        }
    }
}

TEST(Feet, NoRootEndsAsAPoint) {
    for (const double radius : {0.05, 0.1, 0.2, 0.5}) {
        double sharpest = 0.0, unlike = 0.0;
        for (int place = 0; place < 20; place++) {
            const Mesh mesh = build_branch_tubes(standing(radius, place));
            sharpest = std::max(sharpest, sharpest_turn(corners_at(mesh, 0.0), radius));
            const std::vector<double> ground = outline_at(mesh, 0.0);
            unlike = std::max(unlike, widest_of(ground) / narrowest_of(ground));
        }
        SCOPED_TRACE(radius);
        EXPECT_LT(sharpest, 1.9);
        EXPECT_GT(unlike, radius < 0.08 ? 1.03 : 1.2);
    }
}

TEST(Feet, UnderTheGroundATrunkThins) {
    for (const double radius : {0.03, 0.1, 0.4}) {
        for (int place = 0; place < 10; place++) {
            SCOPED_TRACE(radius);
            SCOPED_TRACE(place);
            const Mesh mesh = build_branch_tubes(standing(radius, place));
            const double depth = foot_depth(52.5 * radius);
            const double ground = widest_of(outline_at(mesh, 0.0));
            // A slope lays bare wood as stout as the trunk.
            EXPECT_GT(narrowest_of(outline_at(mesh, -0.8 * radius)), 0.85 * radius);
            EXPECT_LT(widest_of(outline_at(mesh, -0.8 * radius)), 1.5 * ground);
            EXPECT_LT(widest_of(outline_at(mesh, -4.0 * radius)), 0.7 * ground);
            EXPECT_LT(widest_of(outline_at(mesh, -depth)), 0.5 * ground);
        }
    }
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
