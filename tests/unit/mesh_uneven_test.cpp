#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "mesh/branch_tubes.h"
#include "mesh/uneven_section.h"
#include "mesh_tubes.h"
#include "section_outlines.h"

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

struct TrunkRow {
    std::vector<double> distances;  // of its corners from their middle
    double radius;                  // that it is said to have
};

// The rows of the trunk whose middles lie between two heights.
std::vector<TrunkRow> trunk_rows(const Mesh& mesh, double above, double below) {
    const test::TubeRange trunk = test::tubes_of(mesh)[0];
    uint32_t stride = 0;
    while (mesh.colors[stride].g == 0.0f)
        stride++;
    std::vector<TrunkRow> rows;
    for (uint32_t row = 0; (row + 1) * stride <= trunk.end_vertex; row++) {
        DVec3 middle(0.0);
        for (uint32_t j = 0; j + 1 < stride; j++)
            middle += DVec3(mesh.positions[row * stride + j]) / static_cast<double>(stride - 1);
        if (middle.y < above || middle.y > below) continue;
        rows.push_back({{}, mesh.radii[row * stride]});
        for (uint32_t j = 0; j + 1 < stride; j++)
            rows.back().distances.push_back(glm::distance(DVec3(mesh.positions[row * stride + j]), middle));
    }
    return rows;
}

// By row of the trunk above its foot: how far its corners are from their middle, over their mean distance.
std::vector<std::vector<double>> sections_of(const Mesh& mesh, double above, double below) {
    std::vector<std::vector<double>> sections;
    for (TrunkRow& row : trunk_rows(mesh, above, below)) {
        double mean = 0.0;
        for (const double distance : row.distances)
            mean += distance / static_cast<double>(row.distances.size());
        // The wood is as thick as it was measured.
        EXPECT_NEAR(mean / row.radius, 1.0, 1e-3);
        for (double& distance : row.distances)
            distance /= mean;
        sections.push_back(std::move(row.distances));
    }
    return sections;
}

// By row of the trunk from 0.3 m up, its foot included: over the radius that it is said to have.
std::vector<std::vector<double>> sections_about(const Mesh& mesh) {
    std::vector<std::vector<double>> sections;
    for (TrunkRow& row : trunk_rows(mesh, 0.3, 4.0)) {
        for (double& distance : row.distances)
            distance /= row.radius;
        sections.push_back(std::move(row.distances));
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

// --- what was measured ------------------------------------------------------------------------------------

// The trunk with lobes from `first` to the node before `end`, and how far they stand out there.
Tree measured_trunk(double radius, NodeId first, NodeId end, float lobes = 0.12f) {
    Tree tree = bent_trunk(radius, 1.0);
    SectionShape shape;
    shape.cosine = {lobes, 0.0f, -0.5f * lobes, 0.0f};
    shape.sine = {0.0f, 0.75f * lobes, 0.0f, 0.25f * lobes};
    const size_t before = tree.add_sections({shape});
    for (NodeId id = first; id < end; id++)
        tree.set_section(id, before + 1);
    return tree;
}

TEST(MeasuredSections, AreDrawnWhereTheScanSawThem) {
    const Tree tree = measured_trunk(0.3, 0, 31);
    for (int level = 0; level < 2; level++) {
        SCOPED_TRACE(level);
        const Mesh mesh = build_branch_tubes(tree, {.level = level});
        const test::TubeRange trunk = test::tubes_of(mesh)[0];
        size_t looked = 0;
        for (uint32_t v = trunk.first_vertex; v < trunk.end_vertex; v++) {
            const DVec3 p(mesh.positions[v]);
            if (p.y < 2.0 || p.y > 4.5) continue;
            // The axis as nodes have it; the mesh's smooth one is within a hundredth of the radius of it.
            NodeId upper = 1;
            while (tree.node(upper).position.y < p.y)
                upper++;
            const DVec3 low = tree.node(upper - 1).position, way = tree.node(upper).position - low;
            const DVec3 direction = glm::normalize(way), zero = section_zero(direction);
            const double t = glm::dot(p - low, direction) / glm::length(way);
            const DVec3 out = p - (low + way * t);
            const double angle = std::atan2(glm::dot(out, glm::cross(direction, zero)), glm::dot(out, zero));
            const double radius = glm::mix(tree.node(upper - 1).radius, tree.node(upper).radius, t);
            EXPECT_NEAR(glm::length(out) / radius, test::outline_radius(*tree.section_of(5), angle), 0.04);
            looked++;
        }
        EXPECT_GT(looked, level == 0 ? 200u : 50u);
    }
    for (const std::vector<double>& section : sections_of(build_branch_tubes(tree, {.level = 2}), 1.0, 4.5))
        EXPECT_LT(spread(section), 0.002) << "from afar nobody sees it";
}

TEST(MeasuredSections, FadeToTheRestWhereNothingWasSeen) {
    const auto sections = sections_of(build_branch_tubes(measured_trunk(0.15, 0, 12)), 0.5, 4.8);
    ASSERT_GE(sections.size(), 6u);
    EXPECT_GT(spread(sections.front()), 0.2);
    EXPECT_LT(spread(sections[sections.size() - 2]), 0.08);
    // Nor does it end at once: within a hundredth of a metre it changes by no more than a fade does.
    const Tree tree = measured_trunk(0.15, 0, 12);
    UnevenSection section = uneven_section(5, 0.15, 0.0, 6.0);
    std::vector<SectionPlace> places;
    std::vector<Ring> rings;
    for (int i = 0; i < 60; i++) {
        if (i % 2 == 0) places.push_back({0.1 * i, tree.section_of(i / 2)});
        rings.push_back({DVec3(0, 0.1 * i, 0), DVec3(0, 1, 0), 0.15, 0.1 * i, DVec3(1, 0, 0)});
    }
    measure_section(section, places, rings.data(), rings.size(), true);
    for (int i = 0; i < 72; i++)
        for (double along = 0.0; along < 5.9; along += 0.01) {
            const double angle = 2.0 * kPi * i / 72.0;
            EXPECT_NEAR(section.factor(along, angle), section.factor(along + 0.01, angle), 0.015);
            if (along > 3.0) {
                EXPECT_NEAR(section.factor(along, angle), 1.0, 0.04);
            }
        }
}

TEST(MeasuredSections, NormalsAreTrue) {
    for (int level = 0; level < 2; level++) {
        const Mesh mesh = build_branch_tubes(measured_trunk(0.3, 0, 20, 0.2f), {.level = level});
        const test::TubeRange trunk = test::tubes_of(mesh)[0];
        // At the seam two columns share their places, and each has faces on one side alone.
        std::map<std::array<float, 3>, DVec3> faces;
        const auto place_of = [&](uint32_t v) {
            const Vec3& p = mesh.positions[v];
            return std::array<float, 3>{p.x, p.y, p.z};
        };
        for (size_t t = 0; t < mesh.indices.size(); t += 3) {
            const uint32_t* const corner = &mesh.indices[t];
            if (corner[0] >= trunk.end_vertex) continue;
            const DVec3 a(mesh.positions[corner[0]]), b(mesh.positions[corner[1]]),
                c(mesh.positions[corner[2]]);
            for (int k = 0; k < 3; k++)
                faces[place_of(corner[k])] += glm::cross(b - a, c - a);
        }
        double worst = 1.0, sum = 0.0;
        size_t looked = 0;
        for (uint32_t v = trunk.first_vertex; v < trunk.end_vertex; v++) {
            if (mesh.positions[v].y < 1.0f || mesh.positions[v].y > 4.5f) continue;
            const double cosine = std::abs(
                glm::dot(glm::normalize(faces[place_of(v)]), glm::normalize(DVec3(mesh.normals[v]))));
            worst = std::min(worst, cosine);
            sum += cosine;
            looked++;
        }
        ASSERT_GT(looked, 40u);
        EXPECT_GT(worst, level == 0 ? 0.93 : 0.85) << level;
        EXPECT_GT(sum / static_cast<double>(looked), level == 0 ? 0.985 : 0.95) << level;
    }
}

TEST(MeasuredSections, ButtressesStayWithinWood) {
    const Tree tree = measured_trunk(0.5, 0, 31, 0.9f);
    for (const std::vector<double>& section : sections_about(build_branch_tubes(tree))) {
        const auto [least, most] = std::minmax_element(section.begin(), section.end());
        EXPECT_GT(*least, 0.2);
        EXPECT_LT(*most, 2.4);
        EXPECT_GT(*most - *least, 1.0);
    }
    UnevenSection section = uneven_section(5, 0.2, 0.0, 6.0);
    const SectionPlace places[] = {{1.0, tree.section_of(3)}, {5.0, tree.section_of(3)}};
    std::vector<Ring> rings(2);
    for (size_t i = 0; i < 2; i++) {
        rings[i] = {DVec3(0, i * 6.0, 0), DVec3(0, 1, 0), 0.2, i * 6.0, DVec3(1, 0, 0)};
    }
    rings[1].along = 3.0;
    measure_section(section, places, rings.data(), rings.size(), true);
    ASSERT_TRUE(section.is_measured());
    const double step = 1e-6;
    for (int i = 0; i < 360; i++) {
        const double angle = 2.0 * kPi * i / 360.0;
        EXPECT_GE(section.factor(3.0, angle), 0.4);
        EXPECT_LE(section.factor(3.0, angle), 2.2);
        EXPECT_NEAR(section.turn(2.5, angle),
                    (section.factor(2.5, angle + step) - section.factor(2.5, angle - step)) / (2.0 * step),
                    1e-5);
    }
}

// A foot goes over into the trunk above it: the outline of one row is that of the next.
TEST(MeasuredSections, TheFootMeetsThem) {
    const auto sections = sections_about(build_branch_tubes(measured_trunk(0.2, 0, 31)));
    ASSERT_GE(sections.size(), 10u);
    for (size_t i = 1; i < sections.size(); i++)
        for (size_t j = 0; j < sections[i].size(); j++)
            EXPECT_NEAR(sections[i][j], sections[i - 1][j], 0.12) << i << " " << j;
}

}  // namespace
}  // namespace treerec
