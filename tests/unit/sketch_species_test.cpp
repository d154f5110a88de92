#include "sketch/species.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "edit/graft/scion.h"
#include "error.h"
#include "foliage/leaves.h"
#include "lsystem/lstring.h"
#include "tree/branches.h"

namespace treerec {
namespace {

constexpr double kDegrees = 180.0 / kPi;

DVec3 direction_to(const Tree& tree, NodeId id) {
    return glm::normalize(tree.node(id).position - tree.node(tree.node(id).parent).position);
}

// The shoots beside the one that goes on, at each node that has any.
struct Fork {
    DVec3 along;  // unit, of the wood below
    std::vector<NodeId> sides;
};

std::vector<Fork> forks_of(const Tree& scion) {
    std::vector<Fork> forks;
    for (NodeId id : scion.depth_first()) {
        if (scion.node(id).parent == kNoNode || scion.node(id).child_count < 2) continue;
        Fork fork{direction_to(scion, id), {}};
        NodeId onward = kNoNode;  // the straightest
        for (NodeId child : scion.children(id))
            if (onward == kNoNode || glm::dot(direction_to(scion, child), fork.along) >
                                         glm::dot(direction_to(scion, onward), fork.along))
                onward = child;
        for (NodeId child : scion.children(id))
            if (child != onward) fork.sides.push_back(child);
        forks.push_back(fork);
    }
    return forks;
}

// The angle between two shoots as seen along the wood that bears them, degrees.
double angle_around(const Tree& scion, const Fork& fork, NodeId one, NodeId other) {
    const auto flat = [&](NodeId id) {
        const DVec3 way = direction_to(scion, id);
        return glm::normalize(way - fork.along * glm::dot(way, fork.along));
    };
    return std::acos(std::clamp(glm::dot(flat(one), flat(other)), -1.0, 1.0)) * kDegrees;
}

// Standing out of a bare pole, as in a crown nine metres above the ground, rising at 35 degrees.
Tree on_a_pole(const Tree& scion) {
    Tree tree = read_lstring("!(.06)F(9)");
    const NodeId tip = tree.depth_first().back();
    place_scion(tree, tip, scion, {turn_about({1.0, 0.0, 0.0}, 55.0 / kDegrees), 1.0});
    return tree;
}

TEST(SketchSpecies, AreFourAndAnotherIsRefusedWithTheirNames) {
    EXPECT_EQ(sketch_species_names(), (std::vector<std::string>{"ginkgo", "magnolia", "maple", "poplar"}));
    for (const std::string& name : sketch_species_names()) {
        const SketchSpecies& species = sketch_species(name);
        EXPECT_EQ(species.name, name);
        EXPECT_EQ(&sketch_species(name), &species);
        EXPECT_TRUE(leaf_preset(name).enabled);
        EXPECT_GE(species.height, 5.0);
        EXPECT_LE(species.height, 30.0);
    }
    EXPECT_EQ(sketch_species("ginkgo").arrangement, TwigArrangement::kAlternate);
    EXPECT_EQ(sketch_species("poplar").arrangement, TwigArrangement::kAlternate);
    EXPECT_EQ(sketch_species("maple").arrangement, TwigArrangement::kOpposite);
    EXPECT_EQ(sketch_species("magnolia").arrangement, TwigArrangement::kClustered);
    try {
        sketch_species("plastic");
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("'plastic'"), std::string::npos);
        EXPECT_NE(std::string(error.what()).find("ginkgo, magnolia, maple, poplar"), std::string::npos);
    }
}

// Centimetres, Ma and Liu 2020, table 1; a radius that would make a twig stouter than the next longer one is
// that of the other's slenderness, and so is the size's that the table does not have.
TEST(SketchSpecies, HaveTheTablesLengthsAndRadii) {
    struct Row {
        double length, radius;
    };
    const std::map<std::string, std::vector<Row>> table = {
        {"maple", {{110.0, 3.0 * 110.0 / 355.0}, {199.0, 3.0 * 199.0 / 355.0}, {355.0, 3.0}}},
        {"ginkgo", {{133.0, 3.0 * 133.0 / 323.0}, {240.0, 3.0 * 240.0 / 323.0}, {323.0, 3.0}}},
        {"poplar", {{78.0, 1.0}, {113.0, 113.0 / 78.0}, {203.0, 203.0 / 78.0}}},
        {"magnolia", {{89.0, 89.0 / 120.0}, {120.0, 1.0}, {215.0, 215.0 / 120.0}}}};
    constexpr const char* kSizes[] = {"_short", "_medium", "_long"};
    for (const auto& [name, rows] : table) {
        const SketchSpecies& species = sketch_species(name);
        ASSERT_EQ(species.twigs.size(), 3u);
        for (size_t i = 0; i < 3; i++) {
            const SpeciesTwig& twig = species.twigs[i];
            EXPECT_EQ(twig.name, name + kSizes[i]);
            EXPECT_NEAR(twig.length / (0.01 * rows[i].length), 1.0, 0.02) << twig.name;
            EXPECT_NEAR(twig.radius / (0.01 * rows[i].radius), 1.0, 0.02) << twig.name;
            EXPECT_EQ(twig.length, scion_length(twig.scion));
            EXPECT_EQ(twig.radius, twig.scion.node(twig.scion.root()).radius);
            // Scaled by .7 to 1.3 they leave no length out from the shortest to the longest.
            if (i > 0) {
                EXPECT_LT(0.7 * twig.length, 1.3 * species.twigs[i - 1].length) << twig.name;
            }
        }
    }
}

TEST(SketchSpecies, AreScionsOfFewNodes) {
    constexpr size_t kMost[] = {30, 70, 140};
    for (const std::string& name : sketch_species_names()) {
        for (size_t i = 0; i < 3; i++) {
            const SpeciesTwig& twig = sketch_species(name).twigs[i];
            const Tree& scion = twig.scion;
            ASSERT_EQ(scion.check(), std::nullopt) << twig.name;
            EXPECT_LE(scion.size(), kMost[i]) << twig.name;
            EXPECT_GE(scion.size(), 2 * kMost[i] / 3) << twig.name;
            EXPECT_GT(scion_direction(scion).y, 0.95) << twig.name;
            for (NodeId id : scion.depth_first()) {
                const Node& node = scion.node(id);
                EXPECT_GE(node.radius, 0.002) << twig.name;
                if (node.parent == kNoNode) continue;
                EXPECT_LE(node.radius, scion.node(node.parent).radius) << twig.name << " " << id;
            }
            // It spreads to all sides of its own way, and its longest path is the one that goes on.
            const Bounds box = scion.bounds();
            EXPECT_GT(box.size().x, 0.3 * twig.length) << twig.name;
            EXPECT_GT(box.size().z, 0.3 * twig.length) << twig.name;
            EXPECT_GT(box.max.y, 0.85 * twig.length) << twig.name;
            EXPECT_GT(box.min.y, -0.05 * twig.length) << twig.name;
        }
    }
}

TEST(SketchSpecies, MaplesShootsStandInPairsSquareToTheLast) {
    for (const SpeciesTwig& twig : sketch_species("maple").twigs) {
        const std::vector<Fork> forks = forks_of(twig.scion);
        EXPECT_GE(forks.size(), 4u) << twig.name;
        for (const Fork& fork : forks) {
            ASSERT_EQ(fork.sides.size(), 2u) << twig.name;
            EXPECT_GT(angle_around(twig.scion, fork, fork.sides[0], fork.sides[1]), 165.0) << twig.name;
        }
    }
}

TEST(SketchSpecies, GinkgosAndPoplarsStandOneByOne) {
    for (const char* name : {"ginkgo", "poplar"})
        for (const SpeciesTwig& twig : sketch_species(name).twigs) {
            const std::vector<Fork> forks = forks_of(twig.scion);
            EXPECT_GE(forks.size(), 6u) << twig.name;
            for (const Fork& fork : forks)
                EXPECT_EQ(fork.sides.size(), 1u) << twig.name;
        }
}

TEST(SketchSpecies, MagnoliasShootsStandInClusters) {
    for (const SpeciesTwig& twig : sketch_species("magnolia").twigs) {
        const std::vector<Fork> forks = forks_of(twig.scion);
        EXPECT_GE(forks.size(), 3u) << twig.name;
        for (const Fork& fork : forks) {
            // What ends in a cluster has nothing that goes on beside them.
            ASSERT_GE(fork.sides.size(), 2u) << twig.name;
            for (size_t i = 0; i < fork.sides.size(); i++)
                for (size_t j = 0; j < i; j++)
                    EXPECT_GT(angle_around(twig.scion, fork, fork.sides[i], fork.sides[j]), 40.0)
                        << twig.name;
        }
    }
}

// The share of tips that are a single segment of less than 8 cm.
double share_of_short_shoots(const Tree& scion) {
    double tips = 0.0, spurs = 0.0;
    for (NodeId id : scion.depth_first()) {
        if (scion.node(id).child_count > 0) continue;
        const NodeId parent = scion.node(id).parent;
        tips++;
        spurs += glm::distance(scion.node(id).position, scion.node(parent).position) < 0.08;
    }
    return spurs / tips;
}

// Mean degrees between the twig and the straight way to the ends of the shoots that leave its main branch.
double mean_spread(const Tree& scion) {
    const BranchList list = list_branches(scion);
    double sum = 0.0, count = 0.0;
    for (const Branch& branch : list.branches) {
        if (branch.order != 1) continue;
        const DVec3 way =
            scion.node(list.nodes_of(branch).back()).position - scion.node(branch.attach).position;
        sum += std::acos(std::clamp(glm::normalize(way).y, -1.0, 1.0)) * kDegrees;
        count++;
    }
    return sum / count;
}

TEST(SketchSpecies, EachGrowsInItsOwnWay) {
    for (size_t i = 0; i < 3; i++) {
        const auto scion = [&](const char* name) -> const Tree& {
            return sketch_species(name).twigs[i].scion;
        };
        EXPECT_GT(share_of_short_shoots(scion("ginkgo")), 0.35) << i;
        for (const char* other : {"maple", "poplar", "magnolia"})
            EXPECT_LT(share_of_short_shoots(scion(other)), 0.15) << other << i;
        // A poplar sweeps up.
        EXPECT_LT(mean_spread(scion("poplar")) + 5.0, mean_spread(scion("ginkgo"))) << i;
        EXPECT_LT(mean_spread(scion("poplar")), 43.0) << i;
    }
}

// Leaves hide the wood: but for the base of the twig there is one within a leaf's length of every part of it.
TEST(SketchSpecies, LeavesStandAllOverThem) {
    for (const std::string& name : sketch_species_names()) {
        const SketchSpecies& species = sketch_species(name);
        for (const SpeciesTwig& twig : species.twigs) {
            const Tree tree = on_a_pole(twig.scion);
            const std::vector<LeafPlacement> leaves = place_leaves(tree, leaf_preset(name), 1);
            const DVec3 base(0.0, 9.0, 0.0);
            double wood = 0.0, hidden = 0.0;
            for (NodeId id : tree.depth_first()) {
                const Node& node = tree.node(id);
                if (node.parent == kNoNode || node.position.y <= 9.0 + 1e-6) continue;
                const DVec3 before = tree.node(node.parent).position;
                const DVec3 middle = 0.5 * (before + node.position);
                if (glm::distance(middle, base) < 0.3 * twig.length) continue;
                double nearest = 1e9;
                for (const LeafPlacement& leaf : leaves)
                    nearest = std::min(nearest, glm::distance(DVec3(leaf.position), middle));
                wood += glm::distance(before, node.position);
                if (nearest < leaf_preset(name).leaf_size) hidden += glm::distance(before, node.position);
            }
            EXPECT_GT(hidden, 0.85 * wood) << twig.name << ": " << hidden / wood;
            // One-sided area of the cards over that of a round crown as wide as the twig's wood.
            double area = 0.0;
            for (const LeafPlacement& leaf : leaves)
                area += 0.4 * leaf.size * leaf.size;
            const DVec3 size = twig.scion.bounds().size();
            EXPECT_GT(area, 0.8 * 0.25 * kPi * size.y * size.x) << twig.name;
            EXPECT_GT(leaves.size(), twig.scion.size()) << twig.name;
        }
    }
}

}  // namespace
}  // namespace treerec
