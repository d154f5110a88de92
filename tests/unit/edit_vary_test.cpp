// New individuals made from a tree's own branches.
#include "edit/vary/vary.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <set>
#include <thread>

#include "edit/delta.h"
#include "error.h"
#include "geometry/portable_trig.h"
#include "geometry/random.h"
#include "pipeline/reconstruct.h"
#include "random_tree.h"
#include "synth/grow.h"
#include "tree/branches.h"
#include "tree/measure.h"

namespace treerec {
namespace {

namespace fs = std::filesystem;

double lowest(const Tree& tree) {
    double least = 1e300;
    for (const NodeId id : tree.depth_first())
        least = std::min(least, tree.node(id).position.y);
    return least;
}

// Nodes by what their bytes say.
uint64_t digest(const Tree& tree) {
    uint64_t hash = 1;
    const auto add = [&](double value) {
        uint64_t bits = 0;
        std::memcpy(&bits, &value, sizeof bits);
        hash = hash_seed(hash, bits);
    };
    for (const NodeId id : tree.depth_first()) {
        const Node& node = tree.node(id);
        for (int axis = 0; axis < 3; axis++)
            add(node.position[axis]);
        add(node.radius);
        hash = hash_seed(hash, static_cast<uint64_t>(node.parent + 1) * 8 + node.flags);
    }
    return hash;
}

// What every variant of any tree must be.
void expect_sound(const Tree& tree, const Tree& variant) {
    ASSERT_EQ(variant.check().value_or("sound"), "sound");
    EXPECT_GE(lowest(variant), lowest(tree));
    EXPECT_EQ(variant.frame(), tree.frame());
    const Node& root = variant.node(variant.root());
    EXPECT_EQ(root.position, tree.node(tree.root()).position);
    size_t trunk = 0, wanted = 0;
    for (const NodeId id : variant.depth_first()) {
        trunk += variant.node(id).is_trunk();
        EXPECT_EQ(variant.node(id).flags & ~kTrunkFlag, 0);
    }
    for (const NodeId id : tree.depth_first())
        wanted += tree.node(id).is_trunk();
    EXPECT_EQ(trunk, wanted);
}

// Of the same kind: sizes stay near those of the tree.
void expect_alike(const Tree& tree, const Tree& variant) {
    const Measurements a = measure(tree), b = measure(variant);
    EXPECT_NEAR(b.height / a.height, 1.0, 0.25);
    EXPECT_NEAR(b.total_length / a.total_length, 1.0, 0.35);
    EXPECT_NEAR(static_cast<double>(b.nodes) / static_cast<double>(a.nodes), 1.0, 0.25);
    if (a.crown_radius > 0.05 * a.height) {
        EXPECT_GT(b.crown_radius, 0.6 * a.crown_radius);
        EXPECT_LT(b.crown_radius, 1.6 * a.crown_radius);
    }
    if (a.dbh > 0.0 && b.dbh > 0.0) {
        EXPECT_NEAR(b.dbh / a.dbh, 1.0, 0.35);
    }
    // The trunk's line, where there is one trunk.
    const auto top = [](const Tree& of) {
        DVec3 at = of.node(of.root()).position;
        for (const NodeId id : of.depth_first())
            if (of.node(id).is_trunk()) at = of.node(id).position;
        return at;
    };
    EXPECT_LT(glm::distance(top(tree), top(variant)), 0.3 * a.height);
}

// Angles with the parent by order of branches; least and most, a tail of 2 % left out at each side.
struct Angles {
    double least = 0.0, most = 0.0;
    size_t count = 0;
};
Angles angles_of(const Tree& tree, int order) {
    const BranchList list = list_branches(tree);
    std::vector<double> angles;
    for (const Branch& branch : list.branches) {
        if (branch.order != order || tree.node(branch.attach).parent == kNoNode) continue;
        const DVec3 base = tree.node(branch.attach).position;
        const DVec3 axis = base - tree.node(tree.node(branch.attach).parent).position;
        const auto nodes = list.nodes_of(branch);
        const DVec3 way = tree.node(nodes[nodes.size() / 2]).position - base;
        if (glm::length(way) == 0.0 || glm::length(axis) == 0.0) continue;
        angles.push_back(
            std::acos(std::clamp(glm::dot(glm::normalize(axis), glm::normalize(way)), -1.0, 1.0)) * 180.0 /
            kPi);
    }
    std::sort(angles.begin(), angles.end());
    if (angles.empty()) return {};
    const size_t tail = angles.size() / 50;
    return {angles[tail], angles[angles.size() - 1 - tail], angles.size()};
}

TEST(PortableTrig, AgreesWithTheLibrarys) {
    Random random(1);
    for (int i = 0; i < 100000; i++) {
        const double x = random.uniform(-40.0, 40.0);
        const SineCosine got = portable_sine_cosine(x);
        ASSERT_NEAR(got.sine, std::sin(x), 2e-15) << x;
        ASSERT_NEAR(got.cosine, std::cos(x), 2e-15) << x;
    }
    EXPECT_EQ(portable_sine_cosine(0.0).sine, 0.0);
    EXPECT_EQ(portable_sine_cosine(0.0).cosine, 1.0);
}

TEST(Vary, NoneIsTheSameTreeBitForBit) {
    for (uint64_t seed = 1; seed <= 20; seed++) {
        Tree tree = test::random_tree(seed, 300);
        // With holes among its ids.
        tree.remove_subtree(tree.nodes_of_kind(NodeKind::kLeaf)[3]);
        EXPECT_TRUE(identical(VariantMaker(tree).make(seed, 0.0).tree, tree));
    }
}

TEST(Vary, SoundOnTreesThatGrowAndOnAnyOther) {
    for (uint64_t seed = 1; seed <= 300; seed++) {
        SCOPED_TRACE(seed);
        Random random(seed);
        const int nodes = 2 + static_cast<int>(random.below(400));
        const Tree tree = seed % 3 ? test::random_tree(seed, nodes) : test::wild_tree(seed, nodes);
        const VariantMaker maker(tree);
        for (int i = 0; i < 4; i++) {
            const double amount = i == 0 ? 1.0 : random.uniform(1e-6, 1.0);
            const Tree variant = maker.make(random.next(), amount).tree;
            expect_sound(tree, variant);
            if (::testing::Test::HasFatalFailure()) return;
        }
    }
    EXPECT_TRUE(VariantMaker(Tree()).make(1, 1.0).tree.empty());
    Tree root;
    root.add_root({1, 2, 3}, 0.1);
    EXPECT_TRUE(identical(VariantMaker(root).make(1, 1.0).tree, root));
    for (const double amount : {-0.1, 1.1, std::nan("")})
        EXPECT_THROW(VariantMaker(root).make(1, amount), Error);
}

TEST(Vary, SeedsMakeIndividualsAndTheSameSeedTheSameOne) {
    const Tree tree = grow_tree({Habit::kBroadleaf, 8.0, 5});
    const VariantMaker maker(tree);
    std::set<uint64_t> all;
    for (uint64_t seed = 0; seed < 40; seed++) {
        const uint64_t one = digest(maker.make(seed, 0.7).tree);
        EXPECT_TRUE(all.insert(one).second) << "seed " << seed;
        EXPECT_EQ(digest(VariantMaker(tree).make(seed, 0.7).tree), one);
    }
    // From several threads at once.
    std::vector<uint64_t> found(40);
    std::vector<std::thread> threads;
    for (size_t k = 0; k < 4; k++)
        threads.emplace_back([&, k] {
            for (size_t seed = k; seed < found.size(); seed += 4)
                found[seed] = digest(maker.make(seed, 0.7).tree);
        });
    for (std::thread& thread : threads)
        thread.join();
    EXPECT_EQ(std::set<uint64_t>(found.begin(), found.end()), all);
}

// A tree of numbers that every platform reads alike; the digest was made on one and must hold on all.
TEST(Vary, TheSameBytesOnEveryPlatform) {
    Random random(9);
    Tree tree;
    std::vector<NodeId> ids{tree.add_root({0, 0, 0}, 0.125)};
    for (int i = 1; i < 300; i++) {
        const NodeId parent =
            i < 12 ? ids.back()
                   : ids[static_cast<size_t>(i / 3 + random.below(static_cast<uint32_t>(i / 2)))];
        const DVec3 step(random.uniform(-0.25, 0.25), random.uniform(0.0, 0.5), random.uniform(-0.25, 0.25));
        ids.push_back(tree.add_child(parent, tree.node(parent).position + step,
                                     tree.node(parent).radius * 0.9375, i < 12 ? kTrunkFlag : 0));
    }
    EXPECT_EQ(digest(tree), 706767941315135280u);
    EXPECT_EQ(digest(VariantMaker(tree).make(77, 0.5).tree), 18162438640939535871u);
    EXPECT_EQ(digest(VariantMaker(tree).make(77, 0.5, 0.4).tree), 11807420802011341074u);
}

TEST(Vary, MoreIsFartherFromTheTree) {
    const Tree tree = grow_tree({Habit::kBroadleaf, 8.0, 4});
    const VariantMaker maker(tree);
    double before = 0.0;
    for (const double amount : {0.001, 0.1, 0.5, 1.0}) {
        double sum = 0.0;
        for (uint64_t seed = 1; seed <= 8; seed++) {
            const Tree variant = maker.make(seed, amount).tree;
            for (const NodeId id : variant.depth_first()) {
                double least = 1e300;
                for (NodeId other = 0; other < tree.id_end(); other += 3)
                    if (tree.contains(other))
                        least = std::min(least,
                                         glm::distance(tree.node(other).position, variant.node(id).position));
                sum += least / static_cast<double>(variant.size());
            }
        }
        EXPECT_GT(sum, before) << amount;
        before = sum;
    }
}

TEST(Vary, GrownTreesStayOfTheirKind) {
    for (const Habit habit : {Habit::kBroadleaf, Habit::kConifer, Habit::kPalm}) {
        for (uint64_t seed = 1; seed <= 4; seed++) {
            SCOPED_TRACE(static_cast<int>(habit) * 100 + static_cast<int>(seed));
            const Tree tree = grow_tree({habit, 0.0, seed});
            const VariantMaker maker(tree);
            for (uint64_t k = 1; k <= 6; k++) {
                const Tree variant = maker.make(k, 1.0).tree;
                expect_sound(tree, variant);
                expect_alike(tree, variant);
                for (int order = 1; order <= 3; order++) {
                    const Angles a = angles_of(tree, order), b = angles_of(variant, order);
                    if (a.count < 20) continue;
                    EXPECT_GT(b.least, a.least - 15.0) << "order " << order;
                    EXPECT_LT(b.most, a.most + 15.0) << "order " << order;
                }
            }
        }
    }
}

TEST(Vary, LeavesThatTheScanSawGoWithTheirWood) {
    const Tree tree = grow_tree({Habit::kBroadleaf, 8.0, 6});
    std::vector<Vec3> points;
    std::vector<std::array<uint8_t, 3>> colors;
    Random random(3);
    for (const NodeId id : tree.nodes_of_kind(NodeKind::kLeaf))
        for (int i = 0; i < 40; i++) {
            points.emplace_back(tree.node(id).position + 0.25 * random.direction() * random.uniform());
            colors.push_back({60, static_cast<uint8_t>(100 + random.below(60)), 40});
        }
    const Foliage foliage = gather_foliage(points, colors);
    const VariantMaker maker(tree, foliage);
    EXPECT_EQ(maker.make(1, 0.0).foliage, foliage);
    const auto count = [](const Foliage& of) {
        double sum = 0.0;
        for (const FoliageCell& cell : of.cells)
            sum += cell.points;
        return sum;
    };
    // Without motion worth a cell all stay where they are.
    const Foliage still = maker.make(1, 1e-9).foliage;
    EXPECT_NEAR(count(still), count(foliage), 0.02 * count(foliage));
    for (uint64_t seed = 1; seed <= 10; seed++) {
        const TreeVariant variant = maker.make(seed, 1.0);
        EXPECT_NO_THROW(check_foliage(variant.foliage));
        EXPECT_EQ(variant.foliage.edge, foliage.edge);
        EXPECT_TRUE(variant.foliage.colored);
        EXPECT_NEAR(count(variant.foliage) / count(foliage), 1.0, 0.35);
        // Near a tip, as in the tree.
        size_t far = 0;
        for (const FoliageCell& cell : variant.foliage.cells) {
            double least = 1e300;
            for (const NodeId id : variant.tree.depth_first())
                least = std::min(least,
                                 glm::distance(variant.tree.node(id).position, variant.foliage.centre(cell)));
            far += least > 0.45;
        }
        EXPECT_LT(far, variant.foliage.cells.size() / 20);
        EXPECT_EQ(maker.make(seed, 1.0).foliage, variant.foliage);
    }
}

TEST(Vary, FoliageOnTreesOfAnyShape) {
    for (uint64_t seed = 1; seed <= 60; seed++) {
        SCOPED_TRACE(seed);
        Random random(seed);
        const Tree tree = seed % 2 ? test::wild_tree(seed, 2 + static_cast<int>(random.below(60)))
                                   : test::random_tree(seed, 100);
        std::vector<Vec3> points;
        const DVec3 middle = tree.bounds().centre();
        const double reach = std::pow(10.0, random.uniform(-2.0, 2.0));
        for (uint32_t i = 1 + random.below(300); i > 0; i--)
            points.emplace_back(middle + reach * random.uniform() * random.direction());
        const VariantMaker maker(tree, gather_foliage(points, {}));
        for (const double amount : {1e-9, 0.5, 1.0}) {
            const TreeVariant variant = maker.make(seed, amount);
            EXPECT_NO_THROW(check_foliage(variant.foliage));
            EXPECT_LE(variant.foliage.cells.size(), points.size());
        }
    }
}

TEST(VaryOnScans, VariantsStayOfTheirKind) {
    const char* scans = std::getenv("TREEREC_SCANS");
    if (!scans) GTEST_SKIP() << "TREEREC_SCANS does not name the folder of scans";
    int seen = 0;
    for (const char* name :
         {"adtree_tree7.xyz", "adtree_Lille_11_leafoff_tall.xyz", "archi_tree2_leafoff.las",
          "wytham_Tf18_birch.txt", "vezy_A1B2.asc", "rtls_leafy_urban.txt", "ryu_Tree3_Maple_rgb_Yup.xyz"}) {
        const fs::path file = fs::path(scans) / "clouds" / name;
        if (!fs::exists(file)) continue;
        seen++;
        const Reconstruction made = reconstruct_file(file.string(), {});
        const VariantMaker maker(made.tree, made.foliage);
        for (uint64_t seed = 1; seed <= 8; seed++) {
            SCOPED_TRACE(std::string(name) + " " + std::to_string(seed));
            const TreeVariant variant = maker.make(seed, 1.0);
            expect_sound(made.tree, variant.tree);
            expect_alike(made.tree, variant.tree);
            EXPECT_EQ(variant.foliage.empty(), made.foliage.empty());
        }
    }
    if (seen == 0) GTEST_SKIP() << "there are no scans in " << scans;
}

}  // namespace
}  // namespace treerec
