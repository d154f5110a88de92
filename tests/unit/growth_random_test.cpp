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
#include "growth_setups.h"
#include "growth_trees.h"

using namespace treerec;
using test::cylinder;
using test::expect_sound;
using test::radii;
using test::random_setup;
using test::same;
using test::TreeCase;

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
