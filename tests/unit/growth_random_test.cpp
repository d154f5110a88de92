// Bark on trees of every kind, judged by CGAL, and what must come out the same (src/growth).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "cases.h"
#include "file_bytes.h"
#include "geometry/parallel.h"
#include "geometry/random.h"
#include "growth/grow_bark.h"
#include "growth_trees.h"

using namespace treerec;
using test::cylinder;
using test::expect_sound;
using test::radii;

namespace {

// Thick or thin wood, with branches that kink, cross and touch each other, some of which fork.
struct TreeCase {
    Tree tree;
    std::string recipe;
};

void add_branch(Tree& tree, Random& random, NodeId from, double radius, const DVec3& direction, double length,
                double kink, int forks) {
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

TreeCase random_setup(uint64_t seed) {
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

bool same(const GrownBark& a, const GrownBark& b) {
    return a.indices == b.indices &&
           std::equal(a.vertices.begin(), a.vertices.end(), b.vertices.begin(), b.vertices.end(),
                      [](const GrownBark::Vertex& v, const GrownBark::Vertex& w) {
                          return v.position == w.position && v.normal == w.normal && v.along == w.along;
                      });
}

}  // namespace

TEST(GrowthRandom, NothingEverMeets) {
    const int count = test::is_long_run() ? 1000 : test::cases(40);
    size_t frozen = 0, vertices = 0;
    for (int seed = 1; seed <= count; seed++) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const TreeCase setup = random_setup(static_cast<uint64_t>(seed));
        GrownTree grown;
        try {
            grown = grow_bark(setup.tree, read_growth_recipe(setup.tree, setup.recipe), {9, {}});
        } catch (const Error&) {
            continue;  // too thin for its edges
        }
        for (const GrowthStep& step : grown.checks)
            expect_sound(step);
        frozen += grown.checks.back().frozen_free;
        vertices += grown.checks.back().vertices;
    }
    EXPECT_GT(vertices, static_cast<size_t>(300 * count));
    // Away from contacts.
    EXPECT_LE(static_cast<double>(frozen), 0.05 * static_cast<double>(vertices));
}

TEST(GrowthRandom, IsTheSameOnOneThreadAndOnTwo) {
    for (uint64_t seed = 1; seed <= 3; seed++) {
        const TreeCase setup = random_setup(seed);
        const GrowthRecipe recipe = read_growth_recipe(setup.tree, setup.recipe);
        set_thread_count(1);
        const GrownBark one = grow_bark(setup.tree, recipe).bark;
        set_thread_count(2);
        const GrownBark two = grow_bark(setup.tree, recipe).bark;
        set_thread_count(0);
        EXPECT_TRUE(same(one, two)) << "seed " << seed;
        // Judged in between, it goes on as if it had not been.
        EXPECT_TRUE(same(one, grow_bark(setup.tree, recipe, {7, {}}).bark)) << "seed " << seed;
    }
}

TEST(GrowthRandom, FinerEdgesKeepTheShape) {
    const Tree tree = cylinder(0.15, 1.2);
    const GrownBark coarse =
        grow_bark(tree, read_growth_recipe(tree, "edges longest=0.06\nsteps count=80")).bark;
    const GrownBark fine =
        grow_bark(tree, read_growth_recipe(tree, "edges longest=0.03\nsteps count=80")).bark;
    const double times =
        static_cast<double>(fine.vertices.size()) / static_cast<double>(coarse.vertices.size());
    EXPECT_GT(times, 3.4);
    EXPECT_LT(times, 4.6);
    const std::vector<double> a = radii(coarse, 0.2, 1.0), b = radii(fine, 0.2, 1.0);
    for (const double share : {0.05, 0.5, 0.95})
        EXPECT_NEAR(a[static_cast<size_t>(share * static_cast<double>(a.size()))],
                    b[static_cast<size_t>(share * static_cast<double>(b.size()))], 0.02 * 0.15)
            << share;
}

namespace {

struct TracedVertex {
    std::string type, hold;
    int owner = 0, pieces = 0;
    DVec3 place{0.0}, velocity{0.0}, to{0.0};
    double speed = 0.0;
};

std::map<uint32_t, TracedVertex> read_vertices(const std::string& path) {
    std::map<uint32_t, TracedVertex> found;
    std::istringstream text{std::string(read_file(path).view())};
    std::string line;
    std::getline(text, line);
    while (std::getline(text, line)) {
        std::vector<std::string> words;
        std::istringstream parts(line);
        for (std::string word; std::getline(parts, word, ',');)
            words.push_back(word);
        EXPECT_EQ(words.size(), 15U) << line;
        const auto vector = [&](size_t at) {
            return DVec3(std::stod(words[at]), std::stod(words[at + 1]), std::stod(words[at + 2]));
        };
        found[static_cast<uint32_t>(std::stoul(words[0]))] = {
            words[1],  words[14], std::stoi(words[2]), std::stoi(words[10]),
            vector(3), vector(6), vector(11),          std::stod(words[9])};
    }
    return found;
}

}  // namespace

// Equations 1 to 5 of Mizoguchi and Miyata 2014, by what is written of each step.
TEST(GrowthTrace, LetsTheEquationsBeRecomputed) {
    const Tree tree = cylinder(0.1, 0.8);
    const std::string folder =
        (std::filesystem::temp_directory_path() / ("treerec_trace_" + std::to_string(std::rand()))).string();
    make_folder(folder);
    const GrownTree grown =
        grow_bark(tree, read_growth_recipe(tree, "edges longest=0.05\nsteps count=60"), {0, folder});
    std::map<uint32_t, TracedVertex> last;
    size_t moved = 0, tips = 0;
    for (int step = 0; step < grown.steps; step++) {
        char name[32];
        std::snprintf(name, sizeof(name), "/step_%05d", step);
        const std::map<uint32_t, TracedVertex> vertices = read_vertices(folder + name + ".csv");
        std::map<uint32_t, DVec3> normals;
        std::istringstream faces{std::string(read_file(folder + name + "_faces.csv").view())};
        std::string line;
        std::getline(faces, line);
        while (std::getline(faces, line)) {
            uint32_t ids[3];
            ASSERT_EQ(std::sscanf(line.c_str(), "%u,%u,%u", &ids[0], &ids[1], &ids[2]), 3) << line;
            const DVec3 a = vertices.at(ids[0]).place, b = vertices.at(ids[1]).place,
                        c = vertices.at(ids[2]).place;
            const DVec3 normal = glm::normalize(glm::cross(b - a, c - a));
            for (const uint32_t id : ids)
                normals[id] += normal;
        }
        ASSERT_EQ(normals.size(), vertices.size());
        for (const auto& [id, vertex] : vertices) {
            ASSERT_GE(vertex.pieces, 1);
            if (vertex.hold == "free") {  // equation 1
                ASSERT_LT(glm::distance(vertex.place + vertex.velocity, vertex.to), 1e-9) << id;
                moved++;
            }
            if (vertex.type == "CA") {  // equations 4 and 5
                ASSERT_LT(glm::distance(vertex.velocity, vertex.speed * glm::normalize(normals.at(id))), 1e-9)
                    << step << " " << id;
            } else {  // equation 3: up the axis
                ASSERT_EQ(vertex.type, "AM");
                ASSERT_LT(std::hypot(vertex.velocity.x, vertex.velocity.z), 1e-9);
                tips++;
                // Table 2: it keeps its own place.
                if (last.contains(id)) {
                    ASSERT_EQ(last.at(id).to, vertex.place);
                }
            }
        }
        // Table 2: nothing moves but by a merge, or by two in turn.
        for (const auto& [id, vertex] : last) {
            const auto now = vertices.find(id);
            if (now == vertices.end()) continue;
            ASSERT_LT(glm::distance(now->second.place, vertex.to), 0.05 * 15.0 / 35.0 + 1e-9);
        }
        last = vertices;
    }
    EXPECT_GT(moved, 1000U);
    EXPECT_GT(tips, 20U);
    std::filesystem::remove_all(folder);
}
