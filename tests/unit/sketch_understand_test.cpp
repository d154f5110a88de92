// What strokes mean: properties over grown trees that were drawn and spoilt, rules for odd drawings,
// scribbles.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "cases.h"
#include "error.h"
#include "geometry/random.h"
#include "messy_sketches.h"
#include "sketch/flat_line.h"
#include "sketch/outline.h"
#include "sketch/strokes.h"

namespace treerec {
namespace {

using test::cases;
using test::messy_sketch;
using test::MessySketch;

// Strokes given with y up, as one thinks of a tree, on the usual canvas.
Sketch sketch_of(const std::vector<FlatLine>& lines, const std::vector<StrokeRole>& roles = {}) {
    Sketch sketch;
    for (size_t i = 0; i < lines.size(); i++) {
        Stroke stroke;
        for (const DVec2& p : lines[i])
            stroke.points.emplace_back(p.x, kCanvasHeight - p.y);
        if (i < roles.size()) stroke.role = roles[i];
        stroke.id = static_cast<uint32_t>(i) + 1;
        sketch.strokes.push_back(stroke);
    }
    return sketch;
}

FlatLine circle(const DVec2& middle, double radius, double from = 0.0, double to = 2.0 * kPi) {
    FlatLine line;
    for (int k = 0; k <= 90; k++) {
        const double angle = from + (to - from) * k / 90.0;
        line.push_back(middle + radius * DVec2(std::cos(angle), std::sin(angle)));
    }
    return line;
}

FlatLine even_line(const DVec2& a, const DVec2& b) {
    FlatLine line;
    const int count = std::max(1, static_cast<int>(glm::length(b - a) / 5.0));
    for (int k = 0; k <= count; k++)
        line.push_back(a + (static_cast<double>(k) / count) * (b - a));
    return line;
}

const FlatLine kTrunk = even_line({500, 50}, {500, 700});
const FlatLine kCrown = circle({500, 620}, 300, 1.0, 1.0 + 2.0 * kPi);
const FlatLine kLeft = even_line({500, 450}, {330, 640}), kRight = even_line({500, 500}, {660, 680});

bool has(const StrokeReading& reading, StrokeRepair repair) {
    return std::count(reading.repairs.begin(), reading.repairs.end(), repair) > 0;
}

void check_line(const DrawnLine& line) {
    ASSERT_GE(line.points.size(), 2u);
    for (size_t i = 0; i < line.points.size(); i++) {
        ASSERT_TRUE(std::isfinite(line.points[i].x) && std::isfinite(line.points[i].y));
        ASSERT_TRUE(i == 0 || line.points[i] != line.points[i - 1]);
    }
    if (!line.radii.empty()) {
        ASSERT_EQ(line.radii.size(), line.points.size());
        for (const double radius : line.radii)
            ASSERT_GT(radius, 0.0);
    }
}

bool is_point_of(const FlatLine& line, const DVec2& p) {
    return std::find(line.begin(), line.end(), p) != line.end();
}

// What strokes.h promises of whatever is understood.
void check_understood(const Sketch& sketch, const UnderstoodSketch& understood) {
    const DrawnTree& drawn = understood.drawn;
    ASSERT_TRUE(is_simple(drawn.outline));
    ASSERT_GT(polygon_area(drawn.outline), 0.0);
    check_line(drawn.trunk);
    ASSERT_LE(drawn.trunk.points.front().y, drawn.trunk.points.back().y);
    for (const DrawnLine& branch : drawn.branches) {
        check_line(branch);
        ASSERT_FALSE(branch.parent);
        ASSERT_TRUE(is_point_of(drawn.trunk.points, branch.points[0]));
    }
    for (const DrawnLine& side : drawn.side_branches) {
        check_line(side);
        ASSERT_TRUE(side.parent && *side.parent < drawn.branches.size());
        ASSERT_TRUE(is_point_of(drawn.branches[*side.parent].points, side.points[0]));
    }
    ASSERT_EQ(understood.strokes.size(), sketch.strokes.size());
    for (const StrokeReading& told : understood.strokes) {
        ASSERT_EQ(told.left_out, told.role == StrokeRole::kAuto);
        ASSERT_TRUE(!told.left_out || !told.fault.empty());
        ASSERT_EQ(told.attach.has_value(), told.role == StrokeRole::kBranch);
    }
}

double quantile(std::vector<double> values, double share) {
    std::sort(values.begin(), values.end());
    return values[static_cast<size_t>(share * static_cast<double>(values.size() - 1) + 0.5)];
}

TEST(SketchUnderstand, MessySketchesMeanWhatWasMeant) {
    size_t strokes = 0, right = 0;
    std::vector<double> errors;
    for (int k = 0; k < cases(60); k++) {
        const MessySketch messy = messy_sketch(2 * static_cast<uint64_t>(k) + 1);
        const UnderstoodSketch understood = understand_sketch(messy.sketch);
        ASSERT_NO_FATAL_FAILURE(check_understood(messy.sketch, understood)) << k;
        for (size_t i = 0; i < messy.truth.size(); i++) {
            strokes++;
            if (understood.strokes[i].role != messy.truth[i].role) continue;
            right++;
            if (messy.truth[i].attach)
                errors.push_back(glm::length(*understood.strokes[i].attach - *messy.truth[i].attach) *
                                 kCanvasHeight / messy.sketch.canvas.y);
        }
    }
    EXPECT_GE(static_cast<double>(right), 0.98 * static_cast<double>(strokes));
    EXPECT_LE(quantile(errors, 0.5), 3.0);
    EXPECT_LE(quantile(errors, 0.95), 8.0);
}

// Nothing that was drawn well moves by more than a pixel, and nothing is found to be mended.
TEST(SketchUnderstand, CleanStrokesStay) {
    size_t lines = 0;
    for (int k = 0; k < cases(60); k++) {
        const MessySketch clean = messy_sketch(static_cast<uint64_t>(k), {false, false, false});
        const UnderstoodSketch understood = understand_sketch(clean.sketch);
        const double scale = kCanvasHeight / clean.sketch.canvas.y;
        const auto flat = [&](size_t stroke) {
            FlatLine line;
            for (const DVec2& p : clean.sketch.strokes[stroke].points)
                line.emplace_back(p.x * scale, kCanvasHeight - p.y * scale);
            return line;
        };
        std::vector<DrawnLine> drawn = understood.drawn.branches;
        drawn.insert(drawn.end(), understood.drawn.side_branches.begin(),
                     understood.drawn.side_branches.end());
        // Of a trunk of two lines the middle is no stroke, and branches are drawn from its side.
        const bool two_sides = !understood.drawn.trunk.radii.empty();
        if (!two_sides) drawn.push_back(understood.drawn.trunk);
        for (const DrawnLine& line : drawn) {
            const FlatLine stroke = flat(line.stroke);
            double most = 0.0;
            for (const DVec2& p : stroke)
                most = std::max(most, nearest_on_line(line.points, p).distance);
            EXPECT_LE(most, 1.0) << k << " stroke " << line.stroke;
            lines++;
            if (two_sides) continue;
            most = 0.0;
            for (const DVec2& p : line.points)
                most = std::max(most, nearest_on_line(stroke, p).distance);
            EXPECT_LE(most, 1.0) << k << " stroke " << line.stroke;
            EXPECT_TRUE(understood.strokes[line.stroke].repairs.empty()) << k << " stroke " << line.stroke;
        }
    }
    EXPECT_GT(lines, 4u * static_cast<size_t>(cases(60)));
}

// The order of strokes and the way in which each was drawn change nothing of what is meant.
TEST(SketchUnderstand, OrderAndDirectionDoNotMatter) {
    for (int k = 0; k < cases(20); k++) {
        const MessySketch messy = messy_sketch(static_cast<uint64_t>(k), {false, false, false});
        const UnderstoodSketch one = understand_sketch(messy.sketch);
        Sketch turned = messy.sketch;
        std::reverse(turned.strokes.begin(), turned.strokes.end());
        for (Stroke& stroke : turned.strokes)
            std::reverse(stroke.points.begin(), stroke.points.end());
        const UnderstoodSketch other = understand_sketch(turned);
        const size_t count = messy.sketch.strokes.size();
        for (size_t i = 0; i < count; i++) {
            const StrokeReading &a = one.strokes[i], &b = other.strokes[count - 1 - i];
            EXPECT_EQ(a.role, b.role) << k;
            ASSERT_EQ(a.attach.has_value(), b.attach.has_value()) << k;
            EXPECT_TRUE(!a.attach || glm::length(*a.attach - *b.attach) < 3.0) << k;
        }
    }
}

// A canvas of another size, with the same drawing on it, gives the same tree.
TEST(SketchUnderstand, CanvasesAreScaled) {
    const Sketch sketch = sketch_of({kTrunk, kCrown, kLeft, even_line({520, 510}, {660, 680})});
    Sketch large = sketch;
    large.canvas *= 4.0;
    for (Stroke& stroke : large.strokes)
        for (DVec2& p : stroke.points)
            p *= 4.0;
    const UnderstoodSketch one = understand_sketch(sketch), other = understand_sketch(large);
    EXPECT_EQ(one.drawn.outline, other.drawn.outline);
    EXPECT_EQ(one.drawn.trunk.points, other.drawn.trunk.points);
    ASSERT_EQ(other.drawn.branches.size(), 2u);
    for (size_t i = 0; i < 2; i++)
        EXPECT_EQ(one.drawn.branches[i].points, other.drawn.branches[i].points);
    EXPECT_LT(glm::length(*other.strokes[3].attach - 4.0 * *one.strokes[3].attach), 1e-9);
}

TEST(SketchUnderstand, EachRepairIsTold) {
    FlatLine loop = circle({515, 470}, 9, 0.8, 0.8 + 2.0 * kPi);
    const FlatLine on = even_line(loop.back(), {680, 640});
    loop.insert(loop.end(), on.begin() + 1, on.end());
    FlatLine hook = even_line({512, 590}, {503, 600});
    const FlatLine back = even_line({503, 600}, {620, 700});
    hook = even_line({530, 606}, {503, 600});
    hook.insert(hook.end(), back.begin() + 1, back.end());
    const Sketch sketch =
        sketch_of({kTrunk, kCrown, even_line({640, 560}, {515, 414.17}), even_line({525, 400}, {380, 520}),
                   even_line({485, 510}, {330, 620}), loop, hook});
    const UnderstoodSketch understood = understand_sketch(sketch);
    check_understood(sketch, understood);
    EXPECT_TRUE(has(understood.strokes[2], StrokeRepair::kReversed));
    EXPECT_TRUE(has(understood.strokes[2], StrokeRepair::kGap));
    EXPECT_LT(glm::length(*understood.strokes[2].attach - DVec2(500, 603.3)), 1.0);
    EXPECT_EQ(understood.strokes[3].repairs, std::vector<StrokeRepair>{StrokeRepair::kCrossing});
    EXPECT_NEAR(understood.strokes[3].attach->y, 1000 - 420.7, 1.0);
    EXPECT_EQ(understood.strokes[4].repairs, std::vector<StrokeRepair>{StrokeRepair::kGap});
    EXPECT_TRUE(has(understood.strokes[5], StrokeRepair::kHook));
    EXPECT_TRUE(has(understood.strokes[6], StrokeRepair::kHook));
    EXPECT_NEAR(understood.strokes[6].attach->y, 1000 - 597.4, 4.0);
    for (const StrokeReading& told : understood.strokes)
        EXPECT_EQ(told.fault, "");
}

TEST(SketchUnderstand, OutlinesAreClosedAndUnited) {
    // Open, by its chord.
    const FlatLine open = circle({500, 620}, 300, -1.2, 4.3);
    const UnderstoodSketch closed = understand_sketch(sketch_of({kTrunk, open, kLeft}));
    EXPECT_EQ(closed.strokes[1].repairs, std::vector<StrokeRepair>{StrokeRepair::kClosed});
    EXPECT_NEAR(polygon_area(closed.drawn.outline), std::abs(polygon_area(open)), 500.0);
    // Two puffs that cross.
    const Sketch puffs = sketch_of({kTrunk, circle({400, 620}, 200), circle({620, 640}, 180), kLeft});
    const UnderstoodSketch united = understand_sketch(puffs);
    check_understood(puffs, united);
    EXPECT_TRUE(has(united.strokes[1], StrokeRepair::kUnited));
    EXPECT_TRUE(has(united.strokes[2], StrokeRepair::kUnited));
    // The lens that both cover is counted once.
    size_t inside = 0;
    for (int x = 0; x < 1000; x += 4)
        for (int y = 0; y < 1000; y += 4)
            if (glm::length(DVec2(x - 400, y - 620)) < 200 || glm::length(DVec2(x - 620, y - 640)) < 180)
                inside++;
    EXPECT_NEAR(polygon_area(united.drawn.outline), 16.0 * static_cast<double>(inside), 1200.0);
    // A left and a right half.
    const Sketch halves = sketch_of({circle({500, 620}, 300, kPi / 2, 3 * kPi / 2), kTrunk,
                                     circle({510, 620}, 300, kPi / 2 - 0.05, 0.05 - kPi / 2), kRight});
    const UnderstoodSketch joint = understand_sketch(halves);
    check_understood(halves, joint);
    EXPECT_EQ(joint.strokes[0].role, StrokeRole::kOutline);
    EXPECT_EQ(joint.strokes[2].role, StrokeRole::kOutline);
    EXPECT_NEAR(polygon_area(joint.drawn.outline), kPi * 300 * 300, 9000.0);
    // An eight keeps both its halves, and running on past its beginning adds nothing.
    FlatLine eight;
    for (int k = 0; k <= 200; k++)
        eight.emplace_back(500 + 250 * std::sin(2 * kPi * k / 200), 650 + 150 * std::sin(4 * kPi * k / 200));
    const Sketch crossed = sketch_of({eight, kTrunk});
    const UnderstoodSketch simple = understand_sketch(crossed);
    check_understood(crossed, simple);
    EXPECT_NEAR(line_box(simple.drawn.outline).size().x, 500.0, 60.0 + 200.0);
    const FlatLine past = circle({500, 620}, 300, 1.0, 1.3 + 2 * kPi);
    FlatLine wound = past;
    for (size_t i = 0; i < wound.size(); i++)
        wound[i] =
            DVec2(500, 620) + (1.03 - 0.06 * static_cast<double>(i) / 90.0) * (wound[i] - DVec2(500, 620));
    EXPECT_NEAR(polygon_area(understand_sketch(sketch_of({kTrunk, wound})).drawn.outline), kPi * 300 * 300,
                9000.0);
}

TEST(SketchUnderstand, TrunksOfTwoLinesHaveRadii) {
    for (const bool told : {false, true}) {
        const FlatLine left = even_line({470, 50}, {490, 700}), right = even_line({510, 690}, {530, 52});
        const StrokeRole role = told ? StrokeRole::kTrunk : StrokeRole::kAuto;
        const Sketch sketch = sketch_of({left, kCrown, right, even_line({515, 450}, {680, 600})},
                                        {role, StrokeRole::kAuto, role});
        const UnderstoodSketch understood = understand_sketch(sketch);
        check_understood(sketch, understood);
        const DrawnLine& trunk = understood.drawn.trunk;
        ASSERT_FALSE(trunk.radii.empty());
        EXPECT_NEAR(trunk.radii.front(), 30.0, 1.5);
        EXPECT_NEAR(trunk.points.front().x, 500.0, 1.0);
        EXPECT_TRUE(has(understood.strokes[0], StrokeRepair::kTwoSides));
        EXPECT_TRUE(has(understood.strokes[2], StrokeRepair::kTwoSides));
        // A branch that begins at a side has no gap.
        EXPECT_TRUE(understood.strokes[3].repairs.empty());
        EXPECT_NEAR(understood.strokes[3].attach->x, 500.0, 1.0);
    }
    // One stroke around both sides, from the crown and back to it.
    FlatLine around = even_line({480, 400}, {470, 60});
    for (const FlatLine& part : {even_line({470, 60}, {530, 60}), even_line({530, 60}, {520, 400})})
        around.insert(around.end(), part.begin() + 1, part.end());
    const Sketch sketch = sketch_of({kCrown, around});
    const UnderstoodSketch understood = understand_sketch(sketch);
    check_understood(sketch, understood);
    EXPECT_EQ(understood.strokes[1].role, StrokeRole::kTrunk);
    ASSERT_FALSE(understood.drawn.trunk.radii.empty());
    EXPECT_NEAR(understood.drawn.trunk.radii[10], 29.0, 2.0);
    EXPECT_GT(understood.drawn.trunk.points.back().y, 600.0);  // it was led on into the crown
    EXPECT_EQ(understood.remarks.size(), 1u);
}

TEST(SketchUnderstand, WholeTreesInOneStroke) {
    FlatLine balloon = even_line({500, 50}, {500, 400});
    const FlatLine round = circle({500, 600}, 200, -kPi / 2, 1.47 * kPi);
    balloon.insert(balloon.end(), round.begin() + 1, round.end());
    FlatLine contour = even_line({480, 50}, {480, 410});
    const FlatLine cloud = circle({500, 600}, 200, -kPi / 2 - 0.12, -2.5 * kPi + 0.12);
    contour.insert(contour.end(), cloud.begin(), cloud.end());
    const FlatLine down = even_line({520, 410}, {520, 50});
    contour.insert(contour.end(), down.begin(), down.end());
    for (const FlatLine& line : {balloon, contour}) {
        for (const bool reversed : {false, true}) {
            FlatLine stroke = line;
            if (reversed) std::reverse(stroke.begin(), stroke.end());
            const Sketch sketch = sketch_of({stroke});
            const UnderstoodSketch understood = understand_sketch(sketch);
            check_understood(sketch, understood);
            EXPECT_NEAR(understood.drawn.trunk.points.front().y, 50.0, 5.0);
            EXPECT_NEAR(understood.drawn.trunk.points.front().x, 500.0, 5.0);
            EXPECT_GT(line_box(understood.drawn.outline).low.y, 380.0);
            EXPECT_NEAR(polygon_area(understood.drawn.outline), kPi * 200 * 200, 8000.0);
            EXPECT_GT(understood.drawn.trunk.points.back().y, 600.0);
        }
    }
}

TEST(SketchUnderstand, WhatIsMissingIsMade) {
    // No outline: all tips are inside.
    const Sketch bare = sketch_of({kTrunk, kLeft, kRight});
    const UnderstoodSketch without = understand_sketch(bare);
    check_understood(bare, without);
    EXPECT_FALSE(without.drawn.outline_stroke);
    ASSERT_EQ(without.remarks.size(), 1u);
    for (const DrawnLine& branch : without.drawn.branches)
        EXPECT_TRUE(is_inside(without.drawn.outline, branch.points.back()));
    EXPECT_TRUE(is_inside(without.drawn.outline, kTrunk.back()));
    // A trunk alone.
    const Sketch pole = sketch_of({kTrunk});
    check_understood(pole, understand_sketch(pole));
    // No trunk.
    const Sketch crown = sketch_of({kCrown});
    const UnderstoodSketch stemless = understand_sketch(crown);
    check_understood(crown, stemless);
    EXPECT_LT(stemless.drawn.trunk.points.front().y, line_box(stemless.drawn.outline).low.y);
    EXPECT_NEAR(stemless.drawn.trunk.points.front().x, 500.0, 2.0);
    // A bush: its outline is the lowest.
    const Sketch bush = sketch_of({even_line({500, 330}, {500, 600}), kCrown, kLeft, kRight});
    const UnderstoodSketch low = understand_sketch(bush);
    check_understood(bush, low);
    EXPECT_EQ(low.strokes[0].role, StrokeRole::kTrunk);
    EXPECT_EQ(low.strokes[1].role, StrokeRole::kOutline);
}

TEST(SketchUnderstand, WhatIsOddIsSaid) {
    const Sketch sketch = sketch_of({kTrunk, kCrown, even_line({500, 500}, {900, 700}),  // out of the crown
                                     kLeft, even_line({415, 545}, {330, 560}),           // on kLeft
                                     circle({900, 930}, 40),                             // the sun
                                     even_line({200, 45}, {800, 52}),                    // the ground
                                     FlatLine{{600, 600}}, circle({500, 700}, 40)});     // a dot, a ring
    const UnderstoodSketch understood = understand_sketch(sketch);
    check_understood(sketch, understood);
    EXPECT_FALSE(understood.strokes[2].left_out);
    EXPECT_NE(understood.strokes[2].fault.find("leaves the crown"), std::string::npos);
    EXPECT_EQ(understood.strokes[4].role, StrokeRole::kBranch);
    ASSERT_EQ(understood.drawn.side_branches.size(), 1u);
    EXPECT_EQ(understood.drawn.branches[*understood.drawn.side_branches[0].parent].stroke, 3u);
    for (const size_t left_out : {5u, 6u, 7u, 8u}) {
        EXPECT_TRUE(understood.strokes[left_out].left_out) << left_out;
        EXPECT_NE(understood.strokes[left_out].fault, "") << left_out;
    }
    // Out of the crown on its way, and back into it.
    FlatLine bulge = kRight;
    for (const FlatLine& part : {even_line({660, 680}, {830, 640}), even_line({830, 640}, {700, 760})})
        bulge.insert(bulge.end(), part.begin() + 1, part.end());
    EXPECT_NE(understand_sketch(sketch_of({kTrunk, kCrown, bulge})).strokes[2].fault.find("leaves the crown"),
              std::string::npos);
    // Right through the trunk.
    const Sketch through = sketch_of({kTrunk, kCrown, even_line({320, 520}, {660, 560})});
    const UnderstoodSketch both = understand_sketch(through);
    check_understood(through, both);
    EXPECT_EQ(both.drawn.branches.size(), 2u);
    // A trunk that pokes out, and is highest and lowest.
    const Sketch poking = sketch_of({even_line({500, 20}, {500, 980}), kCrown, kLeft});
    const UnderstoodSketch out = understand_sketch(poking);
    EXPECT_EQ(out.strokes[0].role, StrokeRole::kTrunk);
    EXPECT_EQ(out.strokes[1].role, StrokeRole::kOutline);
    EXPECT_NE(out.strokes[0].fault, "");
}

TEST(SketchUnderstand, TheUserKnowsBetter) {
    const Sketch sketch =
        sketch_of({kLeft, kCrown, kTrunk}, {StrokeRole::kTrunk, StrokeRole::kOutline, StrokeRole::kBranch});
    const UnderstoodSketch understood = understand_sketch(sketch);
    check_understood(sketch, understood);
    for (size_t i = 0; i < 3; i++)
        EXPECT_EQ(understood.strokes[i].role, sketch.strokes[i].role);
}

TEST(SketchUnderstand, NonsenseIsRefused) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(understand_sketch(Sketch()), Error);
    EXPECT_THROW(understand_sketch(sketch_of({{{500, 500}}})), Error);
    EXPECT_THROW(understand_sketch(sketch_of({FlatLine(5000, DVec2(500, 500))})), Error);
    EXPECT_THROW(understand_sketch(sketch_of({{{500, 50}, {nan, 500}}})), Error);
    EXPECT_THROW(understand_sketch(sketch_of({FlatLine()})), Error);
    EXPECT_THROW(understand_sketch(sketch_of({even_line({100, 500}, {900, 510})})), Error);
    EXPECT_THROW(understand_sketch(sketch_of({kLeft, kRight}, {StrokeRole::kBranch, StrokeRole::kBranch})),
                 Error);
}

// A tree or a sentence.
void try_it(const Sketch& sketch, size_t& trees) {
    try {
        const UnderstoodSketch understood = understand_sketch(sketch);
        check_understood(sketch, understood);
        trees++;
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()), "");
    }
}

TEST(SketchUnderstand, ScribblesNeverCrash) {
    size_t trees = 0;
    for (int k = 0; k < cases(2000); k++) {
        Random random(static_cast<uint64_t>(k), 7);
        Sketch sketch;
        const size_t strokes = random.below(12);
        const double size = random.below(10) == 0 ? 1e5 : random.below(10) == 0 ? 10.0 : 1000.0;
        for (size_t i = 0; i < strokes; i++) {
            Stroke stroke;
            DVec2 p(random.uniform(0.0, size), random.uniform(0.0, size));
            DVec2 way(random.normal(), random.normal());
            const size_t points = 1 + random.below(random.below(8) == 0 ? 600 : 60);
            const double step = size * random.uniform(0.0, 0.03), turn = random.uniform(0.0, 2.0);
            const uint32_t kind = random.below(6);
            for (size_t n = 0; n < points; n++) {
                stroke.points.push_back(kind == 0 ? glm::floor(p / 20.0) * 20.0 : p);
                if (kind == 1 && n > 2)
                    stroke.points.push_back(stroke.points[random.below(static_cast<uint32_t>(n))]);
                way += turn * DVec2(random.normal(), random.normal());
                p += step * unit_or(way, DVec2(1, 0));
            }
            if (kind == 2) stroke.points.push_back(stroke.points[0]);
            stroke.role = static_cast<StrokeRole>(random.below(3) == 0 ? random.below(4) : 0);
            sketch.strokes.push_back(stroke);
        }
        ASSERT_NO_FATAL_FAILURE(try_it(sketch, trees)) << k;
    }
    EXPECT_GT(trees, static_cast<size_t>(cases(2000)) / 2);
}

TEST(SketchUnderstand, BigSketchesEnd) {
    size_t trees = 0;
    for (const size_t strokes : {1u, 3u, 1000u})
        for (const double far : {3.0, 1000.0, 90000.0}) {
            Random random(strokes);
            Sketch sketch;
            sketch.strokes.resize(strokes);
            for (Stroke& stroke : sketch.strokes) {
                DVec2 p(random.uniform(0.0, 1000.0), random.uniform(0.0, 1000.0));
                for (size_t n = 0; n < kMostStrokePoints / strokes; n++) {
                    stroke.points.push_back(p);
                    p = far < 10.0 ? p + far * DVec2(random.normal(), random.normal())
                                   : far * DVec2(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0));
                    p = glm::clamp(p, DVec2(-95000.0), DVec2(95000.0));
                }
            }
            ASSERT_NO_FATAL_FAILURE(try_it(sketch, trees));
        }
}

}  // namespace
}  // namespace treerec
