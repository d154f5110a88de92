// Surfaces that meet and become one, and surfaces that start from a mesh (src/growth/fuse, seed).
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "cases.h"
#include "file_bytes.h"
#include "geometry/parallel.h"
#include "geometry/triangle.h"
#include "growth/grow_bark.h"
#include "growth_setups.h"
#include "growth_trees.h"

using namespace treerec;
using test::cylinder;
using test::expect_sound;
using test::random_setup;

namespace {

// Two stems from one trunk that come together again farther up.
Tree two_stems() {
    Tree tree;
    NodeId fork = tree.add_root(DVec3(0.0), 0.16, kTrunkFlag);
    for (int i = 1; i <= 5; i++)
        fork = tree.add_child(fork, DVec3(0.0, 0.1 * i, 0.0), 0.16, kTrunkFlag);
    for (const double side : {-1.0, 1.0}) {
        NodeId last = tree.add_child(fork, DVec3(side * 0.06, 0.6, 0.0), 0.13);
        last = tree.add_child(last, DVec3(side * 0.14, 0.75, 0.0), 0.115);
        for (int i = 0; i < 9; i++) {
            const double off = i <= 4 ? 0.16 - 0.019 * i : 0.084 + 0.03 * (i - 4);
            last = tree.add_child(last, DVec3(side * off, 0.85 + 0.1 * i, 0.0), 0.11);
        }
    }
    return tree;
}

// By the winding number.
bool inside(const GrownBark& bark, const DVec3& point) {
    double angle = 0.0;
    for (size_t i = 0; i < bark.indices.size(); i += 3) {
        const DVec3 a = DVec3(bark.vertices[bark.indices[i]].position) - point,
                    b = DVec3(bark.vertices[bark.indices[i + 1]].position) - point,
                    c = DVec3(bark.vertices[bark.indices[i + 2]].position) - point;
        const double x = glm::length(a), y = glm::length(b), z = glm::length(c);
        angle += std::atan2(glm::dot(a, glm::cross(b, c)),
                            x * y * z + glm::dot(a, b) * z + glm::dot(b, c) * x + glm::dot(c, a) * y);
    }
    return std::abs(angle) > 3.1415;
}

double distance_to(const GrownBark& bark, const DVec3& point) {
    double least = 1e300;
    for (size_t i = 0; i < bark.indices.size(); i += 3) {
        const DVec3 a(bark.vertices[bark.indices[i]].position),
            b(bark.vertices[bark.indices[i + 1]].position), c(bark.vertices[bark.indices[i + 2]].position);
        const DVec3 at = nearest_in_triangle(point, a, b, c);
        least = std::min(least, glm::distance(point, at.x * a + at.y * b + at.z * c));
    }
    return least;
}

// Metres that the place between the two stems which lies deepest in wood lies below the bark.
double deepest_between(const GrownBark& bark) {
    double deepest = 0.0;
    for (double up = 1.0; up < 1.5; up += 0.02)
        for (double aside = -0.04; aside < 0.05; aside += 0.02)
            if (const DVec3 at(0.0, up, aside); inside(bark, at))
                deepest = std::max(deepest, distance_to(bark, at));
    return deepest;
}

struct Mesh {
    std::vector<DVec3> points;
    std::vector<std::array<int, 3>> faces;

    void turn_inside_out() {
        for (std::array<int, 3>& face : faces)
            std::swap(face[0], face[1]);
    }
};

// A stump with five lobes, from 0.15 m below its middle's `at` to 0.37 m above it.
Mesh stump(const DVec3& at = DVec3(0.0)) {
    constexpr int kAround = 32, kRows = 9;
    Mesh mesh;
    for (int row = 0; row < kRows; row++)
        for (int side = 0; side < kAround; side++) {
            const double up = static_cast<double>(row) / (kRows - 1), angle = 6.28318530718 * side / kAround;
            const double radius = 0.16 + 0.16 * (1.0 - up) * (1.0 - up) * (0.6 + 0.6 * std::cos(5.0 * angle));
            mesh.points.push_back(
                at + DVec3(radius * std::cos(angle), -0.15 + 0.5 * up, -radius * std::sin(angle)));
        }
    const int below = static_cast<int>(mesh.points.size()), above = below + 1;
    mesh.points.push_back(at + DVec3(0.0, -0.15, 0.0));
    mesh.points.push_back(at + DVec3(0.0, 0.37, 0.0));
    for (int side = 0; side < kAround; side++) {
        const int next = (side + 1) % kAround, top = (kRows - 1) * kAround;
        for (int row = 0; row + 1 < kRows; row++) {
            const int a = row * kAround + side, b = row * kAround + next;
            mesh.faces.push_back({a, b, a + kAround});
            mesh.faces.push_back({b, b + kAround, a + kAround});
        }
        mesh.faces.push_back({below, next, side});
        mesh.faces.push_back({above, top + side, top + next});
    }
    return mesh;
}

class SeedFile {
  public:
    explicit SeedFile(const std::vector<Mesh>& meshes)
        : path_((std::filesystem::temp_directory_path() /
                 ("treerec_seed_" + std::to_string(reinterpret_cast<uintptr_t>(this)) + ".obj"))
                    .string()) {
        std::string text;
        int before = 1;
        for (const Mesh& mesh : meshes) {
            for (const DVec3& p : mesh.points)
                text +=
                    "v " + std::to_string(p.x) + " " + std::to_string(p.y) + " " + std::to_string(p.z) + "\n";
            for (const std::array<int, 3>& face : mesh.faces)
                text += "f " + std::to_string(before + face[0]) + " " + std::to_string(before + face[1]) +
                        " " + std::to_string(before + face[2]) + "\n";
            before += static_cast<int>(mesh.points.size());
        }
        write_file(path_, text);
    }
    ~SeedFile() { std::filesystem::remove(path_); }
    SeedFile(const SeedFile&) = delete;
    SeedFile& operator=(const SeedFile&) = delete;

    GrownTree grow(const Tree& tree, const std::string& more = "") const {
        return grow_bark(tree,
                         read_growth_recipe(tree, "edges longest=0.05\nseed file=\"" + path_ + "\"\n" + more),
                         {10, {}});
    }
    std::string refusal(const Tree& tree) const {
        try {
            grow(tree);
        } catch (const Error& error) {
            return error.what();
        }
        return "";
    }

  private:
    std::string path_;
};

}  // namespace

TEST(GrowthFuse, StemsThatMeetBecomeOne) {
    const Tree tree = two_stems();
    const GrownTree apart = grow_bark(tree, read_growth_recipe(tree, "edges longest=0.045"), {10, {}});
    const GrownTree fused = grow_bark(tree, read_growth_recipe(tree, "edges longest=0.045\nfuse"), {10, {}});
    for (const GrowthStep& step : apart.checks)
        expect_sound(step);
    for (const GrowthStep& step : fused.checks)
        expect_sound(step, step.chi);
    EXPECT_EQ(apart.fused, 0U);
    EXPECT_EQ(apart.chi, 2);
    ASSERT_GE(fused.fused, 1U);
    // Each is a handle; the trunk is one already.
    EXPECT_EQ(fused.chi, 2 - 2 * static_cast<long>(fused.fused));
    EXPECT_EQ(fused.checks.back().chi, fused.chi);
    // Where the stems lean on each other there is wood now, where there was a gap between two barks.
    EXPECT_LT(deepest_between(apart.bark), 0.004);
    EXPECT_GT(deepest_between(fused.bark), 0.01);
    // Elsewhere it is as thick as before.
    EXPECT_FALSE(inside(fused.bark, DVec3(0.0, 0.95, 0.0)));
    EXPECT_NEAR(distance_to(fused.bark, DVec3(-0.16, 0.85, 0.0)),
                distance_to(apart.bark, DVec3(-0.16, 0.85, 0.0)), 0.01);
}

TEST(GrowthFuse, StaysSoundAndTheSameOnRandomTrees) {
    const int count = test::is_long_run() ? 300 : test::cases(12);
    size_t handles = 0, frozen = 0, vertices = 0;
    // Few of them grow together: where fewer are tried, on to the first one that does.
    for (int seed = 1; seed <= count || (handles == 0 && seed <= 12); seed++) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const test::TreeCase setup = random_setup(static_cast<uint64_t>(seed));
        const GrowthRecipe recipe = read_growth_recipe(setup.tree, setup.recipe + "fuse\n");
        GrownTree grown;
        try {
            grown = grow_bark(setup.tree, recipe, {9, {}});
        } catch (const Error&) {
            continue;  // too thin for its edges
        }
        long chi = 2;
        for (const GrowthStep& step : grown.checks) {
            expect_sound(step, step.chi);
            EXPECT_LE(step.chi, chi);
            chi = step.chi;
        }
        EXPECT_EQ(chi, 2 - 2 * static_cast<long>(grown.fused));
        handles += grown.fused;
        frozen += grown.checks.back().frozen_free;
        vertices += grown.checks.back().vertices;
        if (seed > 2) continue;
        set_thread_count(1);
        EXPECT_TRUE(test::same(grown.bark, grow_bark(setup.tree, recipe).bark));
        set_thread_count(0);
    }
    EXPECT_GT(handles, 0U);
    EXPECT_LE(static_cast<double>(frozen), 0.05 * static_cast<double>(vertices));
}

TEST(GrowthSeed, IsWhatBarkGrowsFrom) {
    const Tree tree = cylinder(0.14, 1.2);
    Mesh mesh = stump();
    for (const bool inside_out : {false, true}) {
        if (inside_out) mesh.turn_inside_out();
        const GrownTree grown = SeedFile({mesh}).grow(tree);
        ASSERT_FALSE(grown.checks.empty());
        for (const GrowthStep& step : grown.checks)
            expect_sound(step);
        // It keeps the lobes, which are thicker than the wood; above them the wood is as thick as ever.
        double worst = 0.0;
        for (const DVec3& p : mesh.points)
            if (std::hypot(p.x, p.z) > 0.2) worst = std::max(worst, distance_to(grown.bark, p));
        EXPECT_LT(worst, 0.01);
        const std::vector<double> upper = test::radii(grown.bark, 0.6, 1.0);
        ASSERT_FALSE(upper.empty());
        EXPECT_NEAR(upper[upper.size() / 2], 0.14, 0.02 * 0.14);
        EXPECT_TRUE(inside(grown.bark, DVec3(0.0, 1.0, 0.0)));
    }
}

TEST(GrowthSeed, MayBeCoarserAndFinerThanTheEdges) {
    // A box of twelve triangles, and the stump cut into tiny ones.
    Mesh box;
    for (int corner = 0; corner < 8; corner++)
        box.points.emplace_back(corner & 1 ? 0.25 : -0.25, corner & 2 ? 0.3 : -0.2,
                                corner & 4 ? 0.25 : -0.25);
    box.faces = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                 {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    Mesh fine = stump();
    for (int pass = 0; pass < 2; pass++) {
        Mesh next{fine.points, {}};
        for (const std::array<int, 3>& face : fine.faces) {
            const int middle = static_cast<int>(next.points.size());
            next.points.push_back((fine.points[static_cast<size_t>(face[0])] +
                                   fine.points[static_cast<size_t>(face[1])] +
                                   fine.points[static_cast<size_t>(face[2])]) /
                                  3.0);
            for (int k = 0; k < 3; k++)
                next.faces.push_back(
                    {face[static_cast<size_t>(k)], face[static_cast<size_t>((k + 1) % 3)], middle});
        }
        fine = next;
    }
    const Tree tree = cylinder(0.14, 1.2);
    for (const Mesh& mesh : {box, fine}) {
        const GrownTree grown = SeedFile({mesh}).grow(tree);
        for (const GrowthStep& step : grown.checks)
            expect_sound(step);
        EXPECT_LT(grown.checks.front().vertices, 4000U);
    }
}

TEST(GrowthSeed, ThatIsNoneIsRefusedWithASentence) {
    const Tree tree = cylinder(0.14, 1.2);
    Mesh holed = stump();
    holed.faces.pop_back();
    EXPECT_NE(SeedFile({holed}).refusal(tree).find("has holes"), std::string::npos);
    EXPECT_NE(SeedFile({stump(), stump(DVec3(2.0, 0.0, 0.0))}).refusal(tree).find("2 parts"),
              std::string::npos);
    EXPECT_NE(SeedFile({stump(DVec3(1.0, 0.0, 0.0))}).refusal(tree).find("does not begin in the seed"),
              std::string::npos);
    Mesh twice = stump();
    twice.faces.push_back(twice.faces.front());
    EXPECT_NE(SeedFile({twice}).refusal(tree).find("not one surface"), std::string::npos);
    Mesh crossed = stump();
    crossed.points[4 * 32].x = -0.5;
    EXPECT_NE(SeedFile({crossed}).refusal(tree).find("goes through itself"), std::string::npos);
    Mesh tall = stump();
    for (DVec3& p : tall.points)
        p.y *= 20.0;
    EXPECT_NE(SeedFile({tall}).refusal(tree).find("does not come out"), std::string::npos);
    Mesh far = stump();
    far.points[0].x = 1e300;
    EXPECT_NE(SeedFile({far}).refusal(tree), "");
    // Something stands in it.
    const SeedFile seed({stump()});
    EXPECT_THROW(seed.grow(tree, "obstacle shape=sheet middle=0.2,0,0 direction=1,0,0 width=0.3 length=0.3"),
                 Error);
}
