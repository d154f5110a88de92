// The picture of a whole tree.
#include "mesh/tree_picture.h"

#include <gtest/gtest.h>

#include "error.h"
#include "foliage/leaf_rules.h"
#include "random_tree.h"

namespace treerec {
namespace {

struct Counted {
    int seen = 0, green = 0, top = 0;
};

Counted count(const Image& image) {
    Counted counted;
    for (int y = 0; y < image.height; y++) {
        for (int x = 0; x < image.width; x++) {
            const uint8_t* pixel = image.at(x, y);
            if (pixel[3] == 0) continue;
            counted.seen++;
            counted.green += pixel[1] > pixel[0] && pixel[1] > pixel[2];
            counted.top += 2 * y < image.height;
        }
    }
    return counted;
}

TEST(TreePicture, FillsItsSquareAtEverySize) {
    const Tree tree = test::random_tree(2, 1500);
    const auto leaves = place_leaves(tree, leaf_preset("oak"), 1);
    for (const int size : {16, 64, 129, 256}) {
        const Image image = draw_tree(tree, leaves, tree_colors("oak"), size);
        ASSERT_EQ(image.pixels.size(), static_cast<size_t>(size) * size * 4);
        int top = size, bottom = 0;
        for (int y = 0; y < size; y++)
            for (int x = 0; x < size; x++)
                if (image.at(x, y)[3] > 0) {
                    top = std::min(top, y);
                    bottom = std::max(bottom, y);
                }
        EXPECT_LE(top, 0.05 * size + 1);
        EXPECT_GE(bottom, 0.95 * size - 2);
        const Counted counted = count(image);
        EXPECT_GT(counted.seen, size * size / 20);
        EXPECT_LT(counted.seen, size * size * 9 / 10);
        EXPECT_GT(counted.green, counted.seen / 2);
    }
}

TEST(TreePicture, BareWoodIsNotGreen) {
    const Tree tree = test::random_tree(3, 1500);
    for (const char* preset : {"generic", "oak", "birch", "palm", "no such one"}) {
        const Counted counted = count(draw_tree(tree, {}, tree_colors(preset), 96));
        EXPECT_GT(counted.seen, 300);
        EXPECT_EQ(counted.green, 0) << preset;
    }
}

TEST(TreePicture, RightIsRightAndUpIsUp) {
    Tree tree;
    tree.add_root({0, 0, 0}, 0.1);
    tree.add_child(0, {0, 4, 0}, 0.1);
    const NodeId branch = tree.add_child(1, {3, 4, 0}, 0.4);
    const Counted counted = count(draw_tree(tree, {}, {}, 64));
    EXPECT_GT(counted.top, counted.seen / 2);
    const auto lower = [](const Image& image, int from, int to) {
        int seen = 0;
        for (int y = 40; y < image.height; y++)
            for (int x = from; x < to; x++)
                seen += image.at(x, y)[3] > 0;
        return seen;
    };
    EXPECT_GT(lower(draw_tree(tree, {}, {}, 64), 0, 32), 20) << "the stem stands at the left";
    EXPECT_EQ(lower(draw_tree(tree, {}, {}, 64), 32, 64), 0);
    // What stands in front hides what is behind.
    TreeColors colors;
    const Image behind = draw_tree(tree, {}, colors, 64);
    tree.add_child(branch, {3, 4, 5}, 0.39);
    EXPECT_NE(draw_tree(tree, {}, colors, 64).pixels, behind.pixels);
}

TEST(TreePicture, ThickWoodAndNothingAtAll) {
    Tree tree;
    tree.add_root({0, 0, 0}, 50.0);
    EXPECT_EQ(count(draw_tree(tree, {}, {}, 32)).seen, 0) << "a root alone has no wood";
    tree.add_child(0, {0, 1e-3, 0}, 50.0);
    EXPECT_GT(count(draw_tree(tree, {}, {}, 32)).seen, 0);
    EXPECT_EQ(count(draw_tree(Tree(), {}, {}, 32)).seen, 0);
    EXPECT_THROW(draw_tree(tree, {}, {}, 15), Error);
    EXPECT_THROW(draw_tree(tree, {}, {}, 1025), Error);
    for (uint64_t seed = 1; seed <= 60; seed++) {
        const Tree wild = test::wild_tree(seed, 60);
        const auto leaves = place_leaves(wild, leaf_preset("palm"), seed);
        EXPECT_EQ(draw_tree(wild, leaves, {}, 48).pixels, draw_tree(wild, leaves, {}, 48).pixels);
    }
}

}  // namespace
}  // namespace treerec
