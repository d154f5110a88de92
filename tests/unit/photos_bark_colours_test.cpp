// Leaves told by the colour of the stem's bark.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "cli_runner.h"
#include "geometry/random.h"
#include "photos/bark_colours.h"
#include "pipeline/label_photo_leaves.h"
#include "scan/formats/read_cloud.h"
#include "scan/leaves/wood_leaf.h"

namespace treerec {
namespace {

const DVec3 kSky(205.0, 212.0, 222.0);
const DVec3 kBark(96.0, 82.0, 70.0);

// As a camera may see it: in shade or in the sun, with some of the sky beside it, and noise.
Color8 seen(const DVec3& colour, Random& random) {
    const double light = random.uniform(0.4, 1.3),
                 sky = random.below(3) == 0 ? random.uniform(0.0, 0.8) : 0.0;
    Color8 found{};
    for (int part = 0; part < 3; part++)
        found[static_cast<size_t>(part)] = static_cast<uint8_t>(std::clamp(
            (1.0 - sky) * light * colour[part] + sky * kSky[part] + 3.0 * random.normal(), 0.0, 255.0));
    return found;
}

// A stem 1 m high of 1200 points and a crown above it of 3000, of which the lower half is wood.
struct Plant {
    PointCloud cloud;
    std::vector<uint32_t> bark;
    std::vector<uint8_t> is_leaf;
};

Plant plant(const DVec3& leaf, uint64_t seed) {
    Random random(seed);
    Plant made;
    for (int i = 0; i < 4200; i++) {
        const bool stem = i < 1200, wood = stem || i < 2700;
        const double angle = random.uniform(0.0, 2.0 * kPi);
        if (stem) {
            made.bark.push_back(static_cast<uint32_t>(i));
            made.cloud.positions.emplace_back(0.1 * std::cos(angle), random.uniform(0.0, 1.0),
                                              0.1 * std::sin(angle));
        } else {
            const double y = wood ? random.uniform(1.0, 1.9) : random.uniform(2.1, 3.0);
            made.cloud.positions.emplace_back(random.uniform(-0.8, 0.8), y, random.uniform(-0.8, 0.8));
        }
        made.cloud.colors.push_back(seen(wood ? kBark : leaf, random));
        made.is_leaf.push_back(!wood);
    }
    return made;
}

double rightly(const std::vector<uint8_t>& told, const std::vector<uint8_t>& truth) {
    size_t right = 0;
    for (size_t i = 0; i < truth.size(); i++)
        right += (told[i] != 0) == (truth[i] != 0);
    return static_cast<double>(right) / static_cast<double>(truth.size());
}

TEST(BarkColours, LeavesOfAnyColourAreUnlikeIt) {
    for (const DVec3& leaf : {DVec3(70, 110, 30), DVec3(190, 160, 30), DVec3(200, 80, 20), DVec3(150, 25, 30),
                              DVec3(230, 130, 180)}) {
        const Plant made = plant(leaf, 5);
        const std::vector<uint8_t> told = unlike_bark(made.cloud, made.bark, kSky);
        ASSERT_EQ(told.size(), made.cloud.size());
        EXPECT_GT(rightly(told, made.is_leaf), 0.97) << leaf.x << " " << leaf.y << " " << leaf.z;
    }
}

TEST(BarkColours, BareWoodIsLikeIt) {
    const Plant bare = plant(kBark, 6);
    for (const DVec3& sky : {kSky, DVec3(0.0)}) {
        const std::vector<uint8_t> told = unlike_bark(bare.cloud, bare.bark, sky);
        ASSERT_EQ(told.size(), bare.cloud.size());
        EXPECT_LT(std::count(told.begin(), told.end(), 1), 40);
    }
}

TEST(BarkColours, TellNothingWithoutColoursOrBark) {
    Plant made = plant({70, 110, 30}, 7);
    EXPECT_TRUE(unlike_bark(made.cloud, {}, kSky).empty());
    EXPECT_TRUE(unlike_bark(made.cloud, std::span(made.bark).first(20), kSky).empty());
    // A stem of all colours, as one that is hung with flags.
    Random random(8);
    for (const uint32_t i : made.bark)
        made.cloud.colors[i] = {static_cast<uint8_t>(random.below(256)),
                                static_cast<uint8_t>(random.below(256)),
                                static_cast<uint8_t>(random.below(256))};
    EXPECT_TRUE(unlike_bark(made.cloud, made.bark, kSky).empty());
    made.cloud.colors.clear();
    EXPECT_TRUE(unlike_bark(made.cloud, made.bark, kSky).empty());
}

Tree stem_and_bough() {
    Tree tree;
    NodeId here = tree.add_root({0, 0, 0}, 0.1);
    for (const double y : {0.5, 1.0, 2.0, 3.0})
        here = tree.add_child(here, {0, y, 0}, y < 1.5 ? 0.1 : 0.03);
    tree.add_child(here, {0.8, 3.0, 0}, 0.02);
    return tree;
}

class PhotoLeaves : public test::InFolder {};

TEST_F(PhotoLeaves, OfACrownAreLabelledAndThoseOfABareOneAreNot) {
    const Tree tree = stem_and_bough();
    Plant leafy = plant({190, 160, 30}, 9);
    ASSERT_TRUE(label_photo_leaves(leafy.cloud, tree, kSky));
    EXPECT_TRUE(leafy.cloud.labels.by_colour);
    EXPECT_GT(rightly(leafy.cloud.labels.values, leafy.is_leaf), 0.95);
    Plant bare = plant(kBark, 10);
    EXPECT_FALSE(label_photo_leaves(bare.cloud, tree, kSky));
    EXPECT_TRUE(bare.cloud.labels.empty());
    // A file keeps them, and that they are a hint.
    write_cloud(path("cloud.ply"), leafy.cloud);
    const PointCloud read = read_cloud(path("cloud.ply"));
    EXPECT_TRUE(read.labels.by_colour);
    EXPECT_EQ(read.labels.values, leafy.cloud.labels.values);
    // They lead where green does not: these leaves are yellow.
    const WoodLeaf told = tell_wood_from_leaves(read);
    ASSERT_TRUE(told.foliage);
    EXPECT_FALSE(told.by_labels);
    EXPECT_GT(rightly(told.leaf, leafy.is_leaf), 0.9);
}

}  // namespace
}  // namespace treerec
