// Leaf cards as they are baked into meshes: where the shader puts them, and lit as it lights them.
#include <gtest/gtest.h>

#include "foliage/crown.h"
#include "foliage/leaves.h"
#include "mesh/leaf_cards.h"
#include "random_tree.h"

namespace treerec {
namespace {

TEST(LeafCards, CardsAreSoundAndFaceUp) {
    for (int level = 0; level < 3; level++) {
        const Mesh card = build_leaf_card(level);
        EXPECT_GE(card.triangle_count(), level == 0 ? 4u : 2u);
        ASSERT_EQ(card.uvs.size(), card.positions.size());
        for (size_t i = 0; i < card.positions.size(); i++) {
            EXPECT_NEAR(card.uvs[i].x, card.positions[i].x + 0.5f, 1e-6f);
            EXPECT_NEAR(card.uvs[i].y, 1.0f - card.positions[i].y, 1e-6f);
            EXPECT_GT(card.normals[i].z, 0.8f);
            EXPECT_NEAR(glm::dot(Vec3(card.tangents[i]), card.normals[i]), 0.0f, 1e-5f);
        }
        for (size_t i = 0; i < card.indices.size(); i += 3) {
            const Vec3 a = card.positions[card.indices[i]], b = card.positions[card.indices[i + 1]],
                       c = card.positions[card.indices[i + 2]];
            EXPECT_GT(glm::cross(b - a, c - a).z, 0.0f);
        }
    }
}

TEST(LeafCards, BakedLeavesLieWhereTheBufferPutsThem) {
    const std::vector<LeafPlacement> leaves =
        place_leaves(test::random_tree(6, 400), leaf_preset("cherry"), 3);
    const Mesh card = build_leaf_card(), mesh = bake_leaves(leaves);
    const std::vector<float> buffer = leaf_buffer(leaves);
    ASSERT_EQ(buffer.size(), leaves.size() * 20);
    const size_t corners = card.positions.size();
    ASSERT_EQ(mesh.positions.size(), leaves.size() * corners * 2);  // the upper faces and the lower ones
    ASSERT_EQ(mesh.indices.size(), leaves.size() * card.indices.size() * 2);
    size_t mirrored = 0;
    for (size_t i = 0; i < leaves.size(); i++) {
        mirrored += shows_mirrored(leaves[i]);
        const float* row = buffer.data() + i * 20;
        for (size_t k = 0; k < 2 * corners; k++) {
            const float apart = k < corners ? 0.0005f : -0.0005f;  // half of a leaf's thickness
            const Vec3 p = card.positions[k % corners] + card.normals[k % corners] * apart;
            const size_t v = i * corners * 2 + k;
            for (int axis = 0; axis < 3; axis++)
                ASSERT_NEAR(mesh.positions[v][axis],
                            row[4 * axis] * p.x + row[4 * axis + 1] * p.y + row[4 * axis + 2] * p.z +
                                row[4 * axis + 3],
                            1e-4f);
            const Vec2 uv = card.uvs[k % corners];
            ASSERT_EQ(mesh.uvs[v], shows_mirrored(leaves[i]) ? Vec2(1.0f - uv.x, uv.y) : uv);
            ASSERT_NEAR(glm::length(mesh.normals[v]), 1.0f, 1e-4f);
            ASSERT_NEAR(glm::length(Vec3(mesh.tangents[v])), 1.0f, 1e-4f);
            ASSERT_NEAR(glm::dot(Vec3(mesh.tangents[v]), mesh.normals[v]), 0.0f, 1e-3f);
        }
        const Vec3 outward = Vec3(row[12], row[13], row[14]) * 2.0f - 1.0f;
        const Vec3 world = leaves[i].x * outward.x + leaves[i].y * outward.y + leaves[i].z * outward.z;
        ASSERT_NEAR(glm::distance(world, leaves[i].outward), 0.0f, 1e-4f);
        ASSERT_EQ(Vec2(row[17], row[19]), leaves[i].wind);
    }
    EXPECT_NEAR(static_cast<double>(mirrored) / static_cast<double>(leaves.size()), 0.5, 0.15);
}

// Programs without our shader light a face by its vertices' normals, seen from its front, and turn them for a
// face that is seen from behind: leaves of two sides were black wherever one looked at their lower ones.
TEST(LeafCards, BakedLeavesAreLitAlikeFromBothSides) {
    for (const char* preset : {"oak", "pine", "palm"}) {
        SCOPED_TRACE(preset);
        const LeafRules rules = leaf_preset(preset);
        const std::vector<LeafPlacement> leaves = place_leaves(test::random_tree(7, 400), rules, 3);
        const Mesh card = build_leaf_card(rules), mesh = bake_leaves(leaves, card);
        ASSERT_GT(leaves.size(), 20u);
        const size_t corners = card.positions.size(), indices = card.indices.size();
        size_t outward = 0, faces = 0;
        const auto face = [&](size_t at) {
            const Vec3 a = mesh.positions[mesh.indices[at]];
            return glm::cross(mesh.positions[mesh.indices[at + 1]] - a,
                              mesh.positions[mesh.indices[at + 2]] - a);
        };
        for (size_t i = 0; i < leaves.size(); i++) {
            for (size_t k = 0; k < indices; k += 3) {
                const Vec3 up = face(2 * i * indices + k), down = face((2 * i + 1) * indices + k);
                ASSERT_LT(glm::dot(up, down), -0.9f * glm::dot(up, up));
            }
            for (size_t k = 0; k < corners; k++) {
                const size_t upper = 2 * i * corners + k, lower = upper + corners;
                const glm::mat3 turn(leaves[i].x, leaves[i].y, leaves[i].z);
                const Vec3 flat = turn * card.normals[k];
                const Vec3 along = turn * glm::cross(card.normals[k], Vec3(card.tangents[k]));
                for (const size_t v : {upper, lower}) {
                    const Vec3 normal = mesh.normals[v], seen = v == upper ? flat : -flat;
                    // Not away from whoever sees the face,
                    ASSERT_GT(glm::dot(normal, seen), 0.04f);
                    const Vec3 tangent(mesh.tangents[v]);
                    ASSERT_NEAR(glm::length(tangent), 1.0f, 1e-4f);
                    ASSERT_NEAR(glm::dot(tangent, normal), 0.0f, 1e-3f);
                    // and the picture's relief lies as it does on the card.
                    ASSERT_GE(glm::dot(glm::cross(normal, tangent) * mesh.tangents[v].w,
                                       along * card.tangents[k].w),
                              -1e-4f);
                    outward += glm::dot(normal, leaves[i].outward) > 0.0f;
                    faces++;
                }
                const Vec3 apart = mesh.positions[upper] - mesh.positions[lower];
                ASSERT_GT(glm::dot(apart, turn * card.normals[k]), 0.0f);
                ASSERT_LT(glm::length(apart), 0.0011f * leaves[i].size);
            }
        }
        // Half of them, were they turned to whoever looks.
        EXPECT_GT(static_cast<double>(outward), 0.8 * static_cast<double>(faces));
    }
}

// A leaf at a crown's lower side, as leaf.gdshader lights it: by the side of it that looks to where the
// crown's light comes from, not to where the crown ends.
TEST(LeafCards, BakedLeavesAreLitFromWhereTheShaderSaysSo) {
    LeafPlacement leaf = place_leaves(test::random_tree(7, 40), leaf_preset("oak"), 3).at(0);
    leaf.x = {1.0f, 0.0f, 0.0f};
    leaf.y = {0.0f, 0.0f, -1.0f};
    leaf.z = {0.0f, 1.0f, 0.0f};
    leaf.outward = glm::normalize(Vec3(1.0f, -0.4f, 0.0f));
    const Vec3 lit = 0.65f * leaf.outward + Vec3(0.0f, 0.35f, 0.0f);
    ASSERT_GT(lit.y, 0.0f);
    const Mesh card = build_leaf_card(), mesh = bake_leaves({leaf}, card);
    const size_t corners = card.positions.size();
    size_t plain = 0;
    for (size_t k = 0; k < corners; k++) {
        const glm::mat3 turn(leaf.x, leaf.y, leaf.z);
        const Vec3 flat = turn * card.normals[k];
        const float side = glm::dot(flat, lit) < 0.0f ? -1.0f : 1.0f;
        const Vec3 wanted = glm::normalize(0.35f * side * flat + lit);
        // The face that looks there has just that normal.
        if (side * glm::dot(flat, wanted) < 0.05f) continue;
        plain++;
        EXPECT_NEAR(glm::distance(mesh.normals[side < 0.0f ? corners + k : k], wanted), 0.0f, 1e-4f);
    }
    EXPECT_GT(plain, corners / 2);
}

}  // namespace
}  // namespace treerec
