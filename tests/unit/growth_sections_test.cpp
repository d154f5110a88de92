// Wood that is not round: sections of recipes, and those that a scan shows (src/growth/section.h,
// section_fit.h).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "geometry/random.h"
#include "growth/bark_fit.h"
#include "growth/grow_bark.h"
#include "growth/lumps.h"
#include "growth_trees.h"

using namespace treerec;

namespace {

constexpr double kWood = 0.2;

// Five flutes.
double fluted(double angle) {
    return 1.0 + 0.15 * std::cos(5.0 * angle);
}

std::string fluted_line(double along, int directions) {
    std::string line = "section along=" + std::to_string(along) + " radii=";
    for (int i = 0; i < directions; i++)
        line += (i > 0 ? "," : "") + std::to_string(fluted(2.0 * kPi * i / directions));
    return line + "\n";
}

// Degrees are counted from +X by way of -Z.
double angle_of(const DVec3& p) {
    return std::atan2(-p.z, p.x);
}

GrownTree grown_soundly(const Tree& tree, const GrowthRecipe& recipe) {
    GrowBarkOptions options;
    options.check_every = 10;
    GrownTree grown = grow_bark(tree, recipe, options);
    for (const GrowthStep& step : grown.checks) {
        test::expect_sound(step);
        EXPECT_LE(static_cast<double>(step.frozen_free), 0.05 * static_cast<double>(step.vertices));
    }
    EXPECT_TRUE(grown.remarks.empty());
    return grown;
}

}  // namespace

TEST(GrowthSections, BarkComesToThem) {
    const Tree tree = test::cylinder(kWood, 1.5);
    const GrowthRecipe recipe = read_growth_recipe(tree, "edges longest=0.05\n" + fluted_line(0.0, 40));
    const GrownTree grown = grown_soundly(tree, recipe);
    std::vector<double> off;
    for (const GrownBark::Vertex& vertex : grown.bark.vertices) {
        const DVec3 p(vertex.position);
        if (p.y < 0.2 || p.y > 1.2) continue;
        off.push_back(std::abs(std::hypot(p.x, p.z) - kWood * fluted(angle_of(p))));
    }
    ASSERT_GT(off.size(), 500U);
    std::sort(off.begin(), off.end());
    EXPECT_LT(off[off.size() * 95 / 100], 0.02 * kWood);
}

TEST(GrowthSections, GoOverIntoOneAnotherAndBurlsComeOnTop) {
    const Tree tree = test::cylinder(kWood, 1.5);
    const std::string text = "edges longest=0.05\n" + fluted_line(0.2, 20) + "section along=1 radii=1,1,1\n";
    const GrownTree plain = grown_soundly(tree, read_growth_recipe(tree, text));
    for (const double radius : test::radii(plain.bark, 1.05, 1.3))
        EXPECT_NEAR(radius, kWood, 0.02 * kWood);
    const std::vector<double> half = test::radii(plain.bark, 0.57, 0.63, 0.0, 0.1);
    ASSERT_FALSE(half.empty());
    EXPECT_NEAR(half[half.size() / 2], kWood * 1.075, 0.02 * kWood);
    const GrownTree lump = grown_soundly(
        tree, read_growth_recipe(tree, text + "burl along=0.3 around=0 radius=0.15 growth=0.5 from=0.5"));
    const std::vector<double> crest = test::radii(plain.bark, 0.27, 0.33, 0.0, 0.1),
                              higher = test::radii(lump.bark, 0.27, 0.33, 0.0, 0.1);
    ASSERT_FALSE(crest.empty());
    ASSERT_FALSE(higher.empty());
    EXPECT_GT(higher.back(), crest.back() + 0.2 * kWood);
}

TEST(GrowthSections, RefuseNonsense) {
    const Tree tree = test::cylinder(kWood, 1.0);
    for (const char* text :
         {"section", "section radii=1,1", "section radii=1,nan,1", "section radii=1,0,1",
          "section radii=1,-1,1", "section radii=1,,1", "section radii=1,9,1", "section radii=1;1;1"})
        EXPECT_THROW(read_growth_recipe(tree, text), Error) << text;
    std::string many = "section radii=1";
    for (int i = 0; i < 64; i++)
        many += ",1";
    EXPECT_THROW(read_growth_recipe(tree, many), Error);
    const GrowthRecipe recipe = read_growth_recipe(tree, "section along=0.5 around=30 radii=1.5,0.8,1");
    ASSERT_EQ(recipe.sections.size(), 1U);
    EXPECT_EQ(read_growth_recipe(tree, recipe.text).sections[0].radii, (std::vector<double>{1.5, 0.8, 1.0}));
}

// Points on a fluted trunk, of which a quarter is not seen.
TEST(GrowthSections, AreFoundInScans) {
    const Tree tree = test::cylinder(kWood, 2.0);
    Random random(7);
    PointCloud cloud;
    for (int i = 0; i < 40000; i++) {
        const double angle = 0.75 * kPi * random.uniform(-1.0, 1.0);
        const double r = kWood * fluted(angle) + 0.003 * random.normal();
        cloud.positions.push_back(Vec3(r * std::cos(angle), 2.0 * random.uniform(), -r * std::sin(angle)));
    }
    const GrowthRecipe plain = read_growth_recipe(tree, "edges longest=0.04");
    const GrowthProposal proposal = propose_growth(tree, cloud, plain);
    EXPECT_EQ(proposal.burls + proposal.hollows, 0U) << proposal.recipe;
    ASSERT_GT(proposal.sections, 0U);
    const GrowthRecipe recipe = read_growth_recipe(tree, plain.text + proposal.recipe);
    for (const GrowthSection& section : recipe.sections)
        for (size_t i = 0; i < section.radii.size(); i++) {
            const double angle =
                2.0 * kPi * static_cast<double>(i) / static_cast<double>(section.radii.size());
            const double seen = std::abs(std::remainder(angle, 2.0 * kPi));
            if (seen < 0.7 * kPi) {
                EXPECT_NEAR(section.radii[i], fluted(angle), 0.03) << proposal.recipe;
            } else if (seen > 0.75 * kPi) {  // nothing is made up where nothing is seen
                EXPECT_NEAR(section.radii[i], 1.0, 0.2) << proposal.recipe;
            }
        }
    const BarkFit fit = measure_bark_fit(tree, recipe, grown_soundly(tree, recipe).bark, cloud);
    EXPECT_LT(fit.all.grown.mean, 0.4 * fit.all.tubes.mean);
    EXPECT_EQ(fit.worse, 0U);
}
