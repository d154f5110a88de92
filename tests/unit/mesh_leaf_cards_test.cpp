#include "mesh/leaf_cards.h"

#include <gtest/gtest.h>

#include "error.h"
#include "mesh/leaf_shapes.h"

namespace treerec {
namespace {

LeafRules of_form(LeafForm form, int leaflets) {
    LeafRules rules;
    rules.form = form;
    rules.leaflets = leaflets;
    rules.petiole = 0.05;
    return rules;
}

std::shared_ptr<LeafSprig> forked_sprig() {
    auto sprig = std::make_shared<LeafSprig>();
    sprig->wood.add_root({0, 0, 0}, 0.01);
    const NodeId fork = sprig->wood.add_child(0, {0, 1, 0}, 0.01);
    sprig->wood.add_child(fork, {0, 2, 0}, 0.005);
    sprig->wood.add_child(fork, {0.7, 1.7, 0}, 0.005);
    return sprig;
}

void expect_sound(const Mesh& card) {
    ASSERT_GT(card.indices.size(), 0u);
    ASSERT_EQ(card.normals.size(), card.positions.size());
    ASSERT_EQ(card.tangents.size(), card.positions.size());
    ASSERT_EQ(card.uvs.size(), card.positions.size());
    ASSERT_EQ(card.colors.size(), card.positions.size());
    for (size_t i = 0; i < card.positions.size(); i++) {
        EXPECT_TRUE(is_finite(DVec3(card.positions[i])));
        EXPECT_NEAR(glm::length(card.normals[i]), 1.0f, 1e-4f);
        EXPECT_NEAR(glm::length(Vec3(card.tangents[i])), 1.0f, 1e-4f);
        EXPECT_NEAR(glm::dot(Vec3(card.tangents[i]), card.normals[i]), 0.0f, 1e-4f);
        EXPECT_GE(card.uvs[i].x, -1e-5f);
        EXPECT_LE(card.uvs[i].x, 1.0f + 1e-5f);
        EXPECT_GE(card.uvs[i].y, -1e-5f);
        EXPECT_LE(card.uvs[i].y, 1.0f + 1e-5f);
        EXPECT_GE(card.colors[i].g, 0.0f);
        EXPECT_LE(card.colors[i].g, 1.0f);
    }
    for (size_t i = 0; i < card.indices.size(); i += 3) {
        ASSERT_LT(card.indices[i], card.positions.size());
        const Vec3 a = card.positions[card.indices[i]], b = card.positions[card.indices[i + 1]],
                   c = card.positions[card.indices[i + 2]];
        const Vec3 face = glm::cross(b - a, c - a);
        EXPECT_GT(glm::length(face), 0.0f);
        EXPECT_GT(glm::dot(face, card.normals[card.indices[i]]), 0.0f);
    }
}

TEST(LeafCards, EveryFormIsSoundAndGetsLighter) {
    for (const LeafForm form : {LeafForm::kSpray, LeafForm::kSimple, LeafForm::kPinnate, LeafForm::kPalmate,
                                LeafForm::kNeedles, LeafForm::kSprig})
        for (const int leaflets : {1, 2, 3, 5, 7, 24, 128}) {
            LeafRules rules = of_form(form, leaflets);
            if (form == LeafForm::kSprig) rules.sprig = forked_sprig();
            for (const double curl : {-90.0, 0.0, 18.0, 90.0}) {
                rules.curl = curl;
                size_t triangles = SIZE_MAX;
                for (int level = 0; level < 4; level++) {
                    SCOPED_TRACE(testing::Message()
                                 << static_cast<int>(form) << " " << leaflets << " " << curl << " " << level);
                    const Mesh card = build_leaf_card(rules, level);
                    expect_sound(card);
                    EXPECT_LE(card.triangle_count(), triangles);
                    triangles = card.triangle_count();
                }
            }
        }
}

// Pieces of the card that hang together by their vertices.
size_t islands(const Mesh& card) {
    std::vector<uint32_t> of(card.positions.size());
    for (uint32_t i = 0; i < of.size(); i++)
        of[i] = i;
    const auto find = [&](uint32_t i) {
        while (of[i] != i)
            i = of[i];
        return i;
    };
    for (size_t i = 0; i < card.indices.size(); i += 3)
        for (size_t k = 1; k < 3; k++)
            of[find(card.indices[i + k])] = find(card.indices[i]);
    size_t count = 0;
    for (uint32_t i = 0; i < of.size(); i++)
        count += of[i] == i;
    return count;
}

TEST(LeafCards, CompoundLeavesHaveTheirLeaflets) {
    for (const int leaflets : {1, 2, 5, 7, 12}) {
        const auto pieces = static_cast<size_t>(leaflets) + 1;  // and the stalk
        EXPECT_EQ(islands(build_leaf_card(of_form(LeafForm::kPinnate, leaflets))), pieces);
        EXPECT_EQ(islands(build_leaf_card(of_form(LeafForm::kPalmate, leaflets))), pieces);
        EXPECT_EQ(islands(build_leaf_card(of_form(LeafForm::kNeedles, leaflets))), pieces);
    }
    LeafRules sprig;
    sprig.form = LeafForm::kSprig;
    sprig.sprig = forked_sprig();
    EXPECT_EQ(islands(build_leaf_card(sprig)), 5u);  // three pieces of wood, a leaf at both tips
    sprig.sprig = nullptr;
    EXPECT_EQ(islands(build_leaf_card(sprig)), 1u);  // one leaf instead
}

TEST(LeafCards, ThePetioleCarriesTheBlade) {
    LeafRules rules = of_form(LeafForm::kSimple, 1);
    rules.curl = 0.0;
    rules.leaf_size = 0.1;
    for (const double petiole : {0.0, 0.03, 0.2}) {
        rules.petiole = petiole;
        const Mesh card = build_leaf_card(rules, 1);
        float top = 0.0f, low = 1e9f;
        for (size_t i = 0; i < card.positions.size(); i++) {
            top = std::max(top, card.positions[i].y);
            if (card.uvs[i].y < 1.0f - kBladeStalk + 1e-5f && std::abs(card.positions[i].x) > 0.1f)
                low = std::min(low, card.positions[i].y);
        }
        EXPECT_NEAR(top, 1.0 + petiole / 0.1, 1e-4);
        EXPECT_NEAR(low, petiole / 0.1, 1e-4);
    }
}

TEST(LeafCards, TooLargeASprigIsRefused) {
    auto sprig = std::make_shared<LeafSprig>();
    NodeId at = sprig->wood.add_root({0, 0, 0}, 0.01);
    for (size_t i = 0; i <= kMostSprigParts; i++)
        at = sprig->wood.add_child(at, {0, 0.01 * static_cast<double>(i + 1), 0}, 0.01);
    LeafRules rules;
    rules.form = LeafForm::kSprig;
    rules.sprig = sprig;
    EXPECT_THROW(build_leaf_card(rules), Error);
}

// What the blade's picture stretches, the rule puts right.
TEST(LeafCards, PresetsKnowTheirBladesWidth) {
    for (const std::string& name : leaf_preset_names()) {
        if (!leaf_preset(name).enabled) continue;
        const texture::BladeBox box = texture::box_of(texture::spray_of(name).shape);
        const double width = leaf_preset(name).blade_width;
        EXPECT_NEAR(width / box.width_over_length(), 1.0, 0.15) << name << " " << box.width_over_length();
    }
}

}  // namespace
}  // namespace treerec
