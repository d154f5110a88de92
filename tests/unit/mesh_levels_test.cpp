// Levels of detail: cheaper and cheaper, of one outline, one wind, one box.
#include "mesh/levels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <set>

#include "error.h"
#include "foliage/crown.h"
#include "geometry/parallel.h"
#include "mesh/leaf_cards.h"
#include "mesh/twig_shares.h"
#include "random_tree.h"
#include "synth/grow.h"

namespace treerec {
namespace {

template <typename T>
bool same(const T& a, const T& b) {
    return a.size() == b.size() &&
           (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0);
}

Tree grown(Habit habit, uint64_t seed = 1) {
    GrowOptions options;
    options.habit = habit;
    options.seed = seed;
    return grow_tree(options);
}

// What covers a picture: the area of all bark as seen from the side, on average, between two heights: from
// the ground on, which hides the rest.
double bark_area(const Mesh& mesh, double from = 0.0, double to = 1e9) {
    double sum = 0.0;
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const DVec3 a(mesh.positions[mesh.indices[i]]);
        const DVec3 b(mesh.positions[mesh.indices[i + 1]]), c(mesh.positions[mesh.indices[i + 2]]);
        const double middle = (a.y + b.y + c.y) / 3.0;
        if (middle >= from && middle < to) sum += 0.5 * glm::length(glm::cross(b - a, c - a));
    }
    return sum;
}

TEST(Levels, EachHasFarFewerTrianglesAndAllAreFinite) {
    for (const Habit habit : all_habits()) {
        const Tree tree = grown(habit);
        const LevelBuilder builder(tree, leaf_preset("generic"), 3);
        size_t before = SIZE_MAX;
        for (int level = 0; level < kMostLevels; level++) {
            SCOPED_TRACE(habit_name(habit) + " " + std::to_string(level));
            const TreeLevel made = builder.build(level);
            EXPECT_EQ(made.level, level);
            EXPECT_TRUE(made.warning.empty());
            EXPECT_GT(made.bark.triangle_count(), 0u);
            EXPECT_FALSE(made.foliage[0].leaves.empty());
            if (level > 0) {
                // A palm's few fronds leave little to save at last.
                EXPECT_LT(made.triangle_count(), habit == Habit::kPalm ? before : before * 6 / 10);
            }
            before = made.triangle_count();
            for (size_t i = 0; i < made.bark.positions.size(); i++) {
                ASSERT_TRUE(std::isfinite(glm::length(made.bark.positions[i])));
                ASSERT_NEAR(glm::length(made.bark.normals[i]), 1.0f, 1e-3f);
                ASSERT_TRUE(std::abs(made.bark.radii[i]) > 0.0f);
            }
            for (const LeafPlacement& leaf : made.foliage[0].leaves)
                ASSERT_TRUE(std::isfinite(glm::length(leaf.position)) && leaf.size > 0.0f);
        }
    }
}

TEST(Levels, TheFinestIsTheTreeItself) {
    const Tree tree = grown(Habit::kBroadleaf);
    const LeafRules rules = leaf_preset("oak");
    const TreeLevel made = LevelBuilder(tree, rules, 5).build(0);
    EXPECT_TRUE(same(made.bark.positions, build_level_bark(tree, 0.0).positions));
    EXPECT_TRUE(same(leaf_buffer(made.foliage[0].leaves), leaf_buffer(place_leaves(tree, rules, 5))));
}

TEST(Levels, OneBoxHoldsAllOfThem) {
    for (const Habit habit : all_habits())
        for (uint64_t seed = 1; seed < 4; seed++) {
            const Tree tree = grown(habit, seed);
            const LevelBuilder builder(tree, leaf_preset(seed == 2 ? "palm" : "maple"), seed);
            const Bounds box = builder.box();
            for (int level = 0; level < kMostLevels; level++) {
                SCOPED_TRACE(habit_name(habit) + " " + std::to_string(level));
                const TreeLevel made = builder.build(level);
                const auto inside = [&](const Vec3& p) {
                    const DVec3 q(p);
                    return glm::all(glm::greaterThanEqual(q, box.min)) &&
                           glm::all(glm::lessThanEqual(q, box.max));
                };
                EXPECT_TRUE(std::all_of(made.bark.positions.begin(), made.bark.positions.end(), inside));
                const Mesh leaves = bake_leaves(made.foliage[0].leaves, made.foliage[0].card);
                EXPECT_TRUE(std::all_of(leaves.positions.begin(), leaves.positions.end(), inside));
            }
        }
}

// Bare trees must not thin out as they go away, nor their crowns, where the thinnest wood is.
TEST(Levels, BarkCoversAsMuchAsBefore) {
    for (const Habit habit : {Habit::kBroadleaf, Habit::kBirch, Habit::kConifer})
        for (uint64_t seed = 2; seed < 5; seed++) {
            const Tree tree = grown(habit, seed);
            const Mesh finest = build_level_bark(tree, 0.0);
            const Crown crown = measure_crown(tree);
            for (int level = 1; level < 4; level++) {
                SCOPED_TRACE(habit_name(habit) + " " + std::to_string(seed) + " " + std::to_string(level));
                const Mesh mesh = build_level_bark(tree, level);
                EXPECT_NEAR(bark_area(mesh) / bark_area(finest), 1.05, 0.1);
                EXPECT_NEAR(bark_area(mesh, crown.centre.y) / bark_area(finest, crown.centre.y), 1.05, 0.25);
            }
        }
}

TEST(Levels, WindChannelsAreThoseOfTheFinest) {
    const Tree tree = grown(Habit::kBroadleaf, 4);
    const Mesh fine = build_level_bark(tree, 0.0);
    const auto less = [](const Vec4& a, const Vec4& b) { return std::memcmp(&a, &b, sizeof a) < 0; };
    // A branch's pivot may move where its parent has fewer rings; its phase and its order are its own.
    std::set<Vec4, decltype(less)> branches(less);
    for (size_t i = 0; i < fine.positions.size(); i++)
        branches.insert({fine.colors[i].b, fine.custom0[i].w, 0.0f, 0.0f});
    const Crown crown = measure_crown(tree);
    for (int level = 1; level < kMostLevels; level++) {
        const Mesh mesh = build_level_bark(tree, level);
        for (size_t i = 0; i < mesh.positions.size(); i++) {
            ASSERT_TRUE(branches.count({mesh.colors[i].b, mesh.custom0[i].w, 0.0f, 0.0f})) << level;
            ASSERT_NEAR(mesh.colors[i].r, crown.sway(DVec3(mesh.positions[i])), 0.2) << level;
        }
    }
}

TEST(Levels, TwigsOfACoarserLevelAreThoseOfTheFiner) {
    for (uint64_t seed = 1; seed < 6; seed++) {
        const Tree tree = test::random_tree(seed, 4000);
        const BranchList list = list_branches(tree);
        const Crown crown = measure_crown(tree);
        std::vector<float> finer = share_twigs(tree, list, crown, 0.0);
        EXPECT_EQ(std::count(finer.begin(), finer.end(), 1.0f), static_cast<long>(finer.size()));
        for (double level = 0.5; level < 9.0; level += 0.5) {
            const std::vector<float> shares = share_twigs(tree, list, crown, level);
            for (size_t i = 0; i < shares.size(); i++) {
                if (shares[i] == 0.0f) continue;
                ASSERT_GE(shares[i], 1.0f);
                ASSERT_GT(finer[i], 0.0f) << "A twig came back.";
                const int32_t parent = list.branches[i].parent;
                ASSERT_TRUE(parent < 0 || shares[static_cast<size_t>(parent)] > 0.0f)
                    << "It stands on nothing.";
            }
            finer = shares;
        }
        EXPECT_GT(finer[0], 0.0f);
    }
}

TEST(Levels, BudgetsAreMetAndUsed) {
    for (const Habit habit : {Habit::kBroadleaf, Habit::kConifer, Habit::kPalm}) {
        const Tree tree = grown(habit, 3);
        const LevelBuilder builder(tree, leaf_preset("generic"), 1);
        const size_t full = builder.build(0).triangle_count();
        for (const size_t budget : {full / 2, full / 10, size_t{2000}, size_t{500}}) {
            const TreeLevel made = builder.build(2, budget);
            SCOPED_TRACE(habit_name(habit) + " " + std::to_string(budget));
            EXPECT_LE(made.triangle_count(), budget);
            EXPECT_TRUE(made.warning.empty());
            // Sides are whole numbers, so the budget is not spent to the last triangle.
            EXPECT_GT(made.triangle_count(), habit == Habit::kPalm ? budget / 4 : budget / 2);
        }
        EXPECT_EQ(builder.build(3, full).triangle_count(), full);
        EXPECT_EQ(builder.build(3, 10 * full).level, 0.0);
    }
}

TEST(Levels, NoneHasMoreByItselfThanAGameAffords) {
    const Tree tree = test::random_tree(2, 8000, 18.0);
    LeafRules rules = leaf_preset("oak");
    rules.leaf_area_index = 12.0;
    const LevelBuilder builder(tree, rules, 1);
    const size_t most[] = {60000, 12903, 2774, 596};
    for (int level = 0; level < 4; level++) {
        SCOPED_TRACE(level);
        const size_t count = builder.build(level).triangle_count();
        EXPECT_LE(count, most[level]);
        EXPECT_GT(count, most[level] / 2);
        const Mesh bare = build_level_bark(tree, level),
                   whole = build_level_bark(tree, level, {.limited = false});
        EXPECT_LE(bare.triangle_count(), most[level]);
        EXPECT_GT(bare.triangle_count(), most[level] * 4 / 5);
        EXPECT_GT(whole.triangle_count(), bare.triangle_count() * 3 / 2);
    }
    // A budget lifts that.
    EXPECT_GT(builder.build(0, 1000000).triangle_count(), 100000u);
}

TEST(Levels, BarkHasWhatLeavesLeaveOfALevel) {
    const Tree tree = test::random_tree(2, 8000, 18.0);
    LeafRules rules = leaf_preset("oak");
    size_t before = SIZE_MAX;
    for (const double area : {0.4, 1.5, 12.0, 60.0}) {
        SCOPED_TRACE(area);
        rules.leaf_area_index = area;
        const TreeLevel made = LevelBuilder(tree, rules, 1).build(0);
        EXPECT_LE(made.triangle_count(), level_triangles(0));
        EXPECT_GT(made.triangle_count(), level_triangles(0) * 9 / 10);
        // Never less than its own share.
        const size_t bark = made.bark.triangle_count();
        EXPECT_GT(bark, (level_triangles(0) - foliage_triangles(0)) * 9 / 10);
        EXPECT_LE(bark, before);
        before = bark;
    }
}

TEST(Levels, ABudgetThatCannotBeKeptSaysSo) {
    const Tree tree = grown(Habit::kBroadleaf);
    const TreeLevel made = LevelBuilder(tree, leaf_preset("generic"), 1).build(1, 2);
    EXPECT_GT(made.triangle_count(), 2u);
    EXPECT_LT(made.triangle_count(), 400u);
    EXPECT_NE(made.warning.find("2 triangles"), std::string::npos) << made.warning;
}

TEST(Levels, ThreadsDoNotMatterAndNothingIsNothing) {
    const Tree tree = grown(Habit::kBroadleaf, 7);
    const LevelBuilder builder(tree, leaf_preset("birch"), 2);
    set_thread_count(1);
    const TreeLevel one = builder.build(1, 9000);
    set_thread_count(3);
    const TreeLevel three = builder.build(1, 9000);
    set_thread_count(0);
    EXPECT_TRUE(same(one.bark.positions, three.bark.positions));
    EXPECT_TRUE(same(one.bark.indices, three.bark.indices));
    EXPECT_TRUE(same(leaf_buffer(one.foliage[0].leaves), leaf_buffer(three.foliage[0].leaves)));
    const Tree empty;
    const LevelBuilder none(empty, leaf_preset("birch"), 2);
    EXPECT_EQ(none.build(2).triangle_count(), 0u);
    EXPECT_EQ(none.build(2, 100).triangle_count(), 0u);
    EXPECT_TRUE(none.box().empty());
    EXPECT_THROW(none.build(-1), Error);
}

TEST(Levels, CanBeCancelled) {
    const Tree tree = grown(Habit::kBroadleaf);
    const LevelBuilder builder(tree, leaf_preset("birch"), 2);
    struct Impatient : Progress {
        mutable std::atomic<int> checks = 0;
        bool cancelled() const override { return ++checks > 3; }
    } progress;
    EXPECT_THROW(builder.build(1, 1000, &progress), Cancelled);
}

}  // namespace
}  // namespace treerec
