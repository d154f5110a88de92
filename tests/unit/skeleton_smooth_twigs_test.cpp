// Twigs as smooth as wood grows.
#include "skeleton/twigs/smooth_twigs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "geometry/random.h"
#include "random_tree.h"

namespace treerec::test {
namespace {

constexpr double kStep = 0.02;
constexpr double kNoise = 0.006;

struct Twig {
    Tree tree;
    std::vector<NodeId> nodes;

    const DVec3& at(size_t i) const { return tree.node(nodes[i]).position; }
};

// On an arc of half a metre, whose nodes noise has moved; it starts on a stem.
Twig noisy_twig(double noise, uint64_t seed, const std::map<int, uint8_t>& flags = {}) {
    Random random(seed);
    Twig twig;
    NodeId at = twig.tree.add_root({0, 0, 0}, 0.02, kTrunkFlag);
    twig.tree.add_child(at, {0, 0.5, 0}, 0.02, kTrunkFlag);
    for (int i = 1; i <= 30; i++) {
        const double turn = kStep * i / 0.5;
        const DVec3 off = noise * DVec3(random.normal(), random.normal(), random.normal());
        at = twig.tree.add_child(at, DVec3(0.5 * std::sin(turn), 0.5 * (1.0 - std::cos(turn)), 0.0) + off,
                                 0.003, flags.contains(i - 1) ? flags.at(i - 1) : 0);
        twig.nodes.push_back(at);
    }
    return twig;
}

double off_arc(const Twig& twig) {
    double sum = 0.0;
    for (size_t i = 0; i < twig.nodes.size(); i++) {
        const DVec3 p = twig.at(i) - DVec3(0.0, 0.5, 0.0);
        const double out = std::hypot(p.x, p.y) - 0.5;
        sum += out * out + p.z * p.z;
    }
    return std::sqrt(sum / static_cast<double>(twig.nodes.size()));
}

double sharpest(const Twig& twig) {
    double most = 0.0;
    for (size_t i = 1; i + 1 < twig.nodes.size(); i++) {
        const DVec3 in = glm::normalize(twig.at(i) - twig.at(i - 1));
        const DVec3 out = glm::normalize(twig.at(i + 1) - twig.at(i));
        most = std::max(most, glm::degrees(std::acos(std::clamp(glm::dot(in, out), -1.0, 1.0))));
    }
    return most;
}

TEST(SmoothTwigs, NoiseGoesAndTheArcStays) {
    for (uint64_t seed = 1; seed <= 5; seed++) {
        Twig twig = noisy_twig(kNoise, seed);
        const double before = off_arc(twig);
        ASSERT_GT(sharpest(twig), 40.0);
        smooth_twigs(twig.tree);
        EXPECT_LT(off_arc(twig), 0.7 * before) << seed;
        EXPECT_LT(sharpest(twig), 25.0) << seed;
    }
}

TEST(SmoothTwigs, WhatIsMeasuredOrStoutAndEndsOfGapsStay) {
    Twig twig = noisy_twig(kNoise, 7, {{5, kMeasuredRadiusFlag}, {20, kGuessFlag}});
    twig.tree.set_radius(twig.nodes[9], 0.02);
    const Twig before = twig;
    smooth_twigs(twig.tree);
    for (const size_t i : {5, 9, 19, 20})
        EXPECT_EQ(twig.at(i), before.at(i)) << i;
    EXPECT_GT(glm::distance(twig.at(14), before.at(14)), 1e-4);
    EXPECT_EQ(twig.tree.node(twig.tree.root()).position, DVec3(0.0));
}

TEST(SmoothTwigs, BranchesGoOnFromWhereTheirParentsHaveCome) {
    Twig twig = noisy_twig(kNoise, 8);
    NodeId at = twig.nodes[10];
    std::vector<NodeId> side;
    for (int i = 1; i <= 8; i++) {
        at = twig.tree.add_child(at, twig.at(10) + DVec3(0.0, 0.0, 0.02 * i), 0.002);
        side.push_back(at);
    }
    smooth_twigs(twig.tree);
    // No kink between the fork and the first two nodes.
    const auto place = [&](NodeId id) { return twig.tree.node(id).position; };
    const DVec3 in = glm::normalize(place(side[0]) - twig.at(10));
    const DVec3 out = glm::normalize(place(side[1]) - place(side[0]));
    EXPECT_GT(glm::dot(in, out), std::cos(glm::radians(30.0)));
}

// A seedling's twigs are as crooked over its height.
TEST(SmoothTwigs, SizeDoesNotMatter) {
    Twig usual = noisy_twig(kNoise, 3), small = usual;
    small.tree.scale(0.1);
    smooth_twigs(usual.tree);
    smooth_twigs(small.tree, 10.0);
    for (size_t i = 0; i < usual.nodes.size(); i++)
        EXPECT_LT(glm::distance(usual.at(i), 10.0 * small.at(i)), 1e-9) << i;
}

TEST(SmoothTwigs, AnyTreeStaysATree) {
    for (uint64_t seed = 1; seed <= 20; seed++) {
        Tree tree = random_tree(seed, 400);
        const size_t size = tree.size();
        smooth_twigs(tree);
        EXPECT_EQ(tree.check(), std::nullopt) << seed;
        EXPECT_EQ(tree.size(), size);
    }
    Tree none;
    smooth_twigs(none);
    EXPECT_TRUE(none.empty());
}

}  // namespace
}  // namespace treerec::test
