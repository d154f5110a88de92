#include "foliage/leaf_area_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "geometry/parallel.h"
#include "geometry/random.h"

namespace treerec {
namespace {

LeafPlacement leaf_at(const DVec3& middle, double size) {
    LeafPlacement leaf;
    leaf.x = {1.0f, 0.0f, 0.0f};
    leaf.y = {0.0f, 1.0f, 0.0f};
    leaf.z = {0.0f, 0.0f, 1.0f};
    leaf.outward = {0.0f, 1.0f, 0.0f};
    leaf.size = static_cast<float>(size);
    leaf.position = Vec3(middle - DVec3(0.0, 0.5 * size, 0.0));
    return leaf;
}

std::vector<LeafPlacement> ball(double radius, int count) {
    Random random(4);
    std::vector<LeafPlacement> leaves;
    while (static_cast<int>(leaves.size()) < count) {
        const DVec3 p(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0));
        if (glm::length(p) < 1.0) leaves.push_back(leaf_at(p * radius, 0.1));
    }
    return leaves;
}

TEST(LeafAreaGrid, HoldsTheAreaOfAllLeaves) {
    std::vector<LeafPlacement> leaves = ball(2.0, 20000);
    const LeafAreaGrid grid({{&leaves, 0.5}});
    double area = 0.0;
    const double step = 0.1;
    for (double x = -4.0; x < 4.0; x += step)
        for (double y = -4.0; y < 4.0; y += step)
            for (double z = -4.0; z < 4.0; z += step)
                area += grid.density({x, y, z}) * step * step * step;
    EXPECT_NEAR(area, 20000 * 0.5 * 0.01, 2.0);
}

TEST(LeafAreaGrid, ABallFacesOutwardsAndIsDarkWithin) {
    std::vector<LeafPlacement> leaves = ball(2.0, 20000);
    const LeafAreaGrid grid({{&leaves, 0.5}});
    for (int i = 0; i < 12; i++) {
        const double turn = 2.0 * kPi * i / 12.0;
        const DVec3 way(0.8 * std::cos(turn), i % 2 ? 0.6 : -0.6, 0.8 * std::sin(turn));
        const DVec3 out = grid.outward(1.9 * way);
        EXPECT_GT(glm::length(out), 0.3);
        EXPECT_GT(glm::dot(glm::normalize(out), way), 0.95) << i;
    }
    EXPECT_LT(glm::length(grid.outward(DVec3(0.0))), 0.15);
    EXPECT_GT(grid.sky({0.0, 2.0, 0.0}), 1.5 * grid.sky({1.8, 0.0, 0.0}));
    EXPECT_GT(grid.sky({1.8, 0.0, 0.0}), 1.5 * grid.sky(DVec3(0.0)));
    EXPECT_GT(grid.sky({1.8, 0.0, 0.0}), grid.sky({0.0, -1.8, 0.0}));
}

// Under a layer without end, a ray at height angle a meets L / sin a.
TEST(LeafAreaGrid, ALayerLetsThroughWhatBeersLawSays) {
    const double across = 30.0, deep = 1.2, index = 1.0;
    Random random(7);
    std::vector<LeafPlacement> leaves;
    for (int i = 0; i < 60000; i++)
        leaves.push_back(leaf_at({random.uniform(-0.5, 0.5) * across, 10.0 + random.uniform(0.0, deep),
                                  random.uniform(-0.5, 0.5) * across},
                                 0.1));
    const double area = index * across * across / (60000 * 0.01);
    const LeafAreaGrid grid({{&leaves, area}});
    double wanted = 0.0;
    for (int i = 0; i < 1000; i++)
        wanted += std::exp(-0.5 * index / ((i + 0.5) / 1000.0)) / 1000.0;
    EXPECT_NEAR(grid.sky({0.0, 10.0, 0.0}), wanted, 0.05);
}

bool same(const std::vector<LeafPlacement>& a, const std::vector<LeafPlacement>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](const LeafPlacement& one, const LeafPlacement& other) {
                          return one.outward == other.outward && one.occlusion == other.occlusion;
                      });
}

TEST(LeafAreaGrid, NeitherOrderNorThreadsMatter) {
    std::vector<LeafPlacement> leaves = ball(2.0, 3000);
    std::vector<LeafPlacement> turned(leaves.rbegin(), leaves.rend());
    set_thread_count(1);
    light_leaves({{&leaves, 0.5}});
    set_thread_count(3);
    light_leaves({{&turned, 0.5}});
    set_thread_count(0);
    std::reverse(turned.begin(), turned.end());
    EXPECT_TRUE(same(leaves, turned));
}

TEST(LeafAreaGrid, WhatIsPrunedChangesTheLightNearItAlone) {
    std::vector<LeafPlacement> both = ball(3.0, 2000);
    std::vector<LeafPlacement> pruned = both;
    // A bough to the side: no ray from it or to it gets far, but up.
    for (int i = 0; i < 200; i++)
        both.push_back(leaf_at({30.0 + 0.01 * i, 0.0, 0.0}, 0.1));
    std::vector<LeafPlacement> near = pruned;
    for (int i = 0; i < 200; i++)
        near.push_back(leaf_at({0.0, 3.2, 0.01 * i - 1.0}, 0.3));
    for (std::vector<LeafPlacement>* leaves : {&both, &pruned, &near})
        light_leaves({{leaves, 0.5}});
    double far_change = 0.0, near_change = 0.0;
    for (size_t i = 0; i < pruned.size(); i++) {
        far_change = std::max<double>(far_change, std::abs(both[i].occlusion - pruned[i].occlusion));
        near_change = std::max<double>(near_change, std::abs(near[i].occlusion - pruned[i].occlusion));
        EXPECT_LT(glm::length(both[i].outward - pruned[i].outward), 1e-5f);
    }
    EXPECT_LT(far_change, 0.02);
    EXPECT_GT(near_change, 0.05);
}

TEST(LeafAreaGrid, EveryKindOfLeafShadesEveryOther) {
    std::vector<LeafPlacement> roof, below = ball(1.0, 500), alone = below;
    for (int x = -30; x <= 30; x++)
        for (int z = -30; z <= 30; z++)
            roof.push_back(leaf_at({0.2 * x, 3.0, 0.2 * z}, 0.3));
    light_leaves({{&alone, 0.5}});
    light_leaves({{&below, 0.5}, {&roof, 1.0}});
    for (size_t i = 0; i < below.size(); i++)
        ASSERT_LT(below[i].occlusion, alone[i].occlusion);
}

}  // namespace
}  // namespace treerec
