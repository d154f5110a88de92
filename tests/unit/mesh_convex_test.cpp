#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "error.h"
#include "mesh/branch_tubes.h"
#include "mesh/capsules.h"
#include "mesh/convex_parts.h"
#include "mesh/wood_mass.h"
#include "mesh_tubes.h"
#include "random_tree.h"
#include "tree/measure.h"

namespace treerec {
namespace {

Tree cone(double base, double top, int steps, double height) {
    Tree tree;
    NodeId at = tree.add_root({0, 0, 0}, base, kTrunkFlag);
    for (int i = 1; i <= steps; i++)
        at = tree.add_child(at, {0.0, height * i / steps, 0.0}, base + (top - base) * i / steps, kTrunkFlag);
    return tree;
}

TEST(ConvexParts, ATaperingTrunkIsOne) {
    const Tree tree = cone(0.3, 0.1, 20, 8.0);
    const std::vector<ConvexPart> parts = fit_convex_parts(tree);
    ASSERT_EQ(parts.size(), 1u);
    EXPECT_EQ(parts[0].points.size(), 16u);
    // Its hull has the wood's volume.
    EXPECT_NEAR(volume_of(parts[0]), measure(tree).volume, 0.001 * measure(tree).volume);
    for (const DVec3& p : parts[0].points)
        EXPECT_TRUE(std::abs(p.y) < 1e-9 || std::abs(p.y - 8.0) < 1e-9);
    // Capsules, which do not taper, need several for it.
    EXPECT_GT(fit_capsules(tree).size(), 3u);
}

// All points lie on one side of every face of a hull: a prism between two polygons is convex.
TEST(ConvexParts, AreConvexAndWithinTheBudget) {
    for (uint64_t seed = 1; seed <= 40; seed++) {
        SCOPED_TRACE(seed);
        const Tree tree = test::random_tree(seed, 500);
        ConvexOptions options;
        options.minimum_radius = 0.01;
        for (const int maximum : {1, 7, 200}) {
            options.maximum = maximum;
            const std::vector<ConvexPart> parts = fit_convex_parts(tree, options);
            ASSERT_FALSE(parts.empty());
            ASSERT_LE(int(parts.size()), maximum);
            for (const ConvexPart& part : parts) {
                ASSERT_TRUE(tree.contains(part.node));
                ASSERT_GT(volume_of(part), 0.0);
                const size_t sides = part.points.size() / 2;
                DVec3 middle(0.0);
                for (const DVec3& p : part.points)
                    middle += p / static_cast<double>(part.points.size());
                for (size_t j = 0; j < sides; j++) {
                    const DVec3 a = part.points[j], b = part.points[(j + 1) % sides],
                                c = part.points[sides + j];
                    DVec3 out = glm::normalize(glm::cross(b - a, c - a));
                    if (glm::dot(out, middle - a) > 0.0) out = -out;
                    for (const DVec3& p : part.points)
                        ASSERT_LT(glm::dot(out, p - a), 1e-9);
                }
            }
        }
    }
}

TEST(ConvexParts, TheTrunkAloneHasNoBranches) {
    const Tree tree = test::random_tree(3, 500);
    ConvexOptions options;
    options.minimum_radius = 0.0;
    options.trunk_only = true;
    options.maximum = 10000;
    const std::vector<ConvexPart> parts = fit_convex_parts(tree, options);
    ASSERT_FALSE(parts.empty());
    for (const ConvexPart& part : parts)
        EXPECT_TRUE(tree.node(part.node).is_trunk());
    options.trunk_only = false;
    EXPECT_GT(fit_convex_parts(tree, options).size(), parts.size());
}

TEST(ConvexParts, RefuseWhatIsOutOfRange) {
    const Tree tree = cone(0.3, 0.1, 3, 8.0);
    EXPECT_TRUE(fit_convex_parts(Tree()).empty());
    EXPECT_THROW(fit_convex_parts(tree, {.maximum = 0}), Error);
    EXPECT_THROW(fit_convex_parts(tree, {.minimum_radius = std::nan("")}), Error);
    EXPECT_THROW(fit_convex_parts(tree, {.tolerance = 0.0}), Error);
    EXPECT_THROW(fit_convex_parts(tree, {.sides = 2}), Error);
}

TEST(WoodMass, AConeHasItsTextbookMoments) {
    const double r = 0.3, h = 6.0, density = 800.0;
    const WoodMass wood = weigh_wood(cone(r, 1e-4, 400, h), density);
    const double mass = density * kPi * r * r * h / 3.0;
    EXPECT_NEAR(wood.mass, mass, 0.002 * mass);
    EXPECT_NEAR(wood.centre.y, 0.25 * h, 0.005 * h);
    // A solid cone about its centre of mass: 3/10 m r^2 along, 3/80 m (4 r^2 + h^2) across.
    EXPECT_NEAR(wood.inertia.y, 0.3 * mass * r * r, 0.01 * 0.3 * mass * r * r);
    const double across = 3.0 / 80.0 * mass * (4.0 * r * r + h * h);
    EXPECT_NEAR(wood.inertia.x, across, 0.01 * across);
    EXPECT_NEAR(wood.inertia.z, across, 0.01 * across);
}

TEST(WoodMass, AgreesWithTheMeasuredVolumeAndHasRightAngles) {
    for (uint64_t seed = 1; seed <= 40; seed++) {
        const Tree tree = test::random_tree(seed, 400);
        const WoodMass wood = weigh_wood(tree, 1000.0);
        EXPECT_NEAR(wood.mass, 1000.0 * measure(tree).volume, 1e-6 * wood.mass);
        const Bounds box = tree.bounds();
        for (int i = 0; i < 3; i++) {
            EXPECT_GE(wood.centre[i], box.min[i]);
            EXPECT_LE(wood.centre[i], box.max[i]);
            EXPECT_NEAR(glm::length(wood.axes[i]), 1.0, 1e-9);
            EXPECT_NEAR(glm::dot(wood.axes[i], wood.axes[(i + 1) % 3]), 0.0, 1e-9);
            EXPECT_GT(wood.inertia[i], 0.0);
            // No moment is larger than the other two together.
            EXPECT_LE(wood.inertia[i], wood.inertia[(i + 1) % 3] + wood.inertia[(i + 2) % 3] + 1e-9);
        }
        EXPECT_NEAR(glm::dot(glm::cross(wood.axes[0], wood.axes[1]), wood.axes[2]), 1.0, 1e-9);
    }
    EXPECT_EQ(weigh_wood(Tree(), 800.0).mass, 0.0);
    EXPECT_THROW(weigh_wood(Tree(), 0.0), Error);
    EXPECT_THROW(weigh_wood(Tree(), std::nan("")), Error);
}

// A log: wood that does not stand is closed at both ends, and its ends are flat.
TEST(CutFaces, ALogIsClosed) {
    Tree tree;
    NodeId at = tree.add_root({0, 1, 0}, 0.1);
    for (int i = 1; i <= 6; i++)
        at = tree.add_child(at, {0.5 * i, 1, 0}, 0.1 - 0.005 * i);
    for (int level = 0; level < 3; level++) {
        const Mesh mesh = build_branch_tubes(tree, {.level = level});
        const std::vector<test::TubeRange> tubes = test::tubes_of(mesh);
        ASSERT_EQ(tubes.size(), 1u);
        size_t twice = 0;
        EXPECT_TRUE(test::open_edges(mesh, tubes[0], twice).empty());
        EXPECT_EQ(twice, 0u);
        double volume = 0.0, low = 1e9, high = -1e9;
        for (size_t i = 0; i < mesh.indices.size(); i += 3)
            volume += glm::dot(test::corner_of(mesh, i), test::face_normal(mesh, i)) / 6.0;
        for (const Vec3& p : mesh.positions) {
            low = std::min(low, double(p.x));
            high = std::max(high, double(p.x));
        }
        // The prism's share of the round wood's.
        EXPECT_GT(volume, 0.4 * measure(tree).volume);
        EXPECT_LT(volume, 1.05 * measure(tree).volume);
        EXPECT_NEAR(low, 0.0, 1e-6);
        if (level == 0) {
            EXPECT_NEAR(high, 3.0, 0.01);
        }
    }
}

// Half a metre thick, an end shows at all levels: a stump that turned into a pencil as one walked away.
TEST(CutFaces, AThickEndStaysFlatAtAllLevels) {
    Tree tree;
    NodeId at = tree.add_root({0, 0, 0}, 0.27, kTrunkFlag);
    for (int i = 1; i <= 4; i++)
        at = tree.add_child(at, {0, 0.4 * i, 0}, 0.27, kTrunkFlag);
    for (int level = 0; level < 4; level++) {
        const Mesh mesh = build_branch_tubes(tree, {.level = level});
        float high = 0.0F;
        for (const Vec3& p : mesh.positions)
            high = std::max(high, p.y);
        EXPECT_NEAR(high, 1.6F, 0.01F) << level;
    }
}

}  // namespace
}  // namespace treerec
