// A tree's outline in photos: recall, precision and intersection over union with masks.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <glm/gtc/quaternion.hpp>

#include "cli_runner.h"
#include "error.h"
#include "exchange/material_textures.h"
#include "fidelity/photo_overlap.h"
#include "fidelity/sample_mask.h"
#include "geometry/parallel.h"
#include "photo_orbit.h"
#include "photos/pinhole_view.h"
#include "synth/grow.h"

namespace treerec {
namespace {

using test::box;
using test::masks_of;
using test::orbit;
using test::same_frame;

const Vec3 kLow(-0.4F, 0.2F, -0.4F), kHigh(0.4F, 2.2F, 0.4F);

TEST(PhotoOverlap, IsWholeWhereTheOutlineIsTheMask) {
    const PhotoModel model = orbit(6, 4.0, 1.2);
    const std::vector<OutlinePart> parts{box(kLow, kHigh)};
    const OutlineOverlap found = measure_overlap(parts, same_frame(), model, masks_of(model, kLow, kHigh));
    ASSERT_EQ(found.photos.size(), 6u);
    for (const PhotoOverlap& photo : found.photos) {
        // The mask has every pixel that its outline touches, which is half a pixel too many.
        EXPECT_GT(photo.overlap.iou, 0.96) << photo.name;
        EXPECT_GT(photo.overlap.recall, 0.96) << photo.name;
        EXPECT_GT(photo.overlap.precision, 0.98) << photo.name;
    }
}

// The upper half alone: half of the mask is missing, nothing is wrong; and the other way round.
TEST(PhotoOverlap, TellsWhatIsMissingFromWhatIsTooMuch) {
    const PhotoModel model = orbit(5, 6.0, 1.2);
    const Vec3 middle(kLow.x, 1.2F, kLow.z);
    const std::vector<OutlinePart> half{box(middle, kHigh)}, whole{box(kLow, kHigh)};
    const OutlineOverlap less = measure_overlap(half, same_frame(), model, masks_of(model, kLow, kHigh));
    EXPECT_NEAR(less.mean.recall, 0.5, 0.04);
    EXPECT_GT(less.mean.precision, 0.97);
    EXPECT_NEAR(less.mean.iou, 0.5, 0.04);
    const OutlineOverlap more = measure_overlap(whole, same_frame(), model, masks_of(model, middle, kHigh));
    EXPECT_GT(more.mean.recall, 0.95);
    EXPECT_NEAR(more.mean.precision, 0.5, 0.04);
    EXPECT_NEAR(more.mean.iou, 0.5, 0.04);
}

TEST(PhotoOverlap, HolesInALeafAreHoles) {
    const PhotoModel model = orbit(4, 4.0, 1.2);
    OutlinePart card;
    card.mesh.positions = {{-0.4F, 0.2F, 0.0F}, {0.4F, 0.2F, 0.0F}, {0.4F, 2.2F, 0.0F}, {-0.4F, 2.2F, 0.0F}};
    card.mesh.uvs = {{0.0F, 1.0F}, {1.0F, 1.0F}, {1.0F, 0.0F}, {0.0F, 0.0F}};
    card.mesh.indices = {0, 1, 2, 0, 2, 3};
    card.cut_out = Image(16, 16, 4);
    for (int y = 0; y < 8; y++)
        for (int x = 0; x < 16; x++)
            card.cut_out.at(x, y)[3] = 255;  // the upper half
    const std::vector<OutlinePart> parts{card};
    const std::vector<Image> masks = masks_of(model, {kLow.x, 1.2F, -1e-3F}, {kHigh.x, kHigh.y, 1e-3F});
    const OutlineOverlap found = measure_overlap(parts, same_frame(), model, masks);
    // Two photos look along the card.
    int flat = 0;
    for (const PhotoOverlap& photo : found.photos)
        flat += photo.overlap.iou > 0.97;
    EXPECT_EQ(flat, 2);
}

TEST(PhotoOverlap, OfATreeItselfIsWholeOnAnyNumberOfThreads) {
    Tree tree = grow_tree({});
    const PhotoModel model = orbit(3, 1.6 * tree.node(tree.root()).position.y + 12.0, 3.0);
    const LeafRules oak = leaf_preset("oak");
    const std::vector<OutlinePart> bare = outline_parts(tree, leaf_preset("none"), "none", 1, {});
    const std::vector<OutlinePart> leafy = outline_parts(tree, oak, "oak", 1, {});
    ASSERT_EQ(bare.size(), 1u);
    ASSERT_EQ(leafy.size(), 2u);
    // Masks of the bare tree: its own drawing, thresholded.
    std::vector<Image> masks;
    PhotoModel straight = model;
    straight.cameras =
        parse_photo_model("1 PINHOLE 320 240 300 300 160 120\n", "1 1 0 0 0 0 0 5 1 a.jpg\n\n", true, "")
            .cameras;
    for (const Photo& photo : straight.photos) {
        const PinholeView view = pinhole_view(photo, straight.cameras[0], same_frame());
        SampleMask drawn(view.width, view.height);
        for (size_t i = 0; i + 2 < bare[0].mesh.indices.size(); i += 3) {
            DVec2 corners[3];
            for (int k = 0; k < 3; k++)
                corners[k] = 4.0 * *view.project(DVec3(bare[0].mesh.positions[bare[0].mesh.indices[i + k]]));
            drawn.fill(corners);
        }
        Image mask(view.width, view.height, 1);
        for (int y = 0; y < view.height; y++)
            for (int x = 0; x < view.width; x++)
                *mask.at(x, y) = static_cast<uint8_t>(drawn.covered(x, y) >= 8 ? 255 : 0);
        masks.push_back(std::move(mask));
    }
    const OutlineOverlap own = measure_overlap(bare, same_frame(), straight, masks);
    EXPECT_GT(own.mean.recall, 0.8);  // twigs are thinner than a pixel here
    EXPECT_GT(own.mean.iou, 0.5);
    const OutlineOverlap with_leaves = measure_overlap(leafy, same_frame(), straight, masks);
    EXPECT_GE(with_leaves.mean.recall, own.mean.recall);
    EXPECT_LT(with_leaves.mean.precision, 0.8 * own.mean.precision);
    set_thread_count(1);
    const OutlineOverlap again = measure_overlap(leafy, same_frame(), straight, masks);
    set_thread_count(0);
    EXPECT_EQ(with_leaves.mean.iou, again.mean.iou);
}

TEST(PhotoOverlap, WhatCanNotBeComparedIsSaid) {
    const PhotoModel model = orbit(2, 4.0, 1.2);
    const std::vector<OutlinePart> parts{box(kLow, kHigh)};
    const std::vector<Image> black(2, Image(320, 240, 1));
    EXPECT_THROW(measure_overlap(parts, same_frame(), model, black), Error);
    EXPECT_THROW(measure_overlap(parts, same_frame(), model, {}), Error);
    EXPECT_THROW(measure_overlap(parts, same_frame(), model, std::vector<Image>(2, Image(10, 10, 1))), Error);
    EXPECT_THROW(measure_overlap(parts, same_frame(), {}, {}), Error);
    // From within, and with what is not finite: nothing is drawn, nothing breaks.
    OutlinePart wild = box(Vec3(-50.0F), Vec3(50.0F));
    wild.mesh.positions[3] = Vec3(1e30F);
    const std::vector<OutlinePart> around{wild};
    EXPECT_NO_THROW(measure_overlap(around, same_frame(), model, masks_of(model, kLow, kHigh)));
}

TEST(HeldOut, IsEveryNthAndTheOthersAreTheRest) {
    const PhotoModel model = orbit(11, 4.0, 1.2);
    for (const size_t every : {0u, 2u, 5u, 11u, 12u}) {
        const PhotoModel held = held_out(model, every), rest = without_held_out(model, every);
        EXPECT_EQ(held.photos.size(), every == 0 ? 0u : 11u / every);
        EXPECT_EQ(held.photos.size() + rest.photos.size(), 11u);
        for (const Photo& photo : held.photos)
            for (const Photo& other : rest.photos)
                EXPECT_NE(photo.name, other.name);
    }
    EXPECT_EQ(held_out(model, 5).photos[0].name, "e");
}

class ScoreCli : public test::Cli {};

TEST_F(ScoreCli, TellsTheOutline) {
    ASSERT_EQ(run("synth -o s --seed 3 --quiet").code, 0);
    const PhotoModel model = orbit(4, 12.0, 4.0);
    test::fs::create_directories(folder_ / "model");
    test::fs::create_directories(folder_ / "masks");
    put("model/cameras.txt", "1 SIMPLE_RADIAL 320 240 300 160 120 -0.05\n");
    std::string images;
    for (const Photo& photo : model.photos) {
        // The tree file is Z up: (x, y, z) there is (x, z, -y) here.
        const DMat3 up(DVec3(1, 0, 0), DVec3(0, 0, -1), DVec3(0, 1, 0));
        const glm::dquat q = glm::quat_cast(photo.turn() * up);
        images += std::to_string(images.size() + 1);
        for (const double v :
             {q.w, q.x, q.y, q.z, photo.translation.x, photo.translation.y, photo.translation.z})
            images += " " + std::to_string(v);
        images += " 1 " + photo.name + "\n\n";
        Image white(320, 240, 3);
        std::fill(white.pixels.begin(), white.pixels.end(), uint8_t{255});
        const std::vector<uint8_t> png = encode_png(white);
        put("masks/" + photo.name + ".png", std::string(png.begin(), png.end()));
    }
    put("model/images.txt", images);
    const std::string words = "score s/truth.txt s/scan.ply --photos model --masks masks --json";
    const auto share = [](const std::string& json, const std::string& name) {
        const size_t at = json.find("\"" + name + "\": ");
        return at == std::string::npos ? -1.0 : std::stod(json.substr(at + name.size() + 4));
    };
    const test::Outcome bare = run(words), leafy = run(words + " --leaves oak"),
                        one = run(words + " --every 4");
    for (const test::Outcome& outcome : {bare, leafy, one}) {
        ASSERT_EQ(outcome.code, 0) << outcome.error;
        // Of a white picture a tree covers a part, and nothing lies beside it.
        EXPECT_GT(share(outcome.out, "recall"), 0.005) << outcome.out;
        EXPECT_NEAR(share(outcome.out, "precision"), 1.0, 1e-9);
        EXPECT_DOUBLE_EQ(share(outcome.out, "recall"), share(outcome.out, "iou"));
        EXPECT_GE(share(outcome.out, "R_3d_seen"), share(outcome.out, "R_3d"));
    }
    EXPECT_GT(share(leafy.out, "recall"), 2.0 * share(bare.out, "recall"));
    EXPECT_NEAR(share(one.out, "I"), 0.2, 1e-9);
    EXPECT_NEAR(share(run(words + " --view-weight 0.5").out, "I"), 1.0 - 0.0625, 1e-9);
    EXPECT_EQ(run(words + " --every 5").code, 1);
    EXPECT_EQ(run(words + " --leaves grass").code, 2);
    for (const char* option : {"--every 4", "--leaves oak", "--view-weight 0.5"})
        EXPECT_EQ(run(std::string("score s/truth.txt s/scan.ply ") + option).code, 2) << option;
}

}  // namespace
}  // namespace treerec
