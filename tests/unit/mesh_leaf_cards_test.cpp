#include "mesh/leaf_cards.h"

#include <gtest/gtest.h>

#include <cmath>

#include "error.h"
#include "textures/leaf_shapes.h"

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
                rules.fold = 0.5 * curl;
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

double degrees_between(const Vec3& a, const Vec3& b) {
    const DVec3 u(glm::normalize(a)), v(glm::normalize(b));
    return std::atan2(glm::length(glm::cross(u, v)), glm::dot(u, v)) * 180.0 / kPi;
}

// Looks at every row of three vertices: how far both halves sink from the middle one, in degrees, and whether
// their normals do, too. Returns the number of rows.
size_t expect_folded(const Mesh& card, double fold) {
    size_t rows = 0;
    for (size_t i = 1; i + 1 < card.positions.size(); i++) {
        const Vec3 right = card.positions[i + 1] - card.positions[i],
                   left = card.positions[i - 1] - card.positions[i];
        if (std::abs(card.uvs[i].x - 0.5f) > 1e-6f || card.uvs[i + 1].x < 1.0f) continue;
        rows++;
        EXPECT_NEAR(degrees_between(left, right), 180.0 - 2.0 * std::abs(fold), 0.1);
        EXPECT_EQ(glm::dot(left + right, card.normals[i]) < 0.0f, fold > 0.0);
        EXPECT_NEAR(degrees_between(card.normals[i - 1], card.normals[i + 1]), 2.0 * std::abs(fold), 0.1);
        EXPECT_NEAR(glm::dot(card.normals[i + 1], glm::normalize(right)), 0.0f, 1e-3f);
        EXPECT_NEAR(glm::dot(card.normals[i - 1], glm::normalize(left)), 0.0f, 1e-3f);
    }
    return rows;
}

TEST(LeafCards, BothHalvesAreFoldedAtEveryLevel) {
    LeafRules rules;
    for (const double fold : {-45.0, -12.0, 10.0, 30.0, 60.0})
        for (const double curl : {-60.0, 0.0, 18.0, 75.0})
            for (int level = 0; level < 4; level++) {
                SCOPED_TRACE(testing::Message() << fold << " " << curl << " " << level);
                rules.fold = fold;
                rules.curl = curl;
                rules.form = LeafForm::kSpray;
                const Mesh spray = build_leaf_card(rules, level);
                EXPECT_EQ(expect_folded(spray, fold) * 3, spray.positions.size());
                rules.form = LeafForm::kSimple;
                for (const double width : {0.06, 1.0}) {
                    rules.blade_width = width;
                    EXPECT_GE(expect_folded(build_leaf_card(rules, level), -fold), 2u);
                }
                LeafRules flat_spray = rules;
                flat_spray.form = LeafForm::kSpray;
                flat_spray.fold = 0.0;
                if (level > 0) {
                    EXPECT_LE(2 * spray.positions.size(),
                              3 * build_leaf_card(flat_spray, level).positions.size());
                }
            }
}

// The frond of a palm was a line from the side at all levels but the finest.
TEST(LeafCards, PalmFrondsAreSeenFromTheSideAtEveryLevel) {
    for (int level = 0; level < 4; level++)
        EXPECT_GT(expect_folded(build_leaf_card(leaf_preset("palm"), level), 30.0), 2u) << level;
}

TEST(LeafCards, WithoutAFoldCardsAreFlat) {
    for (const LeafForm form : {LeafForm::kSpray, LeafForm::kSimple, LeafForm::kPinnate, LeafForm::kPalmate})
        for (int level = 0; level < 3; level++) {
            LeafRules rules = of_form(form, 7);
            rules.fold = rules.curl = 0.0;
            const Mesh card = build_leaf_card(rules, level);
            for (const Vec3& position : card.positions)  // a spray's own bow is along it alone
                EXPECT_NEAR(position.z, form == LeafForm::kSpray && level == 0 ? -0.16f * position.y : 0.0f,
                            1e-5f);
        }
}

TEST(LeafCards, LeafletsAreTurnedAboutTheStalk) {
    for (const LeafForm form : {LeafForm::kPinnate, LeafForm::kPalmate})
        for (const int leaflets : {2, 7, 24})
            for (const double fold : {-30.0, 8.0, 45.0})
                for (int level = 0; level < 4; level++) {
                    SCOPED_TRACE(testing::Message()
                                 << static_cast<int>(form) << " " << leaflets << " " << fold << " " << level);
                    LeafRules rules = of_form(form, leaflets);
                    rules.curl = 0.0;
                    rules.fold = fold;
                    const Mesh card = build_leaf_card(rules, level);
                    Vec3 left(0.0f), right(0.0f);
                    double down = 0.0;
                    for (size_t i = 0; i < card.positions.size(); i++) {
                        // Of the leaflets' tips alone; the middle one stays.
                        if (card.uvs[i].y > 0.01f || std::abs(card.tangents[i].y) < 1e-3f) continue;
                        (card.tangents[i].y > 0.0f ? left : right) += card.normals[i];
                        down -= card.positions[i].z;
                    }
                    EXPECT_NEAR(degrees_between(left, right), 2.0 * std::abs(fold), 0.5);
                    EXPECT_EQ(down > 0.0, fold > 0.0);
                    rules.fold = 0.0;
                    if (level > 0) {
                        EXPECT_EQ(card.positions.size(), build_leaf_card(rules, level).positions.size());
                    }
                }
}

// Crowns of sprays are made of thousands of cards.
TEST(LeafCards, BroadLeavesStayOneQuadFromAfar) {
    for (const std::string& name : leaf_preset_names()) {
        if (name == "palm" || name == "none") continue;
        EXPECT_EQ(build_leaf_card(leaf_preset(name), 0).triangle_count(), 4u) << name;
        EXPECT_EQ(build_leaf_card(leaf_preset(name), 1).triangle_count(), 2u) << name;
    }
    EXPECT_EQ(build_leaf_card(0).positions[4], Vec3(0.0f, 0.5f, 0.07f));
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
