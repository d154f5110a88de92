// Grown bark as plain data: packed, judged by the wood beneath, drawn at the finest level alone.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "error.h"
#include "foliage/leaf_rules.h"
#include "geometry/random.h"
#include "mesh/grown_bark.h"
#include "mesh/levels.h"
#include "tree/tree.h"

using namespace treerec;

namespace {

// A trunk of ten nodes, a metre of height each, that bears a branch at every second one.
Tree ladder() {
    Tree tree;
    std::vector<NodeId> trunk{tree.add_root(DVec3(0.0), 0.2, kTrunkFlag)};
    for (int i = 1; i <= 10; i++)
        trunk.push_back(tree.add_child(trunk.back(), DVec3(0.0, i, 0.0), 0.2 - 0.015 * i, kTrunkFlag));
    for (int i = 2; i < 10; i += 2) {
        NodeId last = trunk[static_cast<size_t>(i)];
        for (int k = 1; k <= 3; k++)
            last = tree.add_child(last, DVec3(0.5 * k, i + 0.2 * k, 0.0), 0.05 / k);
    }
    return tree;
}

// A closed surface of eight triangles about the trunk below `until`, wider than any wood.
GrownBark lozenge(const Tree& tree, double until) {
    GrownBark bark;
    bark.branches.push_back({tree.root(), until});
    const Vec3 middle(0.0f, 1.5f, 0.0f);
    const Vec3 places[6] = {{0.9f, 1.5f, 0.0f}, {0.0f, 1.5f, -0.9f}, {-0.9f, 1.5f, 0.0f},
                            {0.0f, 1.5f, 0.9f}, {0.0f, 3.0f, 0.0f},  {0.0f, -0.5f, 0.0f}};
    for (const Vec3& place : places) {
        GrownBark::Vertex vertex;
        vertex.position = place;
        vertex.normal = glm::normalize(place - middle);
        vertex.along = std::max(place.y, 0.0f);
        vertex.around = static_cast<float>(std::atan2(-place.z, place.x) / 6.2831853);
        vertex.radius = 0.2f;
        vertex.decayed = place.y > 2.0f;
        bark.vertices.push_back(vertex);
    }
    for (uint32_t i = 0; i < 4; i++) {
        const uint32_t next = (i + 1) % 4;
        for (const uint32_t index : {i, next, 4u, next, i, 5u})
            bark.indices.push_back(index);
    }
    bark.digest = covered_wood_digest(tree, bark.branches);
    return bark;
}

// With two levels: the tip may become part of one side.
GrownBark with_levels(GrownBark bark) {
    std::swap(bark.vertices[4], bark.vertices[5]);
    for (uint32_t& index : bark.indices)
        if (index >= 4) index = 9 - index;
    bark.parents = {0, 1, 2, 3, 4, 3};
    return bark;
}

double farthest(const Mesh& mesh) {
    double far = 0.0;
    for (const Vec3& place : mesh.positions)
        if (std::abs(place.y - 1.5f) < 0.4f && std::abs(place.x) < 1e-3f)
            far = std::max(far, static_cast<double>(std::abs(place.z)));
    return far;
}

TEST(GrownBark, ComesBackFromItsBytes) {
    const Tree tree = ladder();
    GrownBark bark = lozenge(tree, 4.0);
    Random random(3);
    for (GrownBark::Vertex& vertex : bark.vertices)
        vertex.normal = Vec3(random.direction());
    const std::string packed = pack_grown_bark(bark);
    const GrownBark back = unpack_grown_bark(packed);
    EXPECT_EQ(back.digest, bark.digest);
    EXPECT_EQ(back.indices, bark.indices);
    ASSERT_EQ(back.branches.size(), 1U);
    EXPECT_EQ(back.branches[0].first, tree.root());
    EXPECT_EQ(back.branches[0].until, 4.0);
    ASSERT_EQ(back.vertices.size(), bark.vertices.size());
    for (size_t i = 0; i < bark.vertices.size(); i++) {
        EXPECT_EQ(back.vertices[i].position, bark.vertices[i].position);
        EXPECT_EQ(back.vertices[i].around, bark.vertices[i].around);
        EXPECT_EQ(back.vertices[i].decayed, bark.vertices[i].decayed);
        EXPECT_LT(glm::distance(back.vertices[i].normal, bark.vertices[i].normal), 1e-4f);
        EXPECT_NEAR(glm::length(back.vertices[i].normal), 1.0f, 1e-5f);
    }
    EXPECT_EQ(unpack_grown_bark(pack_grown_bark(back)).indices, bark.indices);
    bark.branches[0].until = std::numeric_limits<double>::infinity();
    EXPECT_EQ(unpack_grown_bark(pack_grown_bark(bark)).branches[0].until, bark.branches[0].until);
}

TEST(GrownBark, LevelsComeBackAndBarkOfTheFirstVersionHasNone) {
    const GrownBark bark = with_levels(lozenge(ladder(), 4.0));
    const std::string packed = pack_grown_bark(bark);
    EXPECT_EQ(unpack_grown_bark(packed).parents, bark.parents);
    // The first version ended after the triangles.
    std::string first = pack_grown_bark(lozenge(ladder(), 4.0));
    first.resize(first.size() - 4);
    EXPECT_THROW(unpack_grown_bark(first), Error);
    first[std::string("treerec bark").size()] = 1;
    const GrownBark back = unpack_grown_bark(first);
    EXPECT_EQ(back.vertices.size(), bark.vertices.size());
    EXPECT_EQ(back.indices.size(), bark.indices.size());
    EXPECT_TRUE(back.parents.empty());
    // A vertex can't become part of one that comes after it, and all have a parent or none.
    GrownBark wrong = bark;
    wrong.parents[2] = 4;
    EXPECT_THROW(unpack_grown_bark(pack_grown_bark(wrong)), Error);
    wrong = bark;
    wrong.parents.pop_back();
    EXPECT_THROW(unpack_grown_bark(pack_grown_bark(wrong)), Error);
}

TEST(GrownBark, ALevelIsOfTheFirstVertices) {
    const GrownBark bark = with_levels(lozenge(ladder(), 4.0));
    EXPECT_EQ(lighter_bark(bark, 0.0).indices, bark.indices);
    const GrownBark lighter = lighter_bark(bark, 1.0);
    EXPECT_EQ(lighter.vertices.size(), 5U);
    EXPECT_EQ(lighter.indices.size() / 3, 6U);
    for (const uint32_t index : lighter.indices)
        ASSERT_LT(index, 5U);
    // What is cut off above comes back as width.
    EXPECT_NEAR(glm::distance(lighter.vertices[0].position, bark.vertices[0].position), kMostSwell * 0.2f,
                1e-5f);
}

// What comes of damaged bytes can be drawn, or is refused.
TEST(GrownBark, DamagedBytesAreRefused) {
    const std::string packed = pack_grown_bark(with_levels(lozenge(ladder(), 4.0)));
    for (size_t length = 0; length < packed.size(); length++)
        EXPECT_THROW(unpack_grown_bark(std::string_view(packed).substr(0, length)), Error) << length;
    EXPECT_THROW(unpack_grown_bark(packed + "x"), Error);
    int read = 0;
    for (size_t at = 0; at < packed.size(); at++)
        for (int bit = 0; bit < 8; bit++) {
            std::string other = packed;
            other[at] = static_cast<char>(other[at] ^ (1 << bit));
            try {
                const GrownBark bark = unpack_grown_bark(other);
                read++;
                for (const uint32_t index : bark.indices)
                    ASSERT_LT(index, bark.vertices.size());
                for (const GrownBark::Vertex& vertex : bark.vertices) {
                    ASSERT_LT(static_cast<size_t>(vertex.branch), bark.branches.size());
                    ASSERT_TRUE(std::isfinite(vertex.position.x + vertex.along + vertex.normal.y));
                }
                if (bark.parents.empty()) continue;
                const GrownBark lighter = lighter_bark(bark, 1.0);
                for (const uint32_t index : lighter.indices)
                    ASSERT_LT(index, lighter.vertices.size());
            } catch (const Error&) {
            }
        }
    EXPECT_GT(read, 100);
}

TEST(GrownBark, OfANewerVersionIsRefusedWithASentence) {
    std::string packed = pack_grown_bark(lozenge(ladder(), 4.0));
    EXPECT_EQ(packed_bark_version(packed), kGrownBarkVersion);
    packed[std::string("treerec bark").size()] = 7;
    EXPECT_EQ(packed_bark_version(packed), 7U);
    try {
        unpack_grown_bark(packed);
        FAIL() << "It was read.";
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("newer version"), std::string::npos) << error.what();
    }
    EXPECT_EQ(packed_bark_version("no bark at all, but text"), 0U);
}

TEST(GrownBark, FitsUntilTheWoodBeneathChanges) {
    const Tree tree = ladder();
    const GrownBark bark = lozenge(tree, 4.0);
    EXPECT_TRUE(fits(bark, tree));
    EXPECT_FALSE(fits(bark, Tree()));
    for (NodeId id = 0; id < tree.id_end(); id++) {
        // Beneath the bark, and the two nodes above it that bend its axis.
        const bool beneath = id <= 6;
        Tree thicker = tree;
        thicker.set_radius(id, 1.01 * tree.node(id).radius);
        EXPECT_EQ(fits(bark, thicker), !beneath) << id;
        Tree moved = tree;
        moved.set_position(id, tree.node(id).position + DVec3(0.0, 0.0, 1e-9));
        EXPECT_EQ(fits(bark, moved), !beneath) << id;
    }
    GrownBark of_branch = bark;
    of_branch.branches[0].first = 12;  // within a branch: none begins there
    EXPECT_EQ(covered_wood_digest(tree, of_branch.branches), 0U);
    of_branch.branches[0].first = 11;
    EXPECT_NE(covered_wood_digest(tree, of_branch.branches), 0U);
    EXPECT_NE(covered_wood_digest(tree, of_branch.branches), bark.digest);
}

TEST(GrownBark, WithLevelsIsDrawnAtThemToo) {
    const Tree tree = ladder();
    const GrownBark bark = with_levels(lozenge(tree, 4.0));
    LeafRules none;
    none.enabled = false;
    const std::vector<LeafKind> kinds = leaf_kinds(tree, none);
    const LevelBuilder builder(tree, kinds, 1, {}, nullptr, &bark), tubes(tree, kinds, 1);
    for (int level = 0; level <= 4; level++) {
        const Mesh mesh = builder.build(level).bark;
        EXPECT_GE(farthest(mesh), 0.9 - 1e-6) << level;
        for (const Vec3& place : mesh.positions) {
            ASSERT_GE(place.z, builder.box().min.z - 1e-6);
            ASSERT_LE(place.z, builder.box().max.z + 1e-6);
        }
    }
    // Below that few triangles count for more.
    EXPECT_EQ(builder.build(5).bark.indices.size(), tubes.build(5).bark.indices.size());
    const TreeLevel small = builder.build(0, 60);
    EXPECT_LE(small.triangle_count(), 60U);
}

TEST(GrownBark, WithoutLevelsIsDrawnAtTheFinestLevelAlone) {
    const Tree tree = ladder();
    const GrownBark bark = lozenge(tree, 4.0);
    LeafRules none;
    none.enabled = false;
    const std::vector<LeafKind> kinds = leaf_kinds(tree, none);
    const LevelBuilder builder(tree, kinds, 1, {}, nullptr, &bark), tubes(tree, kinds, 1);
    EXPECT_NEAR(farthest(builder.build(0).bark), 0.9, 1e-6);
    for (int level = 1; level < 3; level++) {
        EXPECT_LT(farthest(builder.build(level).bark), 0.4);
        EXPECT_EQ(builder.build(level).bark.positions.size(), tubes.build(level).bark.positions.size());
    }
    EXPECT_NEAR(farthest(build_level_bark(tree, 0.0, {.grown = &bark})), 0.9, 1e-6);
    EXPECT_NEAR(builder.box().min.z, -0.9, 1e-6);
    EXPECT_NEAR(builder.box().max.z, 0.9, 1e-6);
    // The wind takes it along with the wood.
    const Mesh mesh = builder.build(0).bark;
    EXPECT_EQ(mesh.wind.size(), mesh.positions.size());
    EXPECT_EQ(mesh.colors.size(), mesh.positions.size());
}

}  // namespace
