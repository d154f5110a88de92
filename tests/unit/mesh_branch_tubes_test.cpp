#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <string>

#include "error.h"
#include "foliage/crown.h"
#include "geometry/parallel.h"
#include "mesh/branch_tubes.h"
#include "mesh/root_flare.h"
#include "mesh_tubes.h"
#include "random_tree.h"
#include "tree/branches.h"

namespace treerec {
namespace {

using test::face_normal;
using test::has_collar;
using test::TubeRange;
using test::tubes_of;

bool same_bytes(const Mesh& a, const Mesh& b) {
    const auto same = [](const auto& x, const auto& y) {
        return x.size() == y.size() &&
               (x.empty() || std::memcmp(x.data(), y.data(), x.size() * sizeof(x[0])) == 0);
    };
    return same(a.positions, b.positions) && same(a.normals, b.normals) && same(a.tangents, b.tangents) &&
           same(a.uvs, b.uvs) && same(a.colors, b.colors) && same(a.custom0, b.custom0) &&
           same(a.radii, b.radii) && same(a.indices, b.indices);
}

void expect_sound(const Mesh& mesh, const Tree& tree) {
    const size_t count = mesh.positions.size();
    ASSERT_EQ(mesh.normals.size(), count);
    ASSERT_EQ(mesh.tangents.size(), count);
    ASSERT_EQ(mesh.uvs.size(), count);
    ASSERT_EQ(mesh.colors.size(), count);
    ASSERT_EQ(mesh.custom0.size(), count);
    ASSERT_EQ(mesh.indices.size() % 3, 0u);
    double longest = 0.0;
    for (NodeId id : tree.depth_first())
        if (tree.node(id).parent != kNoNode)
            longest = std::max(
                longest, glm::distance(tree.node(id).position, tree.node(tree.node(id).parent).position));
    Bounds box = tree.bounds();
    // The trunk's foot goes on below the ground, and its roots beside it.
    const Node& root = tree.node(tree.root());
    box.add(root.position - DVec3(0.0, foot_depth(measure_crown(tree).height), 0.0), 4.0 * root.radius);
    box.add(root.position, 4.0 * root.radius);
    const double slack = 0.2 * longest + 0.4 * 0.5 + 1e-4;
    for (size_t i = 0; i < count; i++) {
        const DVec3 p(mesh.positions[i]);
        ASSERT_TRUE(is_finite(p));
        ASSERT_TRUE(glm::all(glm::greaterThanEqual(p, box.min - slack)) &&
                    glm::all(glm::lessThanEqual(p, box.max + slack)));
        ASSERT_NEAR(glm::length(mesh.normals[i]), 1.0f, 1e-4f);
        ASSERT_NEAR(glm::length(Vec3(mesh.tangents[i])), 1.0f, 1e-4f);
        ASSERT_EQ(std::abs(mesh.tangents[i].w), 1.0f);
        ASSERT_TRUE(std::isfinite(mesh.uvs[i].x) && std::isfinite(mesh.uvs[i].y));
        for (int c = 0; c < 4; c++) {
            ASSERT_GE(mesh.colors[i][c], 0.0f);
            ASSERT_LE(mesh.colors[i][c], 1.0f);
            ASSERT_TRUE(std::isfinite(mesh.custom0[i][c]));
        }
    }
    for (uint32_t index : mesh.indices)
        ASSERT_LT(index, count);
}

TEST(BranchTubes, ManyRandomTreesAreSound) {
    for (uint64_t seed = 0; seed < 200; seed++) {
        SCOPED_TRACE(seed);
        const Tree tree = test::random_tree(seed, 2 + static_cast<int>(seed * 7 % 600));
        for (int level = 0; level < 4; level++) {
            const Mesh mesh = build_branch_tubes(tree, {.level = level});
            expect_sound(mesh, tree);
            ASSERT_GT(mesh.triangle_count(), 0u);
            size_t inward = 0;
            for (size_t i = 0; i < mesh.indices.size(); i += 3) {
                const DVec3 face = face_normal(mesh, i);
                ASSERT_GT(glm::length(face), 0.0);
                DVec3 smooth(0.0);
                for (size_t k = 0; k < 3; k++)
                    smooth += DVec3(mesh.normals[mesh.indices[i + k]]);
                inward += glm::dot(face, smooth) <= 0.0 && !(level > 0 && test::is_plug(mesh, i));
            }
            // Only where wood thicker than it is long turns sharply may a face lean over.
            ASSERT_LE(inward, mesh.triangle_count() / (level > 0 ? 100 : 500) + (level > 0 ? 4 : 1));
        }
    }
}

// As a dense scan gives it: many thousand branches, segments from metres down to nanometres.
TEST(BranchTubes, AHugeTreeStaysSoundAndLight) {
    Tree tree = test::random_tree(11, 40000);
    Random random(11);
    for (const NodeId id : tree.depth_first()) {
        if (id % 7 != 0 || id == tree.root()) continue;
        const Node& node = tree.node(id);
        const double near = std::pow(10.0, random.uniform(-9.0, -4.0));
        tree.insert_before(id, node.position + near * random.direction(), node.radius);
    }
    const BranchList list = list_branches(tree);
    ASSERT_GT(list.branches.size(), 10000u);
    size_t finer = std::numeric_limits<size_t>::max();
    for (int level = 0; level < 4; level++) {
        const Mesh mesh = build_branch_tubes(tree, {.level = level});
        expect_sound(mesh, tree);
        ASSERT_GT(mesh.positions.size(), level == 0 ? 65536u : 1000u);
        for (size_t i = 0; i < mesh.indices.size(); i += 3)
            ASSERT_GT(glm::length(face_normal(mesh, i)), 0.0);
        // Branches of four bent segments each: a ring of four or five sides for each, and a tip.
        EXPECT_LT(mesh.triangle_count(), 14 * tree.size());
        EXPECT_LT(mesh.triangle_count(), finer / 2);
        finer = mesh.triangle_count();
    }
}

TEST(BranchTubes, PivotsCanBeLeftOut) {
    const Tree tree = test::random_tree(4, 500);
    const Mesh with = build_branch_tubes(tree);
    Mesh without = build_branch_tubes(tree, {.pivots = false});
    EXPECT_TRUE(without.custom0.empty() && without.radii.empty());
    without.custom0 = with.custom0;
    without.radii = with.radii;
    EXPECT_TRUE(same_bytes(with, without));
}

TEST(BranchTubes, WildTreesAreSound) {
    for (uint64_t seed = 0; seed < 300; seed++) {
        SCOPED_TRACE(seed);
        const Tree tree = test::wild_tree(seed, 1 + static_cast<int>(seed % 60));
        const Mesh mesh = build_branch_tubes(tree, {.level = static_cast<int>(seed % 4)});
        const size_t count = mesh.positions.size();
        for (size_t i = 0; i < count; i++) {
            ASSERT_TRUE(is_finite(DVec3(mesh.positions[i])));
            ASSERT_NEAR(glm::length(mesh.normals[i]), 1.0f, 1e-4f);
            ASSERT_NEAR(glm::length(Vec3(mesh.tangents[i])), 1.0f, 1e-4f);
        }
        for (uint32_t index : mesh.indices)
            ASSERT_LT(index, count);
        for (size_t i = 0; i < mesh.indices.size(); i += 3)
            ASSERT_GT(glm::length(face_normal(mesh, i)), 0.0);
    }
}

TEST(BranchTubes, EachTubeIsClosedButForItsBase) {
    for (uint64_t seed = 0; seed < 60; seed++) {
        const Tree tree = test::random_tree(seed, 300);
        const Mesh mesh = build_branch_tubes(tree, {.level = static_cast<int>(seed % 3)});
        const std::vector<TubeRange> tubes = tubes_of(mesh);
        ASSERT_GT(tubes.size(), 1u);
        for (const TubeRange& tube : tubes) {
            // Vertices that share a place are one corner: the seam, and the apex.
            std::map<std::tuple<float, float, float>, uint32_t> corner_of;
            std::vector<uint32_t> corner(tube.end_vertex - tube.first_vertex);
            for (uint32_t v = tube.first_vertex; v < tube.end_vertex; v++) {
                const Vec3 p = mesh.positions[v];
                corner[v - tube.first_vertex] = corner_of.try_emplace({p.x, p.y, p.z}, v).first->second;
            }
            std::map<std::pair<uint32_t, uint32_t>, int> edges;
            for (size_t i = tube.first_index; i < tube.end_index; i += 3)
                for (int k = 0; k < 3; k++)
                    edges[{corner[mesh.indices[i + k] - tube.first_vertex],
                           corner[mesh.indices[i + (k + 1) % 3] - tube.first_vertex]}]++;
            for (const auto& [edge, uses] : edges) {
                ASSERT_EQ(uses, 1);  // one way once: the winding agrees all over
                const bool at_base = mesh.colors[edge.first].g == 0.0f && mesh.colors[edge.second].g == 0.0f;
                ASSERT_TRUE(at_base || edges.count({edge.second, edge.first}) == 1);
            }
            // Outward: the tube, closed by a lid on its base, holds a positive volume.
            const DVec3 inside(mesh.custom0[tube.first_vertex]);
            double volume = 0.0;
            for (size_t i = tube.first_index; i < tube.end_index; i += 3)
                volume += glm::dot(DVec3(mesh.positions[mesh.indices[i]]) - inside, face_normal(mesh, i));
            ASSERT_GT(volume, 0.0);
        }
    }
}

struct DrawnRing {
    DVec3 centre;
    double radius;
};

// The rings of a tube: runs of vertices with one v.
std::vector<DrawnRing> rings_of(const Mesh& mesh, const TubeRange& tube) {
    std::vector<DrawnRing> rings;
    for (uint32_t v = tube.first_vertex; v < tube.end_vertex;) {
        uint32_t end = v;
        DVec3 sum(0.0);
        while (end < tube.end_vertex && mesh.uvs[end].y == mesh.uvs[v].y)
            sum += DVec3(mesh.positions[end++]);
        // The last vertex of a ring repeats the first; the apex' vertices are all one.
        const DVec3 centre = (sum - DVec3(mesh.positions[end - 1])) / static_cast<double>(end - v - 1);
        rings.push_back({centre, glm::distance(centre, DVec3(mesh.positions[v]))});
        v = end;
    }
    return rings;
}

// How far p lies outside the cone frusta between rings; negative inside.
double outside(const std::vector<DrawnRing>& rings, const DVec3& p) {
    double least = 1e9;
    for (size_t i = 0; i + 1 < rings.size(); i++) {
        const DVec3 a = rings[i].centre, along = rings[i + 1].centre - a;
        const double t = std::clamp(glm::dot(p - a, along) / glm::dot(along, along), 0.0, 1.0);
        const double radius = rings[i].radius * (1.0 - t) + rings[i + 1].radius * t;
        least = std::min(least, glm::distance(p, a + along * t) - radius);
    }
    return least;
}

TEST(BranchTubes, ChildrenStartInsideTheirParents) {
    size_t bases = 0;
    for (uint64_t seed = 0; seed < 60; seed++) {
        SCOPED_TRACE(seed);
        const Tree tree = test::random_tree(seed, 400);
        const Mesh mesh = build_branch_tubes(tree, {.level = static_cast<int>(seed % 2)});
        const std::vector<TubeRange> tubes = tubes_of(mesh);
        std::vector<std::vector<DrawnRing>> rings;
        for (const TubeRange& tube : tubes)
            rings.push_back(has_collar(mesh, tube) ? std::vector<DrawnRing>() : rings_of(mesh, tube));
        for (const TubeRange& tube : tubes) {
            const Vec4 start = mesh.custom0[tube.first_vertex];
            if (start.w == 0.0f || has_collar(mesh, tube) || test::has_plug(mesh, tube)) continue;
            // The parent is the tube one level down on whose axis the child starts.
            size_t parent = tubes.size();
            double nearest = 1e9;
            for (size_t i = 0; i < tubes.size(); i++) {
                if (mesh.custom0[tubes[i].first_vertex].w != start.w - 1.0f) continue;
                std::vector<DrawnRing> axis = rings[i];
                for (DrawnRing& ring : axis)
                    ring.radius = 0.0;
                const double distance = outside(axis, DVec3(start));
                if (distance < nearest) {
                    nearest = distance;
                    parent = i;
                }
            }
            if (seed % 2 == 0 && nearest > 2e-5) continue;  // its parent has a collar
            ASSERT_LT(parent, tubes.size());
            ASSERT_LT(nearest, 4e-5);
            for (uint32_t v = tube.first_vertex; mesh.colors[v].g == 0.0f; v++)
                ASSERT_LT(outside(rings[parent], DVec3(mesh.positions[v])), 0.0);
            bases++;
        }
    }
    EXPECT_GT(bases, 3000u);
}

TEST(BranchTubes, UvsGoRoundOnce) {
    for (const bool whole : {false, true}) {
        const Tree tree = test::random_tree(5, 500);
        const TubeOptions options{.whole_repeats = whole};
        const Mesh mesh = build_branch_tubes(tree, options);
        for (size_t i = 0; i < mesh.indices.size(); i += 3) {
            for (int k = 0; k < 3; k++) {
                const uint32_t a = mesh.indices[i + k], b = mesh.indices[i + (k + 1) % 3];
                // A triangle spans at most one side; a seam jump would span nearly a round.
                ASSERT_LT(std::abs(mesh.uvs[a].x - mesh.uvs[b].x), 0.5f);
            }
        }
        // First and last vertex of a ring are one place, a round apart, and all else alike.
        size_t rings = 0;
        for (const TubeRange& tube : tubes_of(mesh)) {
            if (has_collar(mesh, tube)) continue;
            for (uint32_t v = tube.first_vertex; v < tube.end_vertex;) {
                uint32_t end = v;
                while (end < tube.end_vertex && mesh.uvs[end].y == mesh.uvs[v].y)
                    end++;
                const uint32_t last = end - 1;
                if (mesh.colors[v].g < 1.0f && last > v) {
                    ASSERT_EQ(mesh.positions[v], mesh.positions[last]);
                    ASSERT_EQ(mesh.normals[v], mesh.normals[last]);
                    ASSERT_EQ(mesh.uvs[v].x, 0.0f);
                    const float round = mesh.uvs[last].x;
                    if (whole) {
                        ASSERT_EQ(round, std::round(round));
                        ASSERT_GE(round, 1.0f);
                    } else {
                        ASSERT_NEAR(round, 2.0 * kPi * std::abs(mesh.radii[v]) / options.bark_width,
                                    1e-4 * round + 1e-6);
                    }
                    rings++;
                }
                v = end;
            }
        }
        ASSERT_GT(rings, 100u);
    }
}

TEST(BranchTubes, TangentsFollowTheUvs) {
    const Tree tree = test::random_tree(6, 300);
    const Mesh mesh = build_branch_tubes(tree);
    size_t good = 0, all = 0;
    for (size_t i = 0; i < mesh.indices.size(); i += 3) {
        const uint32_t a = mesh.indices[i], b = mesh.indices[i + 1], c = mesh.indices[i + 2];
        const DVec3 e1(mesh.positions[b] - mesh.positions[a]), e2(mesh.positions[c] - mesh.positions[a]);
        const DVec2 d1(mesh.uvs[b] - mesh.uvs[a]), d2(mesh.uvs[c] - mesh.uvs[a]);
        const double det = d1.x * d2.y - d1.y * d2.x;
        if (std::abs(det) < 1e-12) continue;
        const DVec3 along_u = (e1 * d2.y - e2 * d1.y) / det, along_v = (e2 * d1.x - e1 * d2.x) / det;
        const DVec3 tangent(mesh.tangents[a]), normal(mesh.normals[a]);
        const DVec3 bitangent = glm::cross(normal, tangent) * static_cast<double>(mesh.tangents[a].w);
        all++;
        // v runs down the picture, the bitangent up it.
        good += glm::dot(along_u, tangent) > 0.0 && glm::dot(along_v, bitangent) < 0.0;
    }
    ASSERT_GT(all, 1000u);
    EXPECT_GT(good, all * 99 / 100);
}

TEST(BranchTubes, WindChannelsMeanWhatTheDesignSays) {
    const Tree tree = test::random_tree(7, 800);
    const Mesh mesh = build_branch_tubes(tree);
    float low = 1.0f, high = 0.0f;
    for (const Vec4& color : mesh.colors) {
        low = std::min(low, color.r);
        high = std::max(high, color.r);
    }
    EXPECT_EQ(low, 0.0f);
    EXPECT_NEAR(high, 1.0f, 1e-4f);
    for (const TubeRange& tube : tubes_of(mesh)) {
        float tip = 0.0f;
        for (uint32_t v = tube.first_vertex; v < tube.end_vertex; v++) {
            // The base of a collar has its parent's phase.
            if (mesh.colors[v].g > 0.0f) {
                ASSERT_EQ(mesh.colors[v].b, mesh.colors[tube.end_vertex - 1].b);
            }
            ASSERT_EQ(mesh.custom0[v], mesh.custom0[tube.first_vertex]);
            tip = std::max(tip, mesh.colors[v].g);
        }
        ASSERT_EQ(mesh.colors[tube.first_vertex].g, 0.0f);
        ASSERT_EQ(tip, 1.0f);
    }
}

TEST(BranchTubes, NormalsPointAwayFromTheAxis) {
    const Tree tree = test::random_tree(8, 300);
    const Mesh mesh = build_branch_tubes(tree);
    for (const TubeRange& tube : tubes_of(mesh)) {
        if (has_collar(mesh, tube)) continue;
        // The first ring lies about the pivot.
        for (uint32_t v = tube.first_vertex; v < tube.end_vertex && mesh.colors[v].g == 0.0f; v++)
            ASSERT_GT(glm::dot(mesh.normals[v], mesh.positions[v] - Vec3(mesh.custom0[v])), 0.0f);
    }
}

TEST(BranchTubes, SameBytesWhateverTheThreads) {
    const Tree tree = test::random_tree(9, 5000);
    set_thread_count(1);
    const Mesh one = build_branch_tubes(tree);
    set_thread_count(5);
    const Mesh five = build_branch_tubes(tree);
    set_thread_count(0);
    EXPECT_TRUE(same_bytes(one, five));
}

TEST(BranchTubes, CoarserLevelsCostLessAndKeepTheTrunk) {
    const Tree tree = test::random_tree(10, 3000);
    size_t before = SIZE_MAX;
    for (int level = 0; level < 4; level++) {
        const Mesh mesh = build_branch_tubes(tree, {.level = level});
        EXPECT_LT(mesh.triangle_count(), before * 7 / 10) << level;
        before = mesh.triangle_count();
        EXPECT_EQ(mesh.custom0[0].w, 0.0f);
    }
}

// A trunk of 4 m that leans by `lean` metres per metre, with a branch.
Tree leaning_trunk(double lean, double radius, bool marked) {
    Tree tree;
    const uint8_t flags = marked ? kTrunkFlag : 0;
    NodeId at = tree.add_root({0.3, 0.5, -0.2}, radius, flags), fork = kNoNode;
    for (int i = 1; i <= 8; i++) {
        at = tree.add_child(at, {0.3 + lean * 0.5 * i, 0.5 + 0.5 * i, -0.2}, radius * (1.0 - 0.1 * i), flags);
        if (i == 4) fork = at;
    }
    tree.add_child(fork, tree.node(fork).position + DVec3(0.0, 0.4, 1.0), 0.3 * radius);
    return tree;
}

TEST(BranchTubes, ATrunkIsCutLevelBelowTheGround) {
    for (const double lean : {0.0, 0.2, 0.5, 1.0})
        for (const double radius : {0.02, 0.1, 0.4}) {
            SCOPED_TRACE(std::to_string(lean) + " " + std::to_string(radius));
            const Tree tree = leaning_trunk(lean, radius, true);
            for (int level = 0; level < 3; level++) {
                const Mesh mesh = build_branch_tubes(tree, {.level = level});
                const TubeRange trunk = tubes_of(mesh)[0];
                double low = 1e9, high = -1e9;
                size_t corners = 0;
                for (uint32_t v = trunk.first_vertex; v < trunk.end_vertex && mesh.colors[v].g == 0.0f; v++) {
                    low = std::min(low, static_cast<double>(mesh.positions[v].y));
                    high = std::max(high, static_cast<double>(mesh.positions[v].y));
                    // Straight down, with what is left of its roots.
                    const DVec3 off = DVec3(mesh.positions[v]) - tree.node(tree.root()).position;
                    const double wide = std::hypot(off.x, off.z) / radius;
                    EXPECT_GE(wide, 0.45);
                    EXPECT_LE(wide, 2.5);
                    EXPECT_GE(mesh.radii[v], radius * 0.5);
                    EXPECT_LE(mesh.radii[v], radius * 1.6);
                    corners++;
                }
                EXPECT_GE(corners, 4u);
                EXPECT_NEAR(low, high, 1e-5);
                EXPECT_NEAR(0.5 - low, foot_depth(4.0), 1e-5);
            }
            // What lies keeps its cut.
            const Mesh mesh = build_branch_tubes(leaning_trunk(lean, radius, false));
            for (uint32_t v = 0; mesh.colors[v].g == 0.0f; v++)
                EXPECT_NEAR(glm::distance(mesh.positions[v], Vec3(0.3, 0.5, -0.2)), radius, 1e-5);
        }
}

TEST(BranchTubes, RadiiAreThoseOfTheDrawnWood) {
    const Tree tree = test::random_tree(12, 600);
    const Mesh mesh = build_branch_tubes(tree);
    ASSERT_EQ(mesh.radii.size(), mesh.positions.size());
    size_t checked = 0;
    for (const TubeRange& tube : tubes_of(mesh)) {
        // Its base is cut level.
        if (mesh.custom0[tube.first_vertex].w == 0.0f || has_collar(mesh, tube)) continue;
        uint32_t v = tube.first_vertex;
        for (const DrawnRing& ring : rings_of(mesh, tube)) {
            const float at = mesh.uvs[v].y;
            for (; v < tube.end_vertex && mesh.uvs[v].y == at; v++) {
                if (mesh.colors[v].g >= 1.0f) continue;                 // domes and points
                const double slack = ring.radius < 0.012 ? 1e-3 : 0.3;  // stout joints stretch their bark
                EXPECT_NEAR(mesh.radii[v], ring.radius, 1e-4 + slack * ring.radius);
                checked++;
            }
        }
    }
    EXPECT_GT(checked, 1000u);
}

// Two stems of one thickness: the second one's bark comes out of the first one's little by little.
TEST(BranchTubes, AStemOfAForkStartsWellWithinTheOther) {
    Tree tree;
    NodeId at = tree.add_root({0, 0, 0}, 0.1, kTrunkFlag);
    for (int i = 1; i <= 6; i++)
        at = tree.add_child(at, {0, 0.5 * i, 0}, 0.1, kTrunkFlag);
    const NodeId fork = tree.node(tree.node(tree.node(at).parent).parent).parent;
    NodeId twin = fork;
    for (int i = 1; i <= 8; i++)
        twin = tree.add_child(twin, tree.node(fork).position + DVec3(0.06 * i, 0.15 * i, 0), 0.1);
    const Mesh mesh = build_branch_tubes(tree);
    const std::vector<TubeRange> tubes = tubes_of(mesh);
    ASSERT_EQ(tubes.size(), 2u);
    const std::vector<DrawnRing> parent = rings_of(mesh, tubes[0]);
    ASSERT_TRUE(has_collar(mesh, tubes[1]));
    for (uint32_t v = tubes[1].first_vertex; mesh.colors[v].g == 0.0f; v++) {
        const DVec3 p(mesh.positions[v]);
        EXPECT_LT(outside(parent, p), 0.0);
        EXPECT_GT(outside(parent, p), -0.006);
        // The parent's own normal there.
        EXPECT_GT(glm::dot(DVec3(mesh.normals[v]), glm::normalize(DVec3(p.x, 0.0, p.z))), 0.99);
    }
    // It comes out little by little.
    double before = 0.0;
    for (uint32_t v = tubes[1].first_vertex; v < tubes[1].end_vertex; v++) {
        const DVec3 p(mesh.positions[v]);
        const double come = std::max(0.0, p.y - tree.node(fork).position.y);
        EXPECT_LT(outside(parent, p), 0.6 * come + 0.02);
        before = std::max(before, static_cast<double>(mesh.radii[v]));
    }
    EXPECT_NEAR(before, 0.1, 0.03);
}

TEST(BranchTubes, SmallestTrees) {
    EXPECT_TRUE(build_branch_tubes(Tree()).positions.empty());
    Tree tree;
    const NodeId root = tree.add_root({1.0, 2.0, 3.0}, 0.1);
    EXPECT_TRUE(build_branch_tubes(tree).positions.empty());
    const NodeId twin = tree.add_child(root, {1.0, 2.0, 3.0}, 0.1);
    EXPECT_TRUE(build_branch_tubes(tree).positions.empty());
    tree.set_position(twin, {1.0, 4.0, 3.0});
    const Mesh mesh = build_branch_tubes(tree);
    expect_sound(mesh, tree);
    EXPECT_GT(mesh.triangle_count(), 10u);
    tree.set_position(twin, {1e9, 4.0, 3.0});
    EXPECT_THROW(build_branch_tubes(tree), Error);
}

}  // namespace
}  // namespace treerec
