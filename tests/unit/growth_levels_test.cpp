// Lighter levels of bark that grew, and its normals where it touches itself.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "growth/blended_normals.h"
#include "growth/grow_bark.h"
#include "growth_trees.h"

using namespace treerec;

namespace {

// Every side of a triangle is another's, the other way round: once.
bool closed(const GrownBark& bark) {
    std::set<std::pair<uint32_t, uint32_t>> sides;
    for (size_t i = 0; i < bark.indices.size(); i += 3)
        for (size_t k = 0; k < 3; k++)
            if (!sides.emplace(bark.indices[i + k], bark.indices[i + (k + 1) % 3]).second) return false;
    return std::all_of(sides.begin(), sides.end(), [&](const auto& side) {
        return sides.contains({side.second, side.first});
    });
}

double volume(const GrownBark& bark) {
    double sum = 0.0;
    for (size_t i = 0; i < bark.indices.size(); i += 3) {
        DVec3 p[3];
        for (size_t k = 0; k < 3; k++)
            p[k] = DVec3(bark.vertices[bark.indices[i + k]].position);
        sum += glm::dot(p[0], glm::cross(p[1], p[2])) / 6.0;
    }
    return sum;
}

// Square metres of bare wood, and the height of its middle.
std::pair<double, double> wood(const GrownBark& bark) {
    double sum = 0.0, height = 0.0;
    for (size_t i = 0; i < bark.indices.size(); i += 3) {
        DVec3 p[3];
        bool decayed = false;
        for (size_t k = 0; k < 3; k++) {
            p[k] = DVec3(bark.vertices[bark.indices[i + k]].position);
            decayed |= bark.vertices[bark.indices[i + k]].decayed;
        }
        if (!decayed) continue;
        const double area = 0.5 * glm::length(glm::cross(p[1] - p[0], p[2] - p[0]));
        sum += area;
        height += area * (p[0].y + p[1].y + p[2].y) / 3.0;
    }
    return {sum, sum > 0.0 ? height / sum : 0.0};
}

// A trunk with a branch, a burl and a hollow.
const GrownBark& lumpy() {
    static const GrownBark bark = [] {
        Tree tree = test::cylinder(0.15, 1.6);
        NodeId side_branch = 5;
        for (int i = 1; i <= 6; i++)
            side_branch = tree.add_child(side_branch, DVec3(0.12 * i, 0.8 + 0.1 * i, 0.0), 0.07 - 0.004 * i);
        return grow_bark(tree, read_growth_recipe(tree,
                                                  "edges longest=0.045\nburl along=1.2 around=180 radius=0.2 "
                                                  "growth=0.6\nhollow along=0.5 around=90 width=0.1 "
                                                  "height=0.25"))
            .bark;
    }();
    return bark;
}

// Two upright prisms of many sides, `gap` metres apart along X.
GrownBark pair_of_stems(double gap) {
    constexpr int kSides = 24, kRows = 20;
    constexpr double kRadius = 0.1;
    GrownBark bark;
    bark.branches.resize(1);
    for (int stem = 0; stem < 2; stem++) {
        const double middle = (stem == 0 ? -1.0 : 1.0) * (kRadius + 0.5 * gap);
        const uint32_t first = static_cast<uint32_t>(bark.vertices.size());
        for (int row = 0; row < kRows; row++)
            for (int side = 0; side < kSides; side++) {
                const double turn = 2.0 * kPi * side / kSides;
                GrownBark::Vertex vertex;
                vertex.normal =
                    Vec3(static_cast<float>(std::cos(turn)), 0.0f, static_cast<float>(-std::sin(turn)));
                vertex.position = static_cast<float>(kRadius) * vertex.normal +
                                  Vec3(static_cast<float>(middle), 0.02f * static_cast<float>(row), 0.0f);
                vertex.radius = static_cast<float>(kRadius);
                bark.vertices.push_back(vertex);
            }
        for (uint32_t row = 0; row + 1 < kRows; row++)
            for (uint32_t side = 0; side < kSides; side++) {
                const uint32_t a = first + row * kSides + side,
                               b = first + row * kSides + (side + 1) % kSides;
                for (const uint32_t index : {a, b, b + kSides, a, b + kSides, a + kSides})
                    bark.indices.push_back(index);
            }
    }
    return bark;
}

}  // namespace

TEST(GrowthLevels, AreClosedAndKeepWhatTheSurfaceIs) {
    const GrownBark& bark = lumpy();
    ASSERT_EQ(bark.parents.size(), bark.vertices.size());
    size_t before = bark.indices.size() / 3;
    EXPECT_TRUE(closed(bark));
    for (double level = 0.125; level <= 12.0; level += level < 4.0 ? 0.125 : 1.0) {
        const GrownBark lighter = lighter_bark(bark, level);
        ASSERT_TRUE(closed(lighter)) << level;
        // One piece without holes, as the surface itself.
        ASSERT_EQ(lighter.indices.size() / 3, 2 * lighter.vertices.size() - 4) << level;
        ASSERT_LE(lighter.indices.size() / 3, before) << level;
        before = lighter.indices.size() / 3;
        EXPECT_GT(volume(lighter), 0.0);
        for (size_t i = 0; i < lighter.vertices.size(); i++) {
            const GrownBark::Vertex &one = lighter.vertices[i], &full = bark.vertices[i];
            ASSERT_EQ(one.along, full.along);
            ASSERT_EQ(one.around, full.around);
            ASSERT_EQ(one.branch, full.branch);
            ASSERT_EQ(one.decayed, full.decayed);
            ASSERT_NEAR(glm::length(one.normal), 1.0f, 1e-4f);
            ASSERT_LE(glm::distance(one.position, full.position), kMostSwell * full.radius + 1e-6f);
        }
    }
    for (int level = 1; level <= 2; level++) {
        const GrownBark lighter = lighter_bark(bark, level);
        const double share =
            static_cast<double>(lighter.vertices.size()) / static_cast<double>(bark.vertices.size());
        EXPECT_NEAR(share, std::pow(0.25, level), 0.02) << level;
    }
    EXPECT_LT(lighter_bark(bark, 4.0).indices.size() / 3, 200U);
}

TEST(GrowthLevels, StayNearTheSurface) {
    const GrownBark& bark = lumpy();
    const double full = volume(bark);
    const auto [area, height] = wood(bark);
    ASSERT_GT(area, 0.02);
    const struct {
        double mean, most, turn, volume, area, height;  // metres; degrees; shares; metres
    } limits[] = {{1e-6, 1e-6, 0.5, 1e-6, 1e-6, 1e-6},
                  {0.0015, 0.045, 14.0, 0.005, 0.1, 0.01},
                  {0.004, 0.06, 22.0, 0.01, 0.25, 0.03},
                  {0.02, 0.15, 35.0, 0.03, 0.75, 0.06}};
    double before = -1.0;
    for (int level = 0; level < 4; level++) {
        const LevelError error = measure_level(bark, level);
        const GrownBark lighter = lighter_bark(bark, level);
        EXPECT_EQ(error.triangles, lighter.indices.size() / 3);
        EXPECT_GE(error.mean, before);
        before = error.mean;
        EXPECT_LT(error.mean, limits[level].mean) << level;
        EXPECT_LT(error.most, limits[level].most) << level;
        EXPECT_LT(error.turn, limits[level].turn) << level;
        EXPECT_LT(std::abs(error.out), limits[level].mean) << level;
        EXPECT_NEAR(volume(lighter) / full, 1.0, limits[level].volume) << level;
        const auto [own, middle] = wood(lighter);
        EXPECT_NEAR(own / area, 1.0, limits[level].area) << level;
        EXPECT_NEAR(middle, height, limits[level].height) << level;
    }
}

TEST(GrowthLevels, ShowTheBurl) {
    const GrownBark& bark = lumpy();
    for (int level = 0; level <= 2; level++) {
        const std::vector<double> burl = test::radii(lighter_bark(bark, level), 1.1, 1.3, kPi, 0.6);
        ASSERT_FALSE(burl.empty()) << level;
        EXPECT_GT(burl.back(), 0.18) << level;
    }
}

TEST(GrowthLevels, TouchingBarkHasOneNormal) {
    const GrownBark apart = pair_of_stems(0.001);
    GrownBark bark = apart;
    growth::blend_normals(bark, 0.035);
    size_t changed = 0;
    double before = 0.0, after = 0.0, pairs = 0.0;
    for (size_t v = 0; v < bark.vertices.size(); v++) {
        const Vec3 &own = bark.vertices[v].normal, &old = apart.vertices[v].normal;
        ASSERT_NEAR(glm::length(own), 1.0f, 1e-4f);
        changed += glm::distance(own, old) > 1e-4f;
        // Off the other stem nothing changes.
        if (std::abs(apart.vertices[v].position.x) > 0.036f) {
            ASSERT_LT(glm::distance(own, old), 1e-4f);
        }
        if (v >= bark.vertices.size() / 2) continue;
        const size_t across = v + bark.vertices.size() / 2;
        // A stem's column that faces the other one's mirrored column, beside where they touch.
        const size_t side = v % 24, mirrored = across - side + (36 - side) % 24;
        if (side != 1 && side != 23) continue;
        pairs += 1.0;
        before += std::acos(std::clamp(glm::dot(old, apart.vertices[mirrored].normal), -1.0f, 1.0f));
        after += std::acos(std::clamp(glm::dot(own, bark.vertices[mirrored].normal), -1.0f, 1.0f));
    }
    EXPECT_GT(changed, 100U);
    ASSERT_GT(pairs, 30.0);
    EXPECT_GT(before / pairs, 2.0);
    EXPECT_LT(after / pairs, 0.6 * before / pairs);
    // Farther apart they are two, and bare wood stays what it is.
    GrownBark far = pair_of_stems(0.04);
    growth::blend_normals(far, 0.035);
    GrownBark bare = apart;
    for (GrownBark::Vertex& vertex : bare.vertices)
        vertex.decayed = true;
    growth::blend_normals(bare, 0.035);
    for (size_t v = 0; v < far.vertices.size(); v++) {
        ASSERT_LT(glm::distance(far.vertices[v].normal, apart.vertices[v].normal), 1e-5f);
        ASSERT_EQ(bare.vertices[v].normal, apart.vertices[v].normal);
    }
}

TEST(GrowthLevels, AreTheSameEachTime) {
    const Tree tree = test::cylinder(0.1, 0.8);
    const GrowthRecipe recipe = read_growth_recipe(tree, "edges longest=0.05");
    EXPECT_EQ(pack_grown_bark(grow_bark(tree, recipe).bark), pack_grown_bark(grow_bark(tree, recipe).bark));
}
