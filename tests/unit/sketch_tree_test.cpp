// Trees of strokes: what was drawn stays, what was not is there.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "foliage/leaves.h"
#include "geometry/segment.h"
#include "pipeline/sketch_report.h"
#include "sketch/crown_sections.h"
#include "sketch/fill.h"
#include "sketch/read_sketch.h"
#include "sketch/sketch.h"
#include "sketch/species.h"
#include "steady_sketches.h"

namespace treerec {

namespace {

constexpr int kSketches = 24;

// Where a place of the tree is seen on the canvas.
DVec2 seen(const SketchedTree& made, const DVec3& p) {
    return DVec2(made.stem_base.x + p.x / made.scale, made.stem_base.y - p.y / made.scale);
}

double from_line(const DVec2& p, const std::vector<DVec2>& line) {
    double least = 1e300;
    for (size_t i = 0; i + 1 < line.size(); i++)
        least =
            std::min(least, distance_to_segment(DVec3(p, 0.0), DVec3(line[i], 0.0), DVec3(line[i + 1], 0.0)));
    return least;
}

double width_of(const std::vector<double>& values) {
    return *std::max_element(values.begin(), values.end()) - *std::min_element(values.begin(), values.end());
}

std::vector<LeafPlacement> leaves_of(const SketchedTree& made) {
    return place_leaves(made.tree, leaf_preset(made.species), 1);
}

}  // namespace

TEST(CrownSections, ACircleIsABall) {
    std::vector<DVec2> outline;
    for (int i = 0; i < 720; i++) {
        const SineCosine turn = portable_sine_cosine(2.0 * kPi * i / 720.0);
        outline.emplace_back(3.0 + 2.0 * turn.cosine, 5.0 + 2.0 * turn.sine);
    }
    const CrownSections crown(outline, false);
    EXPECT_NEAR(crown.volume(), 4.0 / 3.0 * kPi * 8.0, 0.05);
    EXPECT_NEAR(crown.area(), kPi * 4.0, 0.01);
    Random random(3);
    for (int i = 0; i < 2000; i++) {
        const DVec3 p(random.uniform(0.5, 5.5), random.uniform(2.5, 7.5), random.uniform(-2.5, 2.5));
        const double from = glm::length(p - DVec3(3.0, 5.0, 0.0));
        if (std::abs(from - 2.0) > 0.02) {
            EXPECT_EQ(crown.contains(p), from < 2.0) << from;
        }
    }
    EXPECT_NEAR(crown.half_depth(3.0, 5.0), 2.0, 0.01);
    EXPECT_LT(crown.half_depth(5.2, 5.0), 0.0);
    const CrownSections square(outline, true);
    EXPECT_NEAR(square.volume(), 4.0 * 4.0 * 4.0 * 2.0 / 3.0, 0.05);
}

TEST(CrownSections, ACloudHasASectionForEachLobe) {
    // A U: at its upper half there are two widths.
    const std::vector<DVec2> outline = {{0, 0}, {6, 0}, {6, 4}, {4, 4}, {4, 2}, {2, 2}, {2, 4}, {0, 4}};
    const CrownSections crown(outline, false);
    EXPECT_EQ(crown.at(1.0).size(), 1u);
    EXPECT_EQ(crown.at(3.0).size(), 2u);
    EXPECT_FALSE(crown.contains(DVec3(3.0, 3.0, 0.0)));
    EXPECT_TRUE(crown.contains(DVec3(1.0, 3.0, 0.9)));
    EXPECT_FALSE(crown.contains(DVec3(1.0, 3.0, 1.1)));
    EXPECT_TRUE(crown.contains(DVec3(3.0, 1.0, 2.9)));
    EXPECT_TRUE(crown.at(-0.1).empty());
    EXPECT_THROW(CrownSections({{0, 0}, {1, 1}}, false), Error);
    EXPECT_THROW(CrownSections({{0, 0}, {1, 0}, {2, 0}}, false), Error);
}

TEST(SketchTree, TheFrontStaysAsItWasDrawn) {
    for (uint64_t seed = 1; seed <= kSketches; seed++) {
        const Sketch sketch = drawn_sketch(seed);
        const SketchedTree made = sketch_tree(sketch, {});
        ASSERT_FALSE(made.tree.check()) << *made.tree.check();
        ASSERT_EQ(made.stroke_of_node.size(), made.tree.size());
        std::vector<double> farthest(sketch.strokes.size(), 0.0);
        for (const NodeId id : made.tree.depth_first()) {
            const int32_t stroke = made.stroke_of_node[static_cast<size_t>(id)];
            if (stroke < 0) continue;
            const DVec2 at = seen(made, made.tree.node(id).position);
            // The trunk's own end inside the crown is not drawn.
            const std::vector<DVec2>& line = sketch.strokes[static_cast<size_t>(stroke)].points;
            if (made.tree.node(id).is_trunk() && at.y < line.back().y) continue;
            farthest[static_cast<size_t>(stroke)] =
                std::max(farthest[static_cast<size_t>(stroke)], from_line(at, line));
        }
        for (size_t i = 0; i < farthest.size(); i++)
            EXPECT_LE(farthest[i], 2.0) << "seed " << seed << ", stroke " << i;
        EXPECT_NEAR(made.tree.bounds().max.y, sketch.height, 0.1 * sketch.height) << seed;
    }
}

TEST(SketchTree, TheCrownIsAsDeepAsItIsWideAndHasNoEmptySide) {
    for (uint64_t seed = 1; seed <= kSketches; seed++) {
        const SketchedTree made = sketch_tree(drawn_sketch(seed), {});
        std::vector<double> x, z, around;
        double middle = 0.0;
        const std::vector<LeafPlacement> leaves = leaves_of(made);
        for (const LeafPlacement& leaf : leaves) {
            x.push_back(leaf.position.x);
            z.push_back(leaf.position.z);
            middle += leaf.position.x / static_cast<double>(leaves.size());
        }
        const double ratio = width_of(z) / width_of(x);
        EXPECT_GE(ratio, 0.8) << seed;
        EXPECT_LE(ratio, 1.2) << seed;
        for (size_t i = 0; i < x.size(); i++)
            around.push_back(std::atan2(z[i], x[i] - middle));
        std::sort(around.begin(), around.end());
        double gap = around.front() + 2.0 * kPi - around.back();
        for (size_t i = 1; i < around.size(); i++)
            gap = std::max(gap, around[i] - around[i - 1]);
        EXPECT_LT(gap * 180.0 / kPi, 75.0) << seed;
    }
}

TEST(SketchTree, FillsTheOutline) {
    double mean = 0.0;
    for (uint64_t seed = 1; seed <= 8; seed++) {
        const Sketch sketch = drawn_sketch(seed);
        const SketchedTree made = sketch_tree(sketch, {});
        const std::vector<OutlinePart> parts =
            outline_parts(made.tree, leaf_preset(made.species), made.species, 1, {});
        const CrownOverlap overlap = measure_crown_overlap(made, sketch, parts, 256);
        mean += overlap.overlap.iou / 8.0;
        EXPECT_GE(overlap.overlap.iou, 0.85) << seed;
        EXPECT_LE(overlap.outside, 0.03) << seed;
    }
    EXPECT_GE(mean, 0.92);
}

TEST(SketchTree, DrawnCasesFillTheirOutlines) {
    double mean = 0.0, count = 0.0;
    for (const char* name :
         {"bush", "cloud", "fir_like", "ginkgo", "leaning", "magnolia", "maple", "outline_and_trunk",
          "poplar", "slender", "twin_lobes", "two_line_trunk", "umbrella", "windswept"}) {
        const Sketch sketch = read_sketch(std::string("tests/sketch/cases/") + name + ".json");
        const SketchedTree made = sketch_tree(sketch, {});
        const std::vector<OutlinePart> parts =
            outline_parts(made.tree, leaf_preset(made.species), made.species, 1, {});
        const CrownOverlap overlap = measure_crown_overlap(made, sketch, parts, 128);
        EXPECT_GE(overlap.overlap.iou, 0.85) << name;
        EXPECT_LE(overlap.outside, 0.03) << name;
        EXPECT_EQ(made.understood.strokes[*made.understood.drawn.outline_stroke].role, StrokeRole::kOutline);
        mean += overlap.overlap.iou;
        count += 1.0;
    }
    EXPECT_GE(mean / count, 0.92);
}

// Drawn with two lines a trunk is thick where they end; the tree's goes on and tapers.
TEST(SketchTree, ThickTrunksEndThin) {
    for (const double top : {560.0, 400.0, 200.0, 70.0}) {
        Sketch sketch;
        sketch.height = 10.0;
        sketch.strokes.push_back(drawn_outline({500.0, 330.0}, {280.0, 290.0}));
        sketch.strokes.push_back(drawn_line({460.0, 960.0}, {470.0, top}));
        sketch.strokes.push_back(drawn_line({540.0, 960.0}, {530.0, top}));
        sketch.number_strokes();
        const SketchedTree made = sketch_tree(sketch, {});
        ASSERT_EQ(made.understood.strokes[1].role, StrokeRole::kTrunk);
        ASSERT_EQ(made.understood.strokes[2].role, StrokeRole::kTrunk);
        double end = 0.0, highest = 0.0;
        for (const NodeId id : made.tree.depth_first()) {
            const Node& node = made.tree.node(id);
            if (!(node.flags & kTrunkFlag) || node.position.y <= highest) continue;
            highest = node.position.y;
            end = node.radius;
        }
        EXPECT_LT(end, 0.15 * made.tree.node(made.tree.root()).radius) << top;
        EXPECT_GT(highest, 7.5) << top;
    }
}

TEST(SketchTree, RadiiTaperAndAreNeverTooThin) {
    for (uint64_t seed = 1; seed <= kSketches; seed++) {
        Sketch sketch = drawn_sketch(seed);
        SketchOptions options;
        options.density = 0.0;
        const SketchedTree made = sketch_tree(sketch, options);
        const double stem_base = made.tree.node(made.tree.root()).radius;
        EXPECT_NEAR(stem_base, sketch.height / 40.0, 1e-9);
        for (const NodeId id : made.tree.depth_first()) {
            const Node& node = made.tree.node(id);
            EXPECT_GE(node.radius, 0.002 - 1e-12);
            if (node.parent != kNoNode) {
                EXPECT_LE(node.radius, made.tree.node(node.parent).radius + 1e-12);
            }
        }
        options.trunk_radius = 0.3;
        EXPECT_NEAR(sketch_tree(sketch, options).tree.node(made.tree.root()).radius, 0.3, 1e-9);
    }
}

TEST(SketchTree, AsPrintedBranchesTurnWithinSixtyDegreesTenApart) {
    for (uint64_t seed = 1; seed <= kSketches; seed++) {
        const Sketch sketch = drawn_sketch(seed);
        SketchOptions options;
        options.depth = SketchDepth::kPaper;
        options.density = 0.0;
        const SketchedTree made = sketch_tree(sketch, options);
        std::vector<double> turns;
        for (size_t stroke = 2; stroke < sketch.strokes.size(); stroke++) {
            const auto& nodes = made.stroke_of_node;
            const auto tip = std::find(nodes.rbegin(), nodes.rend(), static_cast<int32_t>(stroke));
            const auto first = std::find(nodes.begin(), nodes.end(), static_cast<int32_t>(stroke));
            if (first == nodes.end()) continue;
            const auto tip_id = static_cast<NodeId>(nodes.rend() - tip - 1);
            const auto first_id = static_cast<NodeId>(first - nodes.begin());
            const DVec3 base = made.tree.node(made.tree.node(first_id).parent).position;
            const DVec3 way = made.tree.node(tip_id).position - base;
            turns.push_back(std::atan(way.z / way.x) * 180.0 / kPi);
        }
        std::sort(turns.begin(), turns.end());
        for (size_t i = 0; i < turns.size(); i++) {
            EXPECT_LE(std::abs(turns[i]), 60.0 + 1e-6);
            if (i > 0) {
                EXPECT_GE(turns[i] - turns[i - 1], 10.0 - 1e-6) << seed;
            }
        }
    }
    // More than fit: closer, and it is said.
    Sketch many = drawn_sketch(1);
    const Stroke branch = many.strokes.back();
    for (int i = 0; i < 20; i++) {
        many.strokes.push_back(branch);
        many.strokes.back().id = 0;
    }
    SketchOptions options;
    options.depth = SketchDepth::kPaper;
    EXPECT_FALSE(sketch_tree(many, options).remarks.empty());
}

TEST(SketchTree, TheSameStrokesGiveTheSameTree) {
    const Sketch sketch = drawn_sketch(5);
    for (const SketchDepth depth : {SketchDepth::kTrue, SketchDepth::kPaper}) {
        SketchOptions options;
        options.depth = depth;
        const SketchedTree a = sketch_tree(sketch, options), b = sketch_tree(sketch, options);
        ASSERT_EQ(a.tree.size(), b.tree.size());
        for (const NodeId id : a.tree.depth_first()) {
            EXPECT_EQ(a.tree.node(id).position, b.tree.node(id).position);
            EXPECT_EQ(a.tree.node(id).radius, b.tree.node(id).radius);
        }
        Sketch other = sketch;
        other.seed++;
        EXPECT_NE(sketch_tree(other, options).tree.bounds().max, a.tree.bounds().max);
    }
}

// What is drawn by chance for a stroke hangs on its id: another one before it changes nothing.
TEST(SketchTree, AStrokeKeepsItsDepthWhenAnotherGoes) {
    const Sketch sketch = drawn_sketch(11);
    ASSERT_GT(sketch.strokes.size(), 4u);
    SketchOptions options;
    options.density = 0.0;
    const SketchedTree all = sketch_tree(sketch, options);
    Sketch fewer = sketch;
    fewer.strokes.erase(fewer.strokes.begin() + 2);
    const SketchedTree without = sketch_tree(fewer, options);
    const auto tip_of = [](const SketchedTree& made, int32_t stroke) {
        const auto& nodes = made.stroke_of_node;
        const auto tip = std::find(nodes.rbegin(), nodes.rend(), stroke);
        return made.tree.node(static_cast<NodeId>(nodes.rend() - tip - 1)).position;
    };
    for (size_t i = 3; i < sketch.strokes.size(); i++)
        EXPECT_EQ(tip_of(all, static_cast<int32_t>(i)), tip_of(without, static_cast<int32_t>(i) - 1)) << i;
}

TEST(SketchTree, AlphaShapesBoundTheCrownToo) {
    for (uint64_t seed = 1; seed <= 4; seed++) {
        SketchOptions options;
        options.crown = SketchCrown::kAlpha;
        Sketch sketch = drawn_sketch(seed);
        sketch.height = 12.0;  // as tall as the twigs are for
        for (const SketchDepth depth : {SketchDepth::kTrue, SketchDepth::kPaper}) {
            options.depth = depth;
            const SketchedTree made = sketch_tree(sketch, options);
            EXPECT_GT(made.tree.size(), 300u) << seed;
            ASSERT_FALSE(made.tree.check());
        }
    }
}

// Twigs keep their lengths as printed: on a small tree most find no room, and it is said.
TEST(SketchTree, AsPrintedASmallTreeIsNearlyBare) {
    SketchOptions options;
    options.depth = SketchDepth::kPaper;
    Sketch sketch = drawn_sketch(2);
    sketch.height = 3.0;
    ASSERT_EQ(sketch_tree(sketch, options).remarks.size(), 1u);
    EXPECT_NE(sketch_tree(sketch, options).remarks[0].find("make the tree taller"), std::string::npos);
    sketch.height = 14.0;
    EXPECT_TRUE(sketch_tree(sketch, options).remarks.empty());
}

TEST(ChooseTwig, EquationFourBeforeScaling) {
    const SketchSpecies& maple = sketch_species("maple");
    const SpeciesTwig& longest = maple.twigs.back();
    // Within sqrt(5) cm of the room, and within 1 cm of the radius: as it is.
    auto chosen = choose_twig(maple, longest.length + 0.02, longest.radius + 0.005, 1.0, false);
    ASSERT_TRUE(chosen);
    EXPECT_EQ(chosen->twig, maple.twigs.size() - 1);
    EXPECT_EQ(chosen->scale, 1.0);
    // Three centimetres are too many: it is scaled.
    chosen = choose_twig(maple, longest.length + 0.03, longest.radius + 0.005, 1.0, false);
    ASSERT_TRUE(chosen);
    EXPECT_NEAR(chosen->scale, (longest.length + 0.03) / longest.length, 1e-12);
    // Never by more than 1.3, nor to less than 0.7.
    EXPECT_NEAR(choose_twig(maple, 100.0, 1.0, 1.0, false)->scale, 1.3, 1e-12);
    const double least = 0.7 * maple.twigs.front().length;
    EXPECT_TRUE(choose_twig(maple, least * 1.001, 1.0, 1.0, false));
    EXPECT_FALSE(choose_twig(maple, least * 0.999, 1.0, 1.0, false));
    EXPECT_TRUE(choose_twig(maple, least * 0.6, 1.0, 1.0, true));
    EXPECT_FALSE(choose_twig(maple, least * 0.4, 1.0, 1.0, true));
}

TEST(SketchTree, RefusesWhatItCannotDo) {
    Sketch sketch = drawn_sketch(1);
    SketchOptions options;
    options.density = -1.0;
    EXPECT_THROW(sketch_tree(sketch, options), Error);
    options.density = NAN;
    EXPECT_THROW(sketch_tree(sketch, options), Error);
    options = {};
    options.trunk_radius = 100.0;
    EXPECT_THROW(sketch_tree(sketch, options), Error);
    sketch.species = "baobab";
    EXPECT_THROW(sketch_tree(sketch, {}), Error);
    EXPECT_THROW(sketch_tree({}, {}), Error);
}

}  // namespace treerec
