// Pictures of drawings as strokes, on drawings of which every stroke is known.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "cases.h"
#include "drawn_sketch.h"
#include "error.h"
#include "exchange/material_textures.h"
#include "sketch/sketch_picture.h"

namespace treerec {
namespace {

using test::apart;
using test::Brush;
using test::DrawnStrokes;
using test::paint;
using test::png_of;
using test::Polyline;

Sketch read(const Image& picture) {
    return sketch_of_picture(picture, "'drawing.png'");
}

// The distance of the stroke that is nearest to the line; which: its place.
double nearest(const Sketch& sketch, const Polyline& line, size_t* which = nullptr) {
    double best = 1e30;
    for (size_t i = 0; i < sketch.strokes.size(); i++) {
        const double away = apart(sketch.strokes[i].points, line);
        if (away >= best) continue;
        best = away;
        if (which) *which = i;
    }
    return best;
}

// Lays the strokes, each in a colour of its own, over the picture: to be looked at where TREEREC_SHOW names a
// folder.
void show(const std::string& name, const Image& picture, const Sketch& sketch) {
    const char* folder = std::getenv("TREEREC_SHOW");
    if (!folder) return;
    Image over = picture;
    const int colours[6][3] = {{220, 30, 30}, {20, 120, 240}, {20, 160, 60},
                               {230, 140, 0}, {160, 40, 200}, {0, 170, 170}};
    for (size_t s = 0; s < sketch.strokes.size(); s++)
        for (size_t i = 0; i < sketch.strokes[s].points.size(); i++) {
            const DVec2 p = sketch.strokes[s].points[i];
            const int reach = i == 0 ? 4 : 1;
            for (int y = int(p.y) - reach; y <= int(p.y) + reach; y++)
                for (int x = int(p.x) - reach; x <= int(p.x) + reach; x++)
                    if (x >= 0 && y >= 0 && x < over.width && y < over.height)
                        for (int k = 0; k < 4; k++)
                            over.at(x, y)[k] = k < 3 ? static_cast<uint8_t>(colours[s % 6][k]) : 255;
        }
    write_png(std::string(folder) + "/" + name + ".png", over);
}

std::string sentence_of(const std::string& bytes) {
    try {
        parse_sketch_picture(bytes, "'drawing.png'");
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

TEST(SketchPicture, StrokesAreAsDrawnWhateverTheBrush) {
    Random random(7);
    double worst = 0.0, sum = 0.0, farthest = 0.0;
    int count = 0;
    for (int i = 0; i < test::cases(40); i++) {
        const double width = i < 20 ? 1.0 + i : random.uniform(1.0, 20.0);
        const bool crossed = i % 2 == 0;
        const DrawnStrokes drawn =
            test::random_drawing(random, 1000.0, 2.0 * width + 12.0, crossed, 1 + i % 6);
        const Image picture = paint(1000, 1000, drawn.all(), {width, i % 3 != 0});
        const Sketch sketch = read(picture);
        show("tree_" + std::to_string(i), picture, sketch);
        SCOPED_TRACE("drawing " + std::to_string(i) + ", brush " + std::to_string(width));
        EXPECT_EQ(sketch.canvas, DVec2(1000.0, 1000.0));
        EXPECT_EQ(sketch.strokes.size(), drawn.all().size());
        for (const Polyline& line : drawn.all()) {
            const double away = nearest(sketch, line);
            EXPECT_LT(away, 2.0);
            worst = std::max(worst, away);
            sum += away;
            count++;
        }
        // The outline is closed, and branches begin at the trunk.
        size_t outline = 0;
        nearest(sketch, drawn.outline, &outline);
        EXPECT_EQ(sketch.strokes[outline].points.front(), sketch.strokes[outline].points.back());
        for (const Polyline& branch : drawn.branches) {
            size_t which = 0;
            nearest(sketch, branch, &which);
            const double off = glm::length(sketch.strokes[which].points.front() - branch.front());
            EXPECT_LT(off, 3.0 + 0.2 * width);
            farthest = std::max(farthest, off);
        }
    }
    std::printf("strokes are %.2f px from those drawn, the worst %.2f; branches begin within %.1f px\n",
                sum / count, worst, farthest);
}

// Each is read as the one that it shows.
TEST(SketchPicture, InkAndPaperMayHaveAnyColour) {
    Random random(8);
    const DrawnStrokes drawn = test::random_drawing(random, 600.0, 20.0, true, 4);
    const Brush brush{4.0, true};
    struct Look {
        const char* name;
        std::array<int, 4> ink, paper;
    };
    for (const Look& look : {Look{"black on white", {0, 0, 0, 255}, {255, 255, 255, 255}},
                             Look{"white on black", {255, 255, 255, 255}, {0, 0, 0, 255}},
                             Look{"yellow on white", {250, 220, 0, 255}, {255, 255, 255, 255}},
                             Look{"chalk on green", {230, 230, 220, 255}, {30, 80, 50, 255}},
                             Look{"pencil", {120, 120, 125, 255}, {245, 245, 245, 255}},
                             Look{"black on nothing", {0, 0, 0, 255}, {0, 0, 0, 0}},
                             Look{"white on nothing", {255, 255, 255, 255}, {255, 255, 255, 0}}}) {
        SCOPED_TRACE(look.name);
        const Sketch sketch = read(paint(600, 600, drawn.all(), brush, look.ink, look.paper));
        EXPECT_EQ(sketch.strokes.size(), 6U);
        for (const Polyline& line : drawn.all())
            EXPECT_LT(nearest(sketch, line), 2.0);
    }
}

TEST(SketchPicture, PhotographedPaperIsPaper) {
    Random random(9);
    const DrawnStrokes drawn = test::random_drawing(random, 900.0, 25.0, true, 4);
    Image picture = paint(900, 900, drawn.all(), {6.0, true}, {60, 60, 90, 255});
    // A shadow from the left, grain, crumbs, and a hole in a line.
    for (int y = 0; y < 900; y++)
        for (int x = 0; x < 900; x++)
            for (int k = 0; k < 3; k++) {
                uint8_t& level = picture.at(x, y)[k];
                level = static_cast<uint8_t>(
                    std::clamp(level * (0.45 + 0.55 * x / 900.0) + 5.0 * random.normal(), 0.0, 255.0));
            }
    for (int i = 0; i < 60; i++) {
        const int x = 5 + static_cast<int>(random.below(880)), y = 5 + static_cast<int>(random.below(880));
        for (int k = 0; k < 12; k++)
            picture.at(x + k % 4, y + k / 4)[1] = 0;
    }
    const DVec2 hole = drawn.trunk[20];
    for (int k = 0; k < 3; k++)
        picture.at(static_cast<int>(hole.x), static_cast<int>(hole.y))[k] = 200;
    const Sketch sketch = read(picture);
    show("photographed", picture, sketch);
    EXPECT_EQ(sketch.strokes.size(), 6U);
    for (const Polyline& line : drawn.all())
        EXPECT_LT(nearest(sketch, line), 2.0);
}

Polyline ring(const DVec2& middle, const DVec2& radii) {
    Polyline line;
    for (int i = 0; i <= 120; i++) {
        const double angle = 2.0 * kPi * (i % 120) / 120.0;
        line.push_back(middle + radii * DVec2(std::sin(angle), -std::cos(angle)));
    }
    return line;
}

// What meets, in pictures of 1000 pixels, and how many strokes it is; each is within 2 px of one of them.
struct Meeting {
    const char* name;
    std::vector<Polyline> lines;
    std::vector<bool> closed;
    bool tailed = true;  // each open line begins where it is to
};

TEST(SketchPicture, LinesGoOnStraightWhereTheyMeet) {
    const Polyline trunk = {{500.0, 950.0}, {505.0, 700.0}, {495.0, 500.0}, {500.0, 300.0}};
    const Polyline outline = ring({500.0, 400.0}, {350.0, 300.0});
    const Polyline pointed = {{500.0, 700.0}, {300.0, 560.0}, {180.0, 400.0}, {250.0, 200.0}, {500.0, 120.0},
                              {750.0, 200.0}, {820.0, 400.0}, {700.0, 560.0}, {500.0, 700.0}};
    const std::vector<Meeting> meetings = {
        {"the trunk ends at the outline's top", {outline, {{500.0, 950.0}, {500.0, 100.0}}}, {true, false}},
        {"the outline's base rests on the trunk's top",
         {outline, {{500.0, 950.0}, {500.0, 700.0}}},
         {true, false}},
        {"an outline with a point below hangs on the trunk",
         {pointed, {{500.0, 950.0}, {500.0, 700.0}}},
         {true, false}},
        {"an outline with a point below is crossed by it",
         {pointed, {{500.0, 950.0}, {500.0, 300.0}}},
         {true, false}},
        {"branches' tips touch the outline",
         {outline, trunk, {{497.0, 550.0}, {200.0, 559.0}}, {{497.0, 450.0}, {824.0, 290.0}}},
         {true, false, false, false}},
        {"branches cross one another",
         {trunk, {{502.0, 650.0}, {300.0, 400.0}}, {{497.0, 550.0}, {250.0, 600.0}}},
         {false, false, false}},
        {"two branches leave the trunk at one height",
         {trunk, {{497.0, 550.0}, {300.0, 480.0}}, {{497.0, 550.0}, {700.0, 480.0}}},
         {false, false, false}},
        {"two branches in one straight line",
         {trunk, {{497.0, 550.0}, {300.0, 550.0}}, {{497.0, 550.0}, {700.0, 550.0}}},
         {false, false, false}},
        {"a branch that slipped through the trunk",
         {trunk, {{540.0, 570.0}, {300.0, 450.0}}},
         {false, false}},
        {"a trunk of two lines",
         {{{480.0, 950.0}, {490.0, 300.0}}, {{540.0, 950.0}, {520.0, 300.0}}},
         {false, false}},
        {"an open outline",
         {{{480.0, 690.0},
           {300.0, 650.0},
           {200.0, 400.0},
           {500.0, 100.0},
           {800.0, 400.0},
           {700.0, 650.0},
           {530.0, 690.0}}},
         {false},
         false},
    };
    for (const double width : {1.0, 2.0, 5.0, 20.0})
        for (const Meeting& meeting : meetings) {
            SCOPED_TRACE(std::string(meeting.name) + ", brush " + std::to_string(width));
            const Image picture = paint(1000, 1000, meeting.lines, {width, true});
            const Sketch sketch = read(picture);
            show(std::string(meeting.name) + " " + std::to_string(static_cast<int>(width)), picture, sketch);
            EXPECT_EQ(sketch.strokes.size(), meeting.lines.size());
            for (size_t i = 0; i < meeting.lines.size(); i++) {
                size_t which = 0;
                EXPECT_LT(nearest(sketch, meeting.lines[i], &which), 2.0) << "line " << i;
                const Polyline& points = sketch.strokes[which].points;
                EXPECT_EQ(points.front() == points.back(), meeting.closed[i]) << "line " << i;
                // Branches and trunks are given from their tails on, and so they are read.
                const bool told = meeting.tailed && !meeting.closed[i];
                EXPECT_LT(told ? glm::length(points.front() - meeting.lines[i].front()) : 0.0,
                          4.0 + 0.5 * width);
            }
        }
}

TEST(SketchPicture, LargeAndSmallOnesKeepTheirOwnPixels) {
    Random random(10);
    for (const int size : {120, 300, 2500, 4200}) {
        SCOPED_TRACE(size);
        const double width = std::max(2.0, 0.006 * size);
        const DrawnStrokes drawn = test::random_drawing(random, size, 0.03 * size, true, 3);
        const Sketch sketch = read(paint(size, size, drawn.all(), {width, true}));
        EXPECT_EQ(sketch.canvas, DVec2(size, size));
        EXPECT_EQ(sketch.strokes.size(), 5U);
        for (const Polyline& line : drawn.all())
            EXPECT_LT(nearest(sketch, line), std::max(2.0, 0.002 * size));
    }
}

TEST(SketchPicture, SaysWhyThereIsNoTree) {
    const auto of = [](const Image& picture) { return sentence_of(png_of(picture)); };
    Image plain(200, 200, 4);
    std::fill(plain.pixels.begin(), plain.pixels.end(), uint8_t{255});
    EXPECT_NE(of(plain).find("all of it has nearly one color"), std::string::npos) << of(plain);
    EXPECT_NE(of(paint(300, 300, {{{20.0, 150.0}, {280.0, 150.0}}}, {90.0, true})).find("filled areas"),
              std::string::npos);
    Image specks = plain;
    for (int i = 10; i < 190; i += 20)
        specks.at(i, i)[0] = specks.at(i, i)[1] = 0;
    EXPECT_NE(of(specks).find("only specks"), std::string::npos) << of(specks);
    Image noise = plain;
    Random random(3);
    for (size_t i = 0; i < noise.pixels.size(); i++)
        noise.pixels[i] = i % 4 == 3 ? 255 : static_cast<uint8_t>(random.below(256));
    EXPECT_FALSE(of(noise).empty());
    // Hatched: more lines than make a tree.
    std::vector<Polyline> hatches;
    for (int i = 0; i < 40; i++)
        for (int k = 0; k < 40; k++)
            hatches.push_back({{10.0 + 25.0 * i, 5.0 + 25.0 * k}, {20.0 + 25.0 * i, 20.0 + 25.0 * k}});
    EXPECT_NE(of(paint(1010, 1010, hatches, {2.0, true})).find("1600 lines"), std::string::npos);

    const std::string sound = png_of(paint(100, 100, {{{10.0, 90.0}, {90.0, 10.0}}}, {3.0, true}));
    for (size_t size = 0; size < sound.size(); size += 1 + size / 8) {
        const std::string sentence = sentence_of(sound.substr(0, size));
        EXPECT_TRUE(sentence.empty() || sentence.back() == '.') << sentence;
    }
    EXPECT_NE(sentence_of(sound.substr(0, 40)).find("damaged"), std::string::npos);
    // A header that promises more than anyone draws.
    std::string huge = sound;
    huge[16] = huge[20] = 0;
    huge[17] = huge[21] = 0;
    huge[18] = huge[22] = '\x2F';
    EXPECT_NE(sentence_of(huge).find("pixels; save it with at most"), std::string::npos) << sentence_of(huge);
    EXPECT_EQ(sentence_of(sound), "");
}

}  // namespace
}  // namespace treerec
