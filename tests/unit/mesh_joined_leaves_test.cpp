// All leaves in one mesh.
#include "mesh/joined_leaves.h"

#include <gtest/gtest.h>

#include "mesh/leaf_cards.h"
#include "random_tree.h"

namespace treerec {
namespace {

TEST(JoinedLeaves, SayOfEachVertexWhatTheBufferSaysOfItsLeaf) {
    for (uint64_t seed = 1; seed <= 12; seed++) {
        SCOPED_TRACE(seed);
        LeafRules rules = leaf_preset(seed % 3 == 0 ? "oak" : seed % 3 == 1 ? "pine" : "palm");
        const std::vector<LeafPlacement> leaves =
            thin_leaves(place_leaves(test::random_tree(seed, 120), rules, seed), static_cast<int>(seed % 4));
        ASSERT_FALSE(leaves.empty());
        const Mesh card = build_leaf_card(rules, static_cast<int>(seed % 4));
        const JoinedLeaves joined = join_leaves(leaves, card);
        const std::vector<float> buffer = leaf_buffer(leaves);
        const size_t corners = card.positions.size();
        ASSERT_EQ(joined.mesh.positions.size(), leaves.size() * corners);
        ASSERT_EQ(joined.mesh.indices.size(), leaves.size() * card.indices.size());
        for (size_t i = 0; i < leaves.size(); i++) {
            const float* b = &buffer[20 * i];
            const glm::mat3 axes(b[0], b[4], b[8], b[1], b[5], b[9], b[2], b[6], b[10]);
            const Vec3 origin(b[3], b[7], b[11]);
            for (size_t k = 0; k < corners; k++) {
                const size_t v = i * corners + k;
                ASSERT_LT(glm::distance(joined.mesh.positions[v], axes * card.positions[k] + origin), 1e-4f);
                ASSERT_LT(glm::distance(joined.mesh.normals[v], glm::normalize(axes * card.normals[k])),
                          1e-3f);
                ASSERT_LT(glm::distance(Vec3(joined.mesh.custom0[v]), leaves[i].position), 1e-6f);
                ASSERT_EQ(joined.mesh.custom0[v].w, b[16]);
                const Vec3 outward = axes * (2.0f * Vec3(b[12], b[13], b[14]) - 1.0f) / leaves[i].size;
                ASSERT_LT(glm::distance(2.0f * Vec3(joined.mesh.colors[v]) - 1.0f, outward), 1e-4f);
                ASSERT_EQ(joined.mesh.colors[v].a, b[15]);
                ASSERT_EQ(joined.lengthwise[v], Vec4(leaves[i].y, b[17]));
                ASSERT_EQ(joined.across[v], Vec4(leaves[i].x, b[18]));
                ASSERT_EQ(joined.secondary[v], b[19]);
            }
            for (size_t k = 0; k < card.indices.size(); k++)
                ASSERT_EQ(joined.mesh.indices[i * card.indices.size() + k], i * corners + card.indices[k]);
        }
    }
}

TEST(JoinedLeaves, NoLeavesAreNoMesh) {
    const JoinedLeaves joined = join_leaves({}, build_leaf_card(0));
    EXPECT_TRUE(joined.mesh.indices.empty());
    EXPECT_TRUE(joined.across.empty());
}

TEST(JoinedLeaves, CanBeCancelled) {
    const std::vector<LeafPlacement> leaves = place_leaves(test::random_tree(1, 50), leaf_preset("oak"), 1);
    struct Stopped final : Progress {
        bool cancelled() const override { return true; }
    } progress;
    EXPECT_THROW(join_leaves(leaves, build_leaf_card(0), &progress), Cancelled);
}

}  // namespace
}  // namespace treerec
