#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "mesh/branch_tubes.h"
#include "mesh/uneven_section.h"
#include "mesh_tubes.h"

namespace treerec {
namespace {

// A trunk of 6 m that bends a little, with a branch; it stands at such a place of its scan.
Tree bent_trunk(double radius, double place) {
    Tree tree;
    NodeId at = tree.add_root({0, 0, 0}, radius, kTrunkFlag);
    for (int i = 1; i <= 30; i++)
        at = tree.add_child(at, {0.02 * i * std::sin(0.3 * i), 0.2 * i, 0.0}, radius * (1.0 - 0.02 * i),
                            kTrunkFlag);
    tree.add_child(20, {0.5, 4.5, 0.3}, 0.1 * radius);
    ScanFrame frame;
    frame.origin.x = place;
    tree.set_frame(frame);
    return tree;
}

// By row of the trunk above its foot: how far its corners are from their middle, over their mean distance.
std::vector<std::vector<double>> sections_of(const Mesh& mesh, double above, double below) {
    const test::TubeRange trunk = test::tubes_of(mesh)[0];
    uint32_t stride = 0;
    while (mesh.colors[stride].g == 0.0f)
        stride++;
    std::vector<std::vector<double>> sections;
    for (uint32_t row = 0; (row + 1) * stride <= trunk.end_vertex; row++) {
        DVec3 middle(0.0);
        for (uint32_t j = 0; j + 1 < stride; j++)
            middle += DVec3(mesh.positions[row * stride + j]) / static_cast<double>(stride - 1);
        if (middle.y < above || middle.y > below) continue;
        std::vector<double>& section = sections.emplace_back();
        double mean = 0.0;
        for (uint32_t j = 0; j + 1 < stride; j++) {
            section.push_back(glm::distance(DVec3(mesh.positions[row * stride + j]), middle));
            mean += section.back() / (stride - 1);
        }
        // The wood is as thick as it was measured.
        EXPECT_NEAR(mean / mesh.radii[row * stride], 1.0, 1e-3);
        for (double& radius : section)
            radius /= mean;
    }
    return sections;
}

double spread(const std::vector<double>& section) {
    const auto [least, most] = std::minmax_element(section.begin(), section.end());
    return *most - *least;
}

TEST(UnevenSections, NoTrunkIsAPerfectCircle) {
    for (const double radius : {0.05, 0.15, 0.4})
        for (int level = 0; level < 2; level++) {
            SCOPED_TRACE(std::to_string(radius) + " " + std::to_string(level));
            const auto sections =
                sections_of(build_branch_tubes(bent_trunk(radius, 1.0), {.level = level}), 5.0 * radius, 4.5);
            ASSERT_GE(sections.size(), 4u);  // of a stout one at level 1
            for (size_t i = 0; i < sections.size(); i++) {
                if (i > 0 && i + 1 < sections.size()) {
                    EXPECT_GT(spread(sections[i]), 0.01);
                }
                EXPECT_LT(spread(sections[i]), 0.08);
            }
        }
    for (const std::vector<double>& section :
         sections_of(build_branch_tubes(bent_trunk(0.15, 1.0), {.level = 2}), 1.0, 4.5))
        EXPECT_LT(spread(section), 0.002) << "from afar nobody sees it";
}

TEST(UnevenSections, TreesDiffer) {
    const auto one = sections_of(build_branch_tubes(bent_trunk(0.15, 1.0)), 1.0, 4.5);
    const auto other = sections_of(build_branch_tubes(bent_trunk(0.15, 2.0)), 1.0, 4.5);
    ASSERT_EQ(one.size(), other.size());
    double apart = 0.0;
    for (size_t i = 0; i < one.size(); i++)
        for (size_t j = 0; j < std::min(one[i].size(), other[i].size()); j++)
            apart = std::max(apart, std::abs(one[i][j] - other[i][j]));
    EXPECT_GT(apart, 0.01);
}

TEST(UnevenSections, AreSmoothAndRoundAtBothEnds) {
    const UnevenSection section = uneven_section(5, 0.2, 1.0, 6.0);
    for (const double end : {0.5, 1.0, 6.0, 7.0})
        EXPECT_EQ(section.factor(end, 1.0), 1.0);
    const double step = 1e-6;
    double mean = 0.0;
    for (int i = 0; i < 360; i++) {
        const double angle = 2.0 * kPi * i / 360.0, along = 1.0 + 5.0 * i / 360.0;
        mean += section.factor(3.0, angle) / 360.0;
        EXPECT_NEAR(section.factor(along, angle), section.factor(along, angle + 2.0 * kPi), 1e-9);
        EXPECT_NEAR(
            section.turn(along, angle),
            (section.factor(along, angle + step) - section.factor(along, angle - step)) / (2.0 * step), 1e-6);
        // Not more than a bark's furrow of a hundredth of the radius within a tenth of it.
        EXPECT_NEAR(section.factor(along, angle), section.factor(along + 0.02, angle), 0.01);
    }
    EXPECT_NEAR(mean, 1.0, 1e-9);
    const UnevenSection none = uneven_section(5, 0.2, 2.0, 1.0);
    EXPECT_EQ(none.factor(1.5, 1.0), 1.0);
}

}  // namespace
}  // namespace treerec
