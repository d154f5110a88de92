// Grafting: what changes, what stays, where the scion goes, how thick it is.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "edit/graft/graft.h"
#include "edit/graft/scion.h"
#include "error.h"
#include "lsystem/lstring.h"
#include "random_tree.h"

namespace treerec {
namespace {

NodeId some_node(const Tree& tree, Random& random) {
    const std::vector<NodeId> all = tree.depth_first();
    return all[random.below(static_cast<uint32_t>(all.size()))];
}

bool same_bits(double a, double b) {
    return std::memcmp(&a, &b, sizeof(a)) == 0;
}

bool same_bits(const Tree& a, const Tree& b) {
    const std::vector<NodeId> ids = a.depth_first();
    if (ids != b.depth_first()) return false;
    return std::all_of(ids.begin(), ids.end(), [&](NodeId id) {
        const Node& p = a.node(id);
        const Node& q = b.node(id);
        return same_bits(p.position.x, q.position.x) && same_bits(p.position.y, q.position.y) &&
               same_bits(p.position.z, q.position.z) && same_bits(p.radius, q.radius) && p.flags == q.flags &&
               p.parent == q.parent;
    });
}

GraftOptions random_options(Random& random) {
    GraftOptions options;
    options.seed = random.next();
    if (random.below(3)) options.variation = {random.uniform(0.0, 60.0), random.uniform(0.0, 0.5)};
    options.aim = static_cast<GraftAim>(random.below(5));
    options.lean = random.uniform(0.0, 180.0);
    options.direction = random.direction();
    options.roll = random.uniform(-360.0, 360.0);
    options.mirror = random.below(2) == 0;
    options.scale = static_cast<GraftScale>(random.below(5));
    options.length = random.uniform(0.05, 3.0);
    options.factor = std::pow(10.0, random.uniform(-1.0, 1.0));
    options.joint_ratio = random.below(2) ? random.uniform(0.01, 1.0) : 0.0;
    options.smooth = random.below(4) != 0;
    options.clearance = random.below(2) ? 0.0 : 0.02;
    options.tries = 1 + static_cast<int>(random.below(4));
    return options;
}

TEST(EditGraft, NeverChangesWhatStood) {
    for (uint64_t seed = 0; seed < 1500; seed++) {
        Random random(seed);
        const int count = 2 + static_cast<int>(random.below(120));
        Tree tree = seed % 3 ? test::random_tree(seed, count) : test::wild_tree(seed, count);
        const Tree other = seed % 2 ? test::random_tree(seed + 7, 60) : test::wild_tree(seed + 7, 60);
        const Tree scion = take_scion(other, some_node(other, random));
        const NodeId host = some_node(tree, random);
        GraftOptions options = random_options(random);
        // A wild scion may have no length to scale.
        if (scion_length(scion) == 0.0) options.scale = GraftScale::kFit;
        Tree before = tree;
        const GraftResult result = graft(tree, host, scion, options);
        ASSERT_EQ(tree.check(), std::nullopt) << seed;
        ASSERT_EQ(result.added.size() + 1, scion.size());
        ASSERT_EQ(tree.size(), before.size() + result.added.size());
        if (options.smooth) {
            for (NodeId id : result.added)
                EXPECT_LE(tree.node(id).radius, tree.node(tree.node(id).parent).radius) << seed;
        }
        // Again from the same start: the same bytes.
        Tree again = before;
        EXPECT_EQ(graft(again, host, scion, options).seed, result.seed);
        ASSERT_TRUE(same_bits(again, tree)) << seed;
        // Without what was added it is as before, to the bit.
        for (NodeId child : std::vector<NodeId>(result.added)) {
            if (tree.contains(child) && tree.node(child).parent == host) tree.remove_subtree(child);
        }
        ASSERT_TRUE(same_bits(before, tree)) << seed;
    }
}

TEST(EditGraft, BackAtItsJointIsTheSame) {
    int thick = 0;
    for (uint64_t seed = 0; seed < 600; seed++) {
        Random random(seed);
        const bool wild = seed % 2 == 0;
        const Tree tree = wild ? test::wild_tree(seed, 80) : test::random_tree(seed, 80);
        const NodeId child = some_node(tree, random);
        const NodeId joint = tree.node(child).parent;
        if (joint == kNoNode) continue;
        const Tree scion = take_scion(tree, child);
        Tree cut = tree;
        const std::vector<NodeId> removed = cut.remove_subtree(child);
        GraftOptions options;
        options.aim = GraftAim::kOwn;
        options.scale = GraftScale::kFactor;
        options.joint_ratio = 1.0;
        options.smooth = !wild;  // wild trees thicken outward, which smoothing forbids
        const GraftResult result = graft(cut, joint, scion, options);
        ASSERT_EQ(result.added.size(), removed.size());
        const double size = tree.bounds().diagonal();
        for (size_t i = 0; i < removed.size(); i++) {
            const Node& a = tree.node(removed[i]);
            const Node& b = cut.node(result.added[i]);
            ASSERT_LE(glm::distance(a.position, b.position), 1e-9 * size) << seed;
            thick += std::abs(a.radius - b.radius) > 1e-9 * a.radius;
        }
    }
    // A branch that was cut off a joint is a tip's: the joint's own thickness goes on into it there.
    EXPECT_LE(thick, 0);
}

TEST(EditGraft, GoesOnFromATip) {
    for (uint64_t seed = 0; seed < 200; seed++) {
        Random random(seed);
        Tree tree = test::random_tree(seed, 100);
        const std::vector<NodeId> tips = tree.nodes_of_kind(NodeKind::kLeaf);
        const NodeId tip = tips[random.below(static_cast<uint32_t>(tips.size()))];
        const DVec3 forward = direction_at(tree, tip);
        const Tree scion = take_scion(test::random_tree(seed + 1, 100), 1);
        GraftOptions options;
        options.seed = seed;
        options.variation = {25.0, 0.3};
        const GraftResult result = graft(tree, tip, scion, options);
        const DVec3 first = tree.node(result.added[0]).position - tree.node(tip).position;
        // The scion's own first segment may lean a little off its direction.
        const DVec3 own = scion.node(*scion.children(scion.root()).begin()).position;
        const double lean = std::acos(std::min(1.0, glm::dot(glm::normalize(own), scion_direction(scion))));
        EXPECT_LE(std::acos(std::min(1.0, glm::dot(glm::normalize(first), forward))), lean + 1e-6) << seed;
        EXPECT_NEAR(result.scale * scion.node(scion.root()).radius, tree.node(tip).radius, 1e-12);
    }
}

TEST(EditGraft, GoesWhereItIsTold) {
    for (uint64_t seed = 0; seed < 100; seed++) {
        Random random(seed);
        Tree tree = test::random_tree(seed, 60);
        Tree scion;
        scion.add_root({0, 0, 0}, 0.01);
        scion.add_child(0, random.direction() * 0.3, 0.01);
        const NodeId host = some_node(tree, random);
        const NodeId tip = 1;
        GraftOptions options;
        options.aim = GraftAim::kDirection;
        options.direction = random.direction() * 3.0;
        options.scale = GraftScale::kLength;
        options.length = 0.7;
        options.roll = 50.0;
        const DVec3 at = tree.node(host).position;
        const GraftResult to = graft(tree, host, scion, options);
        EXPECT_LT(glm::distance(tree.node(to.added[tip - 1]).position,
                                at + 0.7 * glm::normalize(options.direction)),
                  1e-9);
        options.aim = GraftAim::kLean;
        options.lean = 30.0;
        const DVec3 forward = direction_at(tree, host);
        const GraftResult leant = graft(tree, host, scion, options);
        const DVec3 way = glm::normalize(tree.node(leant.added[0]).position - at);
        EXPECT_NEAR(std::acos(glm::dot(way, forward)) * 180.0 / kPi, 30.0, 1e-5);
    }
}

TEST(EditGraft, RollsAndMirrors) {
    Tree tree;
    tree.add_root({0, 0, 0}, 0.1);
    const NodeId host = tree.add_child(0, {0, 1, 0}, 0.1);
    tree.add_child(host, {0, 2, 0}, 0.1);
    Tree scion;
    scion.add_root({0, 0, 0}, 0.02);
    scion.add_child(0, {0.1, 0.2, 0.3}, 0.02);
    const auto place = [&](double roll, bool mirror) {
        Tree copy = tree;
        GraftOptions options;
        options.aim = GraftAim::kOwn;
        options.roll = roll;
        options.mirror = mirror;
        return copy.node(graft(copy, host, scion, options).added[0]).position - DVec3(0, 1, 0);
    };
    // On an upright stem the scion's axes are the tree's.
    EXPECT_LT(glm::distance(place(0, false), DVec3(0.1, 0.2, 0.3)), 1e-12);
    EXPECT_LT(glm::distance(place(0, true), DVec3(-0.1, 0.2, 0.3)), 1e-12);
    EXPECT_LT(glm::distance(place(90, false), DVec3(0.3, 0.2, -0.1)), 1e-12);
    EXPECT_LT(glm::distance(place(180, true), DVec3(0.1, 0.2, -0.3)), 1e-12);
    EXPECT_LT(glm::distance(place(-360, false), DVec3(0.1, 0.2, 0.3)), 1e-12);
}

TEST(EditGraft, LeansIntoTheWidestGap) {
    Tree tree;
    tree.add_root({0, 0, 0}, 0.1);
    const NodeId host = tree.add_child(0, {0, 1, 0}, 0.1);
    tree.add_child(host, {0, 2, 0}, 0.1);
    tree.add_child(host, {1, 1.5, 0.1}, 0.05);
    tree.add_child(host, {0.1, 1.5, 1}, 0.05);
    Tree scion;
    scion.add_root({0, 0, 0}, 0.02);
    scion.add_child(0, {0, 1, 0}, 0.01);
    const GraftResult result = graft(tree, host, scion, {});
    const DVec3 way = glm::normalize(tree.node(result.added[0]).position - DVec3(0, 1, 0));
    EXPECT_NEAR(way.y, std::sqrt(0.5), 1e-9);
    EXPECT_NEAR(way.x, -0.5, 1e-9);
    EXPECT_NEAR(way.z, -0.5, 1e-9);
    EXPECT_TRUE(result.collisions.empty());
}

TEST(EditGraft, ScalesAsAsked) {
    const Tree scion = take_scion(test::random_tree(3, 200), 1);
    const double root = scion.node(scion.root()).radius;
    Tree tree;
    tree.add_root({0, 0, 0}, 0.5 * root);
    const NodeId thin = tree.add_child(0, {0, 1, 0}, 0.5 * root);
    tree.add_child(thin, {0, 2, 0}, 0.5 * root);
    const auto scale_at = [&](NodeId host, GraftScale scale, double value) {
        Tree copy = tree;
        GraftOptions options;
        options.scale = scale;
        options.length = options.factor = value;
        return graft(copy, host, scion, options).scale;
    };
    EXPECT_NEAR(scale_at(thin, GraftScale::kFit, 1), 0.4, 1e-12);
    EXPECT_NEAR(scale_at(thin, GraftScale::kRadius, 1), 0.4, 1e-12);
    EXPECT_NEAR(scale_at(2, GraftScale::kAuto, 1), 0.5, 1e-12);
    EXPECT_NEAR(scale_at(thin, GraftScale::kFactor, 3), 3.0, 1e-12);
    EXPECT_NEAR(scale_at(thin, GraftScale::kLength, 2.5), 2.5 / scion_length(scion), 1e-12);
    for (NodeId id = 0; id < 3; id++)
        tree.set_radius(id, 4.0 * root);
    EXPECT_NEAR(scale_at(thin, GraftScale::kFit, 1), 1.0, 1e-12);
    EXPECT_NEAR(scale_at(thin, GraftScale::kRadius, 1), 3.2, 1e-12);
}

TEST(EditGraft, BlendsIntoAStouterTip) {
    Tree wood;
    wood.add_root({0, 0, 0}, 0.01);
    for (int i = 1; i <= 40; i++)
        wood.add_child(i - 1, {0, 0.1 * i, 0}, 0.01 - 0.0001 * i);
    const NodeId side = wood.add_child(2, {0.3, 0.2, 0}, 0.004);
    const Tree before = wood;
    smooth_joint(wood, 0.05, 1.0, true);
    EXPECT_DOUBLE_EQ(wood.node(0).radius, 0.05);
    double steepest = 0.0;
    for (int i = 1; i <= 40; i++) {
        EXPECT_LE(wood.node(i).radius, wood.node(i - 1).radius);
        EXPECT_GE(wood.node(i).radius, before.node(i).radius - 1e-15);
        steepest = std::max(steepest, wood.node(i - 1).radius - wood.node(i).radius);
    }
    EXPECT_LT(steepest, 0.02);                              // no step at the joint
    EXPECT_EQ(wood.node(5).radius, before.node(5).radius);  // the blend has ended: 8 host radii
    EXPECT_EQ(wood.node(side).radius, before.node(side).radius);
    // Too thick for its host, all of it thins alike.
    Tree thinned = before;
    smooth_joint(thinned, 0.005, 0.8, true);
    for (NodeId id : before.depth_first())
        EXPECT_NEAR(thinned.node(id).radius, 0.4 * before.node(id).radius, 1e-15);
}

TEST(EditGraft, VariationIsSeededAndBounded) {
    const Tree scion = take_scion(test::random_tree(9, 150), 1);
    EXPECT_TRUE(same_bits(vary_scion(scion, {}, 5), scion));
    EXPECT_TRUE(same_bits(vary_scion(scion, {20, 0.2}, 5), vary_scion(scion, {20, 0.2}, 5)));
    EXPECT_FALSE(same_bits(vary_scion(scion, {20, 0.2}, 5), vary_scion(scion, {20, 0.2}, 6)));
    for (uint64_t seed = 0; seed < 200; seed++) {
        const Tree length = vary_scion(scion, {0, 0.3}, seed);
        const Tree angle = vary_scion(scion, {10, 0}, seed);
        ASSERT_EQ(angle.check(), std::nullopt);
        for (NodeId id : scion.depth_first()) {
            const NodeId parent = scion.node(id).parent;
            if (parent == kNoNode) continue;
            const DVec3 was = scion.node(id).position - scion.node(parent).position;
            const DVec3 longer = length.node(id).position - length.node(parent).position;
            const DVec3 turned = angle.node(id).position - angle.node(parent).position;
            EXPECT_LT(glm::length(glm::cross(was, longer)), 1e-9);
            EXPECT_LE(glm::length(longer), 1.3 * glm::length(was) + 1e-12);
            EXPECT_GE(glm::length(longer), 0.7 * glm::length(was) - 1e-12);
            EXPECT_NEAR(glm::length(turned), glm::length(was), 1e-9);
            EXPECT_EQ(angle.node(id).radius, scion.node(id).radius);
        }
        const NodeId first = *scion.children(scion.root()).begin();
        EXPECT_LT(glm::distance(angle.node(first).position, scion.node(first).position), 1e-9);
    }
}

TEST(EditGraft, VariationOfABranchStaysSmooth) {
    // A finely divided branch bends in an arc, and never in a kink.
    Tree scion;
    scion.add_root({0, 0, 0}, 0.01);
    for (int i = 1; i <= 200; i++)
        scion.add_child(i - 1, {0, 0.01 * i, 0}, 0.01);
    double most = 0.0;
    for (uint64_t seed = 0; seed < 100; seed++) {
        const Tree varied = vary_scion(scion, {40, 0.0}, seed);
        for (NodeId i = 2; i <= 200; i++) {
            const DVec3 a = varied.node(i - 1).position - varied.node(i - 2).position;
            const DVec3 b = varied.node(i).position - varied.node(i - 1).position;
            EXPECT_LT(glm::length(glm::cross(a, b)) / (glm::length(a) * glm::length(b)), 0.04);
        }
        most = std::max(most, glm::distance(varied.node(200).position, scion.node(200).position));
    }
    EXPECT_GT(most, 0.3);
}

TEST(EditGraft, ManyAtOnceOrNone) {
    const Tree start = test::random_tree(21, 200);
    std::vector<NodeId> tips = start.nodes_of_kind(NodeKind::kLeaf);
    const std::vector<Tree> scions{take_scion(test::random_tree(1, 30), 1),
                                   take_scion(test::random_tree(2, 40), 1)};
    GraftOptions options;
    options.variation = {15, 0.2};
    Tree tree = start;
    const std::vector<GraftResult> results = graft_many(tree, tips, scions, options);
    ASSERT_EQ(results.size(), tips.size());
    EXPECT_EQ(tree.check(), std::nullopt);
    std::array<int, 2> used{0, 0};
    for (size_t i = 0; i < tips.size(); i++) {
        EXPECT_EQ(results[i].host, tips[i]);
        used[results[i].added.size() + 1 == scions[0].size() ? 0 : 1]++;
    }
    EXPECT_GT(used[0], 0);
    EXPECT_GT(used[1], 0);
    Tree again = start;
    graft_many(again, tips, scions, options);
    EXPECT_TRUE(same_bits(again, tree));
    // One host is wrong: nothing happens.
    tips.push_back(99999);
    Tree none = start;
    EXPECT_THROW(graft_many(none, tips, scions, options), Error);
    tips.pop_back();
    EXPECT_THROW(graft_many(none, tips, std::vector<Tree>(), options), Error);
    options.most_nodes = 10;
    EXPECT_THROW(graft_many(none, tips, scions, options), Error);
    EXPECT_TRUE(same_bits(none, start));
    EXPECT_EQ(none.id_end(), start.id_end());
}

TEST(EditGraft, ATreeOntoItself) {
    Tree tree = test::random_tree(4, 50);
    const size_t size = tree.size();
    EXPECT_EQ(graft(tree, tree.nodes_of_kind(NodeKind::kLeaf)[0], tree, {}).added.size(), size - 1);
    EXPECT_EQ(tree.check(), std::nullopt);
}

TEST(EditGraft, StandsAbsurdSizes) {
    int grafted = 0;
    for (uint64_t seed = 0; seed < 200; seed++) {
        Random random(seed);
        Tree scion;
        const auto size = [&] { return std::pow(10.0, random.uniform(-200.0, 200.0)); };
        scion.add_root({0, 0, 0}, size());
        for (NodeId i = 0; i < 10; i++)
            scion.add_child(static_cast<NodeId>(random.below(static_cast<uint32_t>(i + 1))),
                            random.direction() * size(), size());
        Tree tree = seed % 2 ? test::random_tree(seed, 30) : scion;
        const Tree before = tree;
        const GraftOptions options = random_options(random);
        try {
            graft(tree, some_node(tree, random), scion, options);
            ASSERT_EQ(tree.check(), std::nullopt);
            grafted++;
        } catch (const Error&) {
            ASSERT_TRUE(same_bits(tree, before));
        }
    }
    EXPECT_GT(grafted, 25);
}

TEST(EditGraft, RefusesWhatMakesNoSense) {
    Tree tree = test::random_tree(4, 50);
    const Tree start = tree;
    const Tree scion = take_scion(tree, 1);
    const auto refuses = [&](auto change) {
        GraftOptions options;
        change(options);
        EXPECT_THROW(graft(tree, 3, scion, options), Error);
    };
    refuses([](GraftOptions& o) { o.variation.angle = -1; });
    refuses([](GraftOptions& o) { o.variation.length = 1; });
    refuses([](GraftOptions& o) { o.variation.length = NAN; });
    refuses([](GraftOptions& o) { o.lean = 181; });
    refuses([](GraftOptions& o) { o.roll = INFINITY; });
    refuses([](GraftOptions& o) { o.length = 0; });
    refuses([](GraftOptions& o) { o.factor = -1; });
    refuses([](GraftOptions& o) { o.joint_ratio = 2; });
    refuses([](GraftOptions& o) { o.clearance = -1; });
    refuses([](GraftOptions& o) { o.tries = 0; });
    refuses([](GraftOptions& o) { o.tries = 1001; });
    refuses([](GraftOptions& o) {
        o.aim = GraftAim::kDirection;
        o.direction = DVec3(0.0);
    });
    refuses([](GraftOptions& o) {
        o.scale = GraftScale::kFactor;
        o.factor = 1e308;
    });
    EXPECT_THROW(graft(tree, 1000, scion, {}), Error);
    EXPECT_THROW(graft(tree, 3, Tree(), {}), Error);
    EXPECT_TRUE(same_bits(tree, start));
    class Stop : public Progress {
        bool cancelled() const override { return true; }
    };
    const Stop stop;
    EXPECT_THROW(graft(tree, 3, scion, {}, &stop), Cancelled);
    EXPECT_TRUE(same_bits(tree, start));
}

// The scion written as algorithm 4 does and read as algorithm 6 does.
TEST(EditGraft, SegmentsVaryAsInAlgorithm6) {
    for (uint64_t seed = 1; seed <= 200; seed++) {
        Random random(seed);
        const Tree tree = test::random_tree(seed, 80);
        const Tree scion = take_scion(tree, some_node(tree, random));
        LStringOptions options;
        options.dialect = LStringDialect::kPaper;
        options.accuracy = 1e-11;
        const std::string string = write_lstring(scion, scion.root(), options);
        options.angle_spread = random.uniform(0.0, 40.0);
        options.length_spread = random.uniform(0.0, 0.9);
        options.seed = random.next();
        const Tree read = read_lstring(string, options);
        const Tree varied =
            vary_scion(scion, {options.angle_spread, options.length_spread, true}, options.seed);
        ASSERT_EQ(varied.check(), std::nullopt);
        const std::vector<NodeId> in_read = read.depth_first(), in_varied = varied.depth_first();
        ASSERT_EQ(in_read.size(), in_varied.size());
        for (size_t i = 0; i < in_read.size(); i++) {
            ASSERT_LT(glm::distance(read.node(in_read[i]).position, varied.node(in_varied[i]).position), 1e-7)
                << "seed " << seed;
            ASSERT_TRUE(same_bits(varied.node(in_varied[i]).radius, scion.node(in_varied[i]).radius));
        }
    }
}

TEST(EditGraft, RadiiFallByDepthAsInAlgorithm8) {
    for (uint64_t seed = 1; seed <= 300; seed++) {
        Random random(seed);
        Tree tree = seed % 2 ? test::random_tree(seed, 60) : test::wild_tree(seed, 60);
        const Tree scion = take_scion(test::random_tree(seed + 1000, 60), 0);
        GraftOptions options = random_options(random);
        options.thinning = seed % 5 ? random.uniform(0.05, 1.0) : 0.8;
        const NodeId host = some_node(tree, random);
        const Node before = tree.node(host);
        const GraftResult result = graft(tree, host, scion, options);
        ASSERT_EQ(tree.check(), std::nullopt);
        EXPECT_TRUE(same_bits(tree.node(host).radius, before.radius));
        for (const NodeId id : result.added) {
            const double printed =
                before.radius * std::pow(options.thinning, tree.node(id).depth - before.depth);
            ASSERT_NEAR(tree.node(id).radius, std::max(printed, 1e-9), 1e-12 * before.radius)
                << "seed " << seed;
        }
    }
    Tree wood = test::random_tree(1, 20);
    GraftOptions options;
    options.thinning = 1.5;
    EXPECT_THROW(graft(wood, 0, take_scion(wood, 0), options), Error);
}

// A branch that is refused costs nothing: it is never varied, nor tried against what stands.
TEST(EditGraft, RefusesTooManyNodesFirst) {
    Tree tree = test::random_tree(1, 50);
    const Tree scion = take_scion(test::random_tree(2, 40), 0);
    GraftOptions options;
    options.most_nodes = scion.size() - 2;
    const Tree before = tree;
    try {
        graft(tree, 3, scion, options);
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("or allow more"), std::string::npos) << error.what();
    }
    EXPECT_TRUE(same_bits(tree, before));
    options.most_nodes = scion.size() - 1;
    EXPECT_EQ(graft(tree, 3, scion, options).added.size(), scion.size() - 1);
}

}  // namespace
}  // namespace treerec
