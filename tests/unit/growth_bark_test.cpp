// Bark that grows around trees (src/growth).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "edit/commands/address.h"
#include "foliage/branch_axis.h"
#include "geometry/random.h"
#include "growth/grow_bark.h"
#include "growth/presets.h"
#include "growth_trees.h"
#include "mesh/branch_tubes.h"
#include "random_tree.h"
#include "tree/branches.h"

using namespace treerec;
using test::cylinder;
using test::expect_sound;
using test::radii;

namespace {

// A trunk with stout branches this way and that, some of which fork.
Tree stout_tree(uint64_t seed) {
    Random random(seed);
    Tree tree;
    const double radius = random.uniform(0.08, 0.14), height = random.uniform(1.5, 2.5);
    std::vector<NodeId> trunk{tree.add_root(DVec3(0.0), radius, kTrunkFlag)};
    DVec3 place(0.0);
    for (int i = 1; i <= 12; i++) {
        place += DVec3(random.uniform(-0.03, 0.03), height / 12.0, random.uniform(-0.03, 0.03));
        trunk.push_back(tree.add_child(trunk.back(), place, radius * (1.0 - 0.06 * i), kTrunkFlag));
    }
    for (int branch = 0; branch < 5; branch++) {
        const double angle = random.uniform(0.0, 6.28), up = random.uniform(-0.2, 1.2);
        const DVec3 direction = glm::normalize(DVec3(std::cos(angle), up, std::sin(angle)));
        NodeId last = trunk[3 + random.below(8)];
        const double own = tree.node(last).radius * random.uniform(0.5, 0.8);
        DVec3 at = tree.node(last).position;
        for (int i = 1; i <= 8; i++) {
            at += 0.1 * glm::normalize(direction + 0.2 * random.direction());
            last = tree.add_child(last, at, own * (1.0 - 0.06 * i));
        }
    }
    return tree;
}

GrowthRecipe recipe_of(const Tree& tree, const std::string& text) {
    return read_growth_recipe(tree, text);
}

}  // namespace

TEST(GrowthBark, StaysSoundAtEveryStepOnRandomTrees) {
    size_t frozen = 0, vertices = 0;
    for (uint64_t seed = 1; seed <= 6; seed++) {
        const Tree tree = stout_tree(seed);
        GrowthRecipe recipe =
            recipe_of(tree, "edges longest=0.045\nburl along=0.5 around=" + std::to_string(40 * seed) +
                                " radius=0.15 growth=0.8\n");
        const GrownTree grown = grow_bark(tree, recipe, {5});
        ASSERT_GE(grown.checks.size(), 10U);
        for (const GrowthStep& step : grown.checks)
            expect_sound(step);
        frozen += grown.checks.back().frozen;
        vertices += grown.checks.back().vertices;
        EXPECT_GE(grown.bark.branches.size(), 3U);
    }
    EXPECT_LE(static_cast<double>(frozen), 0.05 * static_cast<double>(vertices));
}

TEST(GrowthBark, ComesToTheTreesRadii) {
    const Tree tree = cylinder(0.12, 1.5);
    const GrownTree grown = grow_bark(tree, recipe_of(tree, "edges longest=0.04"));
    const std::vector<double> found = radii(grown.bark, 0.2, 1.2);
    ASSERT_GT(found.size(), 300U);
    EXPECT_NEAR(found[found.size() / 2], 0.12, 0.02 * 0.12);
    EXPECT_NEAR(found[found.size() / 20], 0.12, 0.05 * 0.12);
    EXPECT_NEAR(found[found.size() * 19 / 20], 0.12, 0.05 * 0.12);
}

// Skeletons of scans wind and jump from side to side.
TEST(GrowthBark, FollowsACrookedTrunkToItsEnd) {
    for (uint64_t seed = 1; seed <= 3; seed++) {
        Random random(seed);
        Tree tree;
        NodeId last = tree.add_root(DVec3(0.0), 0.04, kTrunkFlag);
        for (int i = 1; i <= 30; i++) {
            const double turn = 0.5 * i;
            const DVec3 jump(random.uniform(-0.02, 0.02), random.uniform(-0.01, 0.01),
                             random.uniform(-0.02, 0.02));
            last = tree.add_child(
                last, jump + DVec3(0.08 * std::sin(turn), 0.035 * i, 0.08 * (1.0 - std::cos(turn))),
                0.04 - 0.0006 * i, kTrunkFlag);
        }
        const GrownTree grown = grow_bark(tree, recipe_of(tree, "edges longest=0.035"), {20});
        for (const GrowthStep& step : grown.checks)
            expect_sound(step);
        const BranchList list = list_branches(tree);
        std::vector<AxisPoint> axis;
        sample_axis(tree, list, list.branches.front(), 0.001, axis);
        EXPECT_GT(grown.bark.branches.front().until, 0.95 * axis.back().along) << seed;
        // The whole axis is inside, and no bark is far from it.
        std::vector<double> off;
        for (const GrownBark::Vertex& vertex : grown.bark.vertices) {
            double nearest = 1e9, radius = 0.0;
            for (const AxisPoint& point : axis) {
                const double distance = glm::distance(point.position, DVec3(vertex.position));
                if (distance >= nearest) continue;
                nearest = distance;
                radius = point.radius;
            }
            if (vertex.position.y > 0.1f && vertex.position.y < 0.9f)
                off.push_back(std::abs(nearest - radius));
        }
        std::sort(off.begin(), off.end());
        EXPECT_LT(off[off.size() / 2], 0.003) << seed;
        EXPECT_LT(off[off.size() * 95 / 100], 0.02) << seed;
    }
}

TEST(GrowthBark, EndsShortlyBelowTheBaseAndBeyondACut) {
    for (const double radius : {0.12, 0.6}) {
        const Tree tree = cylinder(radius, 5.0 * radius);
        const double longest = std::max(0.04, 0.2 * radius);
        const GrownTree grown =
            grow_bark(tree, recipe_of(tree, "edges longest=" + std::to_string(longest) +
                                                " shortest=" + std::to_string(0.45 * longest)));
        double lowest = 0.0;
        for (const GrownBark::Vertex& vertex : grown.bark.vertices)
            lowest = std::min(lowest, static_cast<double>(vertex.position.y));
        EXPECT_LT(lowest, -0.5 * longest);
        EXPECT_GT(lowest, -0.6 * radius - longest);
        // A cut's bark is a shallow dome, without a pit where the tip came to its end.
        double highest = 0.0, pit = 10.0 * radius;
        for (const GrownBark::Vertex& vertex : grown.bark.vertices) {
            const DVec3 p(vertex.position);
            highest = std::max(highest, p.y);
            if (std::hypot(p.x, p.z) < 0.3 * radius && p.y > 0.0) pit = std::min(pit, p.y);
        }
        EXPECT_LT(highest, 5.6 * radius + longest);
        EXPECT_GT(pit, highest - 0.1 * radius);
        // It stands on the ground as thick as it is.
        const std::vector<double> ground = radii(grown.bark, -0.25 * radius, 0.25 * radius);
        EXPECT_NEAR(ground[ground.size() / 2], radius, 0.03 * radius);
    }
}

// Mizoguchi and Miyata 2014, equation 6: k S_c more a step, of S_c that makes the radius in all steps.
TEST(GrowthBark, ABurlIsAsHighAsItsGrowth) {
    const Tree tree = cylinder(0.15, 1.6);
    const GrownTree plain = grow_bark(tree, recipe_of(tree, "edges longest=0.04"));
    const GrownTree lump = grow_bark(
        tree, recipe_of(tree,
                        "edges longest=0.04\nburl along=0.8 around=0 radius=0.2 inner=0.12 growth=0.5 "
                        "from=0.5"));
    EXPECT_TRUE(lump.remarks.empty());
    // S_c steps of the second half of its age: half of the radius.
    const double expected = 0.5 * 0.5 * 0.15;
    const std::vector<double> before = radii(plain.bark, 0.75, 0.85, 0.0, 0.3);
    const std::vector<double> after = radii(lump.bark, 0.75, 0.85, 0.0, 0.3);
    ASSERT_FALSE(before.empty());
    ASSERT_FALSE(after.empty());
    EXPECT_NEAR(after[after.size() / 2] - before[before.size() / 2], expected, 0.1 * expected);
    // Beyond R and an edge there is none of it.
    for (const double radius : radii(lump.bark, 1.06, 1.3))
        EXPECT_NEAR(radius, 0.15, 0.005);
    EXPECT_LT(radii(lump.bark, 0.75, 0.85, kPi, 0.5).back(), 0.155)
        << radii(plain.bark, 0.75, 0.85, kPi, 0.5).back();
}

TEST(GrowthBark, IsTheSameEachTime) {
    const Tree tree = stout_tree(3);
    const GrowthRecipe recipe = recipe_of(tree, "edges longest=0.06\nburl along=0.4 radius=0.1");
    const GrownBark a = grow_bark(tree, recipe).bark, b = grow_bark(tree, recipe).bark;
    ASSERT_EQ(a.vertices.size(), b.vertices.size());
    EXPECT_EQ(a.indices, b.indices);
    for (size_t i = 0; i < a.vertices.size(); i++)
        ASSERT_EQ(a.vertices[i].position, b.vertices[i].position);
}

TEST(GrowthBark, TubesGoOnWhereItEnds) {
    const Tree tree = stout_tree(5);
    const GrownTree grown = grow_bark(tree, recipe_of(tree, "edges longest=0.05"));
    TubeOptions options;
    const Mesh tubes = build_branch_tubes(tree, options);
    options.grown = &grown.bark;
    const Mesh both = build_branch_tubes(tree, options);
    ASSERT_GT(both.positions.size(), grown.bark.vertices.size());
    EXPECT_EQ(both.positions.size(), both.normals.size());
    EXPECT_EQ(both.positions.size(), both.wind.size());
    EXPECT_EQ(both.triangle_count() >= grown.bark.indices.size() / 3, true);
    // What is left of the tubes is less than they were.
    EXPECT_LT(both.triangle_count() - grown.bark.indices.size() / 3, tubes.triangle_count() / 2);
    Bounds bounds;
    for (const Vec3& position : both.positions)
        bounds.add(DVec3(position));
    EXPECT_NEAR(bounds.max.y, tree.bounds().max.y, 0.1);
    for (const Vec3& normal : both.normals)
        ASSERT_NEAR(glm::length(normal), 1.0, 1e-3);
}

TEST(GrowthBark, TellsWhatItCannotDo) {
    Tree thin;
    NodeId last = thin.add_root(DVec3(0.0), 0.004, kTrunkFlag);
    thin.add_child(last, DVec3(0.0, 1.0, 0.0), 0.003, kTrunkFlag);
    EXPECT_THROW(grow_bark(thin, {}), Error);
    EXPECT_THROW(grow_bark(Tree(), {}), Error);
    const Tree tree = cylinder(0.1, 1.0);
    const GrownTree grown = grow_bark(
        tree, recipe_of(tree, "edges longest=0.06\nburl along=7 radius=0.1\nburl along=0.5 radius=0.1"));
    ASSERT_EQ(grown.remarks.size(), 1U);
    EXPECT_NE(grown.remarks[0].find("7 m along"), std::string::npos) << grown.remarks[0];
}

TEST(GrowthRecipe, KeepsWhatItWasTold) {
    const Tree tree = cylinder(0.1, 1.0);
    const GrowthRecipe recipe = recipe_of(
        tree, "# lumps\nedges longest=0.05\n\nburl node=root along=0.5 around=90 radius=0.2 growth=0.7\n");
    EXPECT_DOUBLE_EQ(recipe.longest, 0.05);
    EXPECT_LE(recipe.shortest, 0.025);
    ASSERT_EQ(recipe.features.size(), 1U);
    EXPECT_DOUBLE_EQ(recipe.features[0].inner, 0.1);
    const GrowthRecipe again = recipe_of(tree, recipe.text);
    EXPECT_EQ(again.text, recipe.text);
    ASSERT_EQ(again.features.size(), 1U);
    EXPECT_DOUBLE_EQ(again.features[0].around, 90.0);
}

TEST(GrowthRecipe, PresetsHaveEdgesToSuitTheTrunk) {
    // Thin and stout, low: mouths are some edges wide. Tall with much wood: no finer than can be waited for.
    for (const double radius : {0.05, 0.076, 0.22, 0.6}) {
        const Tree tree = cylinder(radius, 2.5);
        const GrowthRecipe recipe = recipe_of(tree, preset_recipe(find_growth_preset("hollow_refuge"), tree));
        EXPECT_GT(recipe.features[0].width, 4.0 * recipe.longest) << radius;
        EXPECT_LT(recipe.features[0].width, 10.0 * recipe.longest) << radius;
    }
    EXPECT_GT(preset_edges(cylinder(0.15, 40.0)), 2.0 * preset_edges(cylinder(0.15, 2.0)));
    const Tree tall = cylinder(0.06, 14.0);
    EXPECT_GT(preset_edges(tall), 0.2 * 0.06);
    // What the user says goes.
    const std::string text = preset_recipe(find_growth_preset("spiral_grain"), tall);
    EXPECT_DOUBLE_EQ(recipe_of(tall, text + "edges longest=0.06").longest, 0.06);
}

TEST(GrowthRecipe, RefusesNonsense) {
    const Tree tree = cylinder(0.1, 1.0);
    for (const char* text :
         {"bulr along=1", "burl radius=nan", "burl radius=-1", "edges longest=0.02 shortest=0.015",
          "burl radius=0.1 inner=0.2", "burl along", "steps count=1e9"})
        EXPECT_THROW(recipe_of(tree, text), Error) << text;
    try {
        recipe_of(tree, "edges longest=0.05\nbulr along=1");
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("Line 2"), std::string::npos) << error.what();
    }
}
