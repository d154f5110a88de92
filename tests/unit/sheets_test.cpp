// The sheets, and what they are made of: pipeline/sheets.h, panels.h, lettering.h.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "cli_runner.h"
#include "error.h"
#include "exchange/material_textures.h"
#include "file_bytes.h"
#include "geometry/parallel.h"
#include "photos/photo_picture.h"
#include "pipeline/lettering.h"
#include "pipeline/sheets.h"
#include "synth/grow.h"

namespace treerec {
namespace {

using test::Cli;
using test::Outcome;

Image paper(int width, int height) {
    Image image(width, height, 3);
    std::fill(image.pixels.begin(), image.pixels.end(), uint8_t{255});
    return image;
}

// How many pixels of a part of the picture are darker than paper.
int inked(const Image& image, int left, int top, int width, int height) {
    int count = 0;
    for (int y = top; y < top + height; y++)
        for (int x = left; x < left + width; x++)
            count += image.at(x, y)[1] < 200;
    return count;
}

// The letter alone, as bytes: what tells one from another.
std::vector<uint8_t> letter(char c) {
    Image image = paper(24, 32);
    draw_text(image, 4.0, 20.0, std::string(1, c), 14.0, {0, 0, 0});
    return image.pixels;
}

TEST(Lettering, EveryLetterIsAnother) {
    const std::string all = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijkmnopqrstuvwxyz0123456789.,:;-+=%()/_'<>?";
    for (size_t i = 0; i < all.size(); i++)
        for (size_t k = 0; k < i; k++)
            EXPECT_NE(letter(all[i]), letter(all[k])) << all[i] << all[k];
    EXPECT_EQ(letter('~'), letter('?'));
}

TEST(Lettering, AWordIsAsWideAsItSays) {
    for (const std::string text : {"Q = I x R_3d x R_s", "IMG_0012.jpg", "W", "height 23.99 m"}) {
        const double width = text_width(text, 12.0);
        Image image = paper(static_cast<int>(width) + 40, 40);
        draw_text(image, 20.0, 26.0, text, 12.0, {0, 0, 0});
        const int whole = inked(image, 0, 0, image.width, image.height);
        EXPECT_GT(whole, 0);
        EXPECT_EQ(inked(image, 18, 10, static_cast<int>(width) + 4, 22), whole) << text;
        EXPECT_GT(inked(image, 18 + static_cast<int>(width) - 3, 10, 7, 22), 0) << text;
        EXPECT_NEAR(text_width(text, 24.0), 2.0 * width, 1e-9);
    }
    // One mark for a character of several bytes.
    EXPECT_EQ(text_width("\xc3\xa4", 10.0), text_width("?", 10.0));
    // Beyond the borders there is nothing to draw on.
    Image small = paper(8, 8);
    draw_text(small, -20.0, 3.0, "beyond it all", 14.0, {0, 0, 0});
}

// A stem with a bough to +x, and points on both.
struct Subject {
    Tree tree;
    std::vector<OutlinePart> parts;
    PointCloud cloud;

    Subject() {
        ScanFrame frame;
        frame.up = UpAxis::kY;
        tree.set_frame(frame);
        cloud.frame = frame;
        const NodeId root = tree.add_root({0.0, 0.0, 0.0}, 0.15);
        const NodeId fork = tree.add_child(root, {0.0, 2.0, 0.0}, 0.12);
        tree.add_child(fork, {0.0, 4.0, 0.0}, 0.08);
        tree.add_child(fork, {1.4, 3.0, 0.0}, 0.06);
        parts = outline_parts(tree, leaf_preset("none"), "none", 1, {});
        for (int i = 0; i < 4000; i++) {
            const double angle = 0.77 * i, up = 4.0 * i / 4000.0;
            cloud.positions.emplace_back(0.12 * std::cos(angle), up, 0.12 * std::sin(angle));
            cloud.colors.push_back({90, 70, 50});
        }
    }
};

TEST(Panels, SeeAlikeFromTheSameView) {
    const Subject subject;
    Bounds box = box_of(subject.tree, subject.parts, subject.cloud);
    const PanelView view = PanelView::level(box, 0.0, 200, 320);
    const Image bark = tree_panel(view, subject.parts, kPanelBark);
    const Image cloud = cloud_panel(view, subject.cloud);
    const Image axes = skeleton_panel(view, subject.tree);
    for (const Image* image : {&bark, &cloud, &axes}) {
        EXPECT_NEAR(image->width, 200, 1);
        EXPECT_EQ(image->height, 320);
    }
    // Points of the stem, and its axis, lie on the stem's bark.
    int points = 0, off = 0;
    for (int y = 0; y < 320; y++)
        for (int x = 0; x < 200; x++)
            for (const Image* image : {&cloud, &axes})
                if (image->at(x, y)[1] < 200) {
                    points++;
                    off += inked(bark, std::max(x - 2, 0), std::max(y - 2, 0), 5, std::min(5, 318 - y)) == 0;
                }
    EXPECT_GT(points, 2000);
    EXPECT_LT(off, points / 50);
    // The bough is to the right of the stem from the front, and to the left from behind.
    const Image behind = tree_panel(PanelView::level(box, kPi, 200, 320), subject.parts, kPanelBark);
    EXPECT_GT(inked(bark, 0, 60, 100, 80), 2 * inked(bark, 100, 60, 99, 80));
    EXPECT_GT(inked(behind, 100, 60, 99, 80), 2 * inked(behind, 0, 60, 100, 80));
}

// What is seen by a photo's camera lies where the camera's own formula says.
TEST(Panels, APhotosViewIsItsCameras) {
    const Subject subject;
    PinholeView camera;
    camera.centre = {0.3, 1.7, 6.0};
    camera.focal = 300.0;
    camera.principal = {90.0, 170.0};
    camera.width = 200;
    camera.height = 320;
    const PanelView view = PanelView::photo(camera, 6.0);
    const Image bark = tree_panel(view, subject.parts, kPanelBark);
    ASSERT_NEAR(bark.width, 200, 1);
    const SampleMask drawn = drawn_outline(subject.parts, camera);
    int differing = 0, all = 0;
    for (int y = 0; y < 320; y++)
        for (int x = 0; x < 199; x++) {
            const bool is = bark.at(x, y)[1]<240, should = drawn.covered(x, y)> 4;
            differing += is != should;
            all += should;
        }
    EXPECT_GT(all, 1500);
    EXPECT_LT(differing, all / 20);
    // What is behind the camera is not there.
    EXPECT_FALSE(view.place({0.0, 1.0, 7.0}).has_value());
}

TEST(Panels, LeavesHaveHolesAndColours) {
    Mesh card;
    card.positions = {{-1.0F, 0.0F, 0.0F}, {1.0F, 0.0F, 0.0F}, {1.0F, 2.0F, 0.0F}, {-1.0F, 2.0F, 0.0F}};
    card.uvs = {{0.0F, 1.0F}, {1.0F, 1.0F}, {1.0F, 0.0F}, {0.0F, 0.0F}};
    for (const uint32_t i : {0U, 1U, 2U, 0U, 2U, 3U})
        card.indices.push_back(i);
    Image leaf(16, 16, 4);
    for (int y = 0; y < 8; y++)
        for (int x = 0; x < 16; x++) {
            leaf.at(x, y)[1] = 120;
            leaf.at(x, y)[3] = 255;  // the upper half
        }
    Bounds box;
    box.add(DVec3(-1.0, 0.0, 0.0));
    box.add(DVec3(1.0, 2.0, 0.0));
    const std::vector<OutlinePart> parts{{Mesh{}, {}}, {card, leaf}};
    const Image seen = tree_panel(PanelView::level(box, 0.0, 100, 100), parts, kPanelBark);
    EXPECT_GT(seen.at(50, 25)[1], seen.at(50, 25)[0] + 60);
    EXPECT_EQ(seen.at(50, 75)[0], 255);
    EXPECT_THROW(Picture(PictureView{0.0, DVec3(0.0), 1.0, 1.0, 64}).draw_textured(card, paper(4, 4)), Error);
}

TEST(Sheets, HaveTheirPanelsAndAreTheSameOnAnyNumberOfThreads) {
    const Subject subject;
    const Fidelity fidelity = measure_fidelity(subject.tree, subject.cloud);
    const auto both = [&] {
        const SheetSubject shown{"stem", subject.tree, subject.parts, subject.cloud, &subject.tree};
        return std::pair(stages_sheet(shown), fidelity_sheet(shown, {fidelity, subject.cloud}));
    };
    const auto [stages, score] = both();
    set_thread_count(1);
    const auto [again, score_again] = both();
    set_thread_count(0);
    EXPECT_EQ(stages.pixels, again.pixels);
    EXPECT_EQ(score.pixels, score_again.pixels);
    for (const Image* sheet : {&stages, &score}) {
        EXPECT_EQ(sheet->channels, 3);
        EXPECT_GT(sheet->width, 900);
        // Four columns, and in each a picture in either row.
        for (int column = 0; column < 4; column++)
            for (int row = 0; row < 2; row++)
                EXPECT_GT(inked(*sheet, sheet->width * column / 4 + 20, sheet->height * row / 2 + 110,
                                sheet->width / 4 - 40, sheet->height / 2 - 180),
                          100)
                    << column << " " << row;
        // Even margins.
        EXPECT_EQ(inked(*sheet, 0, 0, sheet->width, 20), 0);
        EXPECT_EQ(inked(*sheet, 0, 0, 30, sheet->height), 0);
        EXPECT_EQ(inked(*sheet, sheet->width - 30, 0, 30, sheet->height), 0);
        EXPECT_EQ(inked(*sheet, 0, sheet->height - 12, sheet->width, 12), 0);
    }
    Tree empty;
    EXPECT_THROW(stages_sheet({"", empty, subject.parts, subject.cloud}), Error);
    EXPECT_THROW(lay_out({}), Error);
}

TEST_F(Cli, AScanGivesItsSheets) {
    ASSERT_EQ(run("synth -o grown --seed 3 --quiet").code, 0);
    const Outcome made = run("reconstruct grown/scan.ply -o grown/tree.txt --sheet grown/stages.png");
    ASSERT_EQ(made.code, 0) << made.error;
    EXPECT_NE(made.out.find("wrote grown/stages.png"), std::string::npos) << made.out;
    const Outcome scored = run("score grown/tree.txt grown/scan.ply --sheet grown/score.png --quiet");
    ASSERT_EQ(scored.code, 0) << scored.error;
    for (const char* name : {"grown/stages.png", "grown/score.png"}) {
        const std::optional<Image> picture = decode_picture(get(name), 3);
        ASSERT_TRUE(picture) << name;
        EXPECT_GT(inked(*picture, 0, 0, picture->width, picture->height), 5000) << name;
    }
    EXPECT_EQ(run("reconstruct grown/scan.ply --sheet grown/stages.jpg").code, 2);
    EXPECT_EQ(run("score grown/tree.txt grown/scan.ply --sheet grown/stages.jpg").code, 2);
    EXPECT_EQ(run("reconstruct grown/scan.ply --sheet nowhere/stages.png").code, 2);
    EXPECT_EQ(run("score grown/tree.txt grown/scan.ply --sheet nowhere/stages.png").code, 2);
    EXPECT_EQ(run("score grown/tree.txt grown/scan.ply --pictures grown").code, 2);
}

}  // namespace
}  // namespace treerec
