// A thousand scribbled trees, and things that are none.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>

#include "cases.h"
#include "doodles.h"
#include "error.h"
#include "sketch/sketch.h"

namespace treerec {
namespace {

using test::cases;
using test::Doodle;
using test::is_long_run;
using test::scribbled_doodle;

// Of any tree; and of the seconds of one of them, several times what a slow machine needs.
constexpr size_t kMostNodes = 150000;
constexpr double kMostSeconds = 5.0;

double seconds_now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

bool same(const Tree& a, const Tree& b) {
    if (a.size() != b.size()) return false;
    for (const NodeId id : a.depth_first()) {
        const Node &one = a.node(id), &other = b.node(id);
        if (one.position != other.position || one.radius != other.radius || one.parent != other.parent ||
            one.flags != other.flags)
            return false;
    }
    return true;
}

// Of both boxes the share that is in both.
double boxes_iou(const DVec2& low, const DVec2& high, const DVec2& other_low, const DVec2& other_high) {
    const DVec2 common = glm::min(high, other_high) - glm::max(low, other_low);
    if (common.x <= 0.0 || common.y <= 0.0) return 0.0;
    const DVec2 one = high - low, other = other_high - other_low;
    const double both = common.x * common.y;
    return both / (one.x * one.y + other.x * other.y - both);
}

// Whether the tree stands where that of the doodle does and its crown is that crown, roughly.
bool is_that_tree(const Doodle& doodle, const SketchedTree& made) {
    const double pixel = doodle.sketch.canvas.y / kCanvasHeight;
    DVec2 low(1e300), high(-1e300);
    for (const DVec2& p : made.understood.drawn.outline) {
        const DVec2 at(p.x * pixel, doodle.sketch.canvas.y - p.y * pixel);
        low = glm::min(low, at);
        high = glm::max(high, at);
    }
    const double height = doodle.stem_base.y - doodle.crown_low.y;
    if (doodle.has_outline && !made.understood.drawn.outline_stroke) return false;
    return boxes_iou(low, high, doodle.crown_low, doodle.crown_high) > 0.5 &&
           glm::length(made.stem_base - doodle.stem_base) < 0.15 * height;
}

void check_tree(const SketchedTree& made, const Doodle& doodle) {
    const std::optional<std::string> broken = made.tree.check();
    ASSERT_FALSE(broken) << *broken;
    ASSERT_GE(made.tree.size(), 2u);
    ASSERT_LE(made.tree.size(), kMostNodes);
    ASSERT_EQ(made.tree.size(), made.stroke_of_node.size());
    ASSERT_EQ(made.understood.strokes.size(), doodle.sketch.strokes.size());
    ASSERT_TRUE(made.scale > 0.0 && std::isfinite(made.scale));
    const double height = doodle.sketch.height > 0.0 ? doodle.sketch.height : 40.0;
    for (const NodeId id : made.tree.depth_first())
        ASSERT_LT(glm::length(made.tree.node(id).position), 100.0 * height);
}

TEST(SketchDoodles, BecomeTreesOrAreToldWhy) {
    const int count = is_long_run() ? 1000 : cases(250);
    int tree_like = 0, trees = 0, those = 0, refused = 0, from_nothing = 0;
    size_t largest = 0;
    double longest = 0.0;
    std::map<std::string, std::string> missed;  // by kind: the seeds
    for (int k = 1; k <= count; k++) {
        const Doodle doodle = scribbled_doodle(static_cast<uint64_t>(k));
        SCOPED_TRACE(std::string(doodle.kind) + " " + std::to_string(k));
        if (doodle.tree_like) tree_like++;
        const double begin = seconds_now();
        SketchedTree made;
        try {
            made = sketch_tree(doodle.sketch, {});
        } catch (const Error& error) {
            refused++;
            const std::string why = error.what();
            EXPECT_GT(why.size(), 20u);
            EXPECT_EQ(why.back(), '.');
            if (doodle.tree_like) missed[doodle.kind] += " " + std::to_string(k);
            continue;
        }
        longest = std::max(longest, seconds_now() - begin);
        largest = std::max(largest, made.tree.size());
        ASSERT_NO_FATAL_FAILURE(check_tree(made, doodle));
        if (!doodle.tree_like) {
            from_nothing++;
            continue;
        }
        trees++;
        if (is_that_tree(doodle, made))
            those++;
        else
            missed[doodle.kind] += " " + std::to_string(k);
        if (k % 5 == 0) {
            EXPECT_TRUE(same(made.tree, sketch_tree(doodle.sketch, {}).tree));
        }
    }
    std::printf(
        "%d doodles, %d of trees: %d became a tree, %d that tree; of %d others %d; at most %zu nodes and "
        "%.2f s\n",
        count, tree_like, trees, those, count - tree_like, from_nothing, largest, longest);
    for (const auto& [kind, seeds] : missed)
        std::printf("  not that tree: %s%s\n", kind.c_str(), seeds.c_str());
    EXPECT_GE(trees, 0.97 * tree_like);
    EXPECT_GE(those, (test::kSanitized ? 0.95 : 0.97) * tree_like);
    EXPECT_LT(longest, kMostSeconds * (test::kSanitized ? 10.0 : 1.0));
}

// As printed, too, and with alpha shapes where CGAL is built in: they end, and are trees.
TEST(SketchDoodles, BecomeTreesAsPrinted) {
    const int count = is_long_run() ? 200 : cases(40);
    for (int k = 1; k <= count; k++) {
        const Doodle doodle = scribbled_doodle(static_cast<uint64_t>(5000 + k));
        SCOPED_TRACE(std::string(doodle.kind) + " " + std::to_string(k));
        SketchOptions options;
        options.depth = SketchDepth::kPaper;
        try {
            ASSERT_NO_FATAL_FAILURE(check_tree(sketch_tree(doodle.sketch, options), doodle));
        } catch (const Error& error) {
            EXPECT_NE(std::string(error.what()), "");
        }
    }
}

TEST(SketchDoodles, TheSameSeedIsTheSameDoodle) {
    for (uint64_t seed = 1; seed <= 20; seed++) {
        const Doodle one = scribbled_doodle(seed), other = scribbled_doodle(seed);
        ASSERT_EQ(one.sketch.strokes.size(), other.sketch.strokes.size());
        for (size_t i = 0; i < one.sketch.strokes.size(); i++)
            EXPECT_EQ(one.sketch.strokes[i].points, other.sketch.strokes[i].points);
        EXPECT_NE(one.sketch.strokes[0].points, scribbled_doodle(seed + 1).sketch.strokes[0].points);
    }
}

}  // namespace
}  // namespace treerec
