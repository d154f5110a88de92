// Random trees and recipes that bark grows on in tests.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "geometry/random.h"
#include "mesh/grown_bark.h"
#include "tree/tree.h"

namespace treerec::test {

// Thick or thin wood, with branches that kink, cross and touch each other, some of which fork.
struct TreeCase {
    Tree tree;
    std::string recipe;
};

inline void add_branch(Tree& tree, Random& random, NodeId from, double radius, const DVec3& direction,
                       double length, double kink, int forks) {
    const int pieces = 8;
    NodeId last = from;
    DVec3 at = tree.node(from).position, way = direction;
    for (int i = 1; i <= pieces; i++) {
        way = glm::normalize(way + kink * random.direction());
        at += way * (length / pieces);
        last = tree.add_child(last, at, std::max(radius * (1.0 - 0.07 * i), 0.002));
        if (i == pieces / 2 && forks > 0)
            add_branch(tree, random, last, 0.7 * tree.node(last).radius,
                       glm::normalize(way + 0.9 * random.direction()), 0.6 * length, kink, forks - 1);
    }
}

inline TreeCase random_setup(uint64_t seed) {
    Random random(seed);
    TreeCase setup;
    // Edges of 1 to 10 cm on wood of some edges' thickness; some much thicker, some hardly any.
    const double edge = 0.01 * std::pow(10.0, random.uniform(0.0, 1.0));
    const double radius = edge * random.uniform(0.6, 3.5);
    const double height = radius * random.uniform(8.0, 16.0);
    const double kink = random.below(3) == 0 ? 0.35 : 0.08;
    Tree& tree = setup.tree;
    std::vector<NodeId> trunk{tree.add_root(DVec3(0.0), radius, kTrunkFlag)};
    DVec3 place(0.0), way(0.0, 1.0, 0.0);
    for (int i = 1; i <= 12; i++) {
        way = glm::normalize(way + kink * random.direction() + DVec3(0.0, 0.2, 0.0));
        place += way * (height / 12.0);
        trunk.push_back(tree.add_child(trunk.back(), place, radius * (1.0 - 0.05 * i), kTrunkFlag));
    }
    const uint32_t branches = 2 + random.below(6);
    const double turn = random.uniform(0.0, 6.28);
    for (uint32_t i = 0; i < branches; i++) {
        const NodeId from = trunk[2 + random.below(9)];
        // Half of them towards the same side, so that they cross and touch.
        const double angle = i % 2 == 0 ? turn + random.uniform(-0.3, 0.3) : random.uniform(0.0, 6.28);
        const DVec3 direction =
            glm::normalize(DVec3(std::cos(angle), random.uniform(-0.4, 1.5), std::sin(angle)));
        add_branch(tree, random, from, tree.node(from).radius * random.uniform(0.4, 0.9), direction,
                   height * random.uniform(0.3, 0.7), kink, static_cast<int>(random.below(2)));
    }
    setup.recipe = "edges longest=" + std::to_string(edge) + "\n";
    for (uint32_t burls = random.below(3); burls > 0; burls--)
        setup.recipe += "burl along=" + std::to_string(height * random.uniform(0.2, 0.8)) +
                        " around=" + std::to_string(random.uniform(0.0, 360.0)) +
                        " radius=" + std::to_string(radius * random.uniform(0.5, 2.0)) +
                        " growth=" + std::to_string(random.uniform(0.2, 1.5)) + "\n";
    return setup;
}

inline bool same(const GrownBark& a, const GrownBark& b) {
    return a.indices == b.indices &&
           std::equal(a.vertices.begin(), a.vertices.end(), b.vertices.begin(), b.vertices.end(),
                      [](const GrownBark::Vertex& v, const GrownBark::Vertex& w) {
                          return v.position == w.position && v.normal == w.normal && v.along == w.along;
                      });
}

}  // namespace treerec::test
