// Columns that say which points are leaf and which wood.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "scan/leaves/wood_leaf.h"
#include "scan_samples.h"
#include "synth/grow.h"
#include "synth/scan.h"

namespace treerec {
namespace {

using scan_test::read_text_of;

// A tree of 10 m whose outer twigs are leaves, as points and whether they are.
struct Labelled {
    std::vector<Vec3> points;  // Y up
    std::vector<bool> leaf;
};

Labelled labelled_tree() {
    Labelled tree;
    tree.points = scan_test::tree_points(3);
    tree.leaf.resize(tree.points.size(), false);
    Random random(5);
    for (int i = 0; i < 9000; i++) {
        const DVec3 out = random.direction();
        tree.points.emplace_back(DVec3(0.0, 7.0, 0.0) +
                                 DVec3(2.0, 2.5, 2.0) * out * random.uniform(0.4, 1.0));
        tree.leaf.push_back(true);
    }
    return tree;
}

// `label` writes the last column of a point.
template <typename Label>
std::string text_of(const Labelled& tree, const std::string& header, Label label) {
    std::string text = header;
    for (size_t i = 0; i < tree.points.size(); i++) {
        char line[100];
        std::snprintf(line, sizeof line, "%.5f,%.5f,%.5f,", static_cast<double>(tree.points[i].x),
                      -static_cast<double>(tree.points[i].z), static_cast<double>(tree.points[i].y));
        text += line + std::string(label(tree.leaf[i])) + "\n";
    }
    return text;
}

WoodLeaf tell(PointCloud cloud) {
    OrientOptions upright;
    upright.up = UpAxis::kZ;
    upright.metres_per_unit = 1.0;
    orient_cloud(cloud, upright);
    return tell_wood_from_leaves(cloud);
}

void expect_labels(const WoodLeaf& told, const Labelled& tree, const std::string& what) {
    ASSERT_TRUE(told.by_labels) << what;
    ASSERT_EQ(told.leaf.size(), tree.leaf.size());
    for (size_t i = 0; i < tree.leaf.size(); i++) {
        ASSERT_EQ(told.leaf[i] != 0, tree.leaf[i]) << what << i;
        ASSERT_EQ(told.wood_path[i] != 0, !tree.leaf[i]) << what << i;
    }
    ASSERT_EQ(told.warnings.size(), 1u) << what;
    EXPECT_NE(told.warnings[0].find("9000 of"), std::string::npos) << told.warnings[0];
}

TEST(Labels, OfTextAreUsedWhateverTheyAreCalled) {
    const Labelled tree = labelled_tree();
    struct Case {
        const char* column;
        const char* leaf;
        const char* wood;
    };
    for (const Case& c :
         {Case{"classification", "0", "1"}, Case{"classification", "1", "0"}, Case{"Label", "7", "3"},
          Case{"foliage", "1", "0"}, Case{"foliage", "0.9", "0.2"}, Case{"is_leaf", "1", "0"},
          Case{"leaf", "2", "1"}, Case{"wood", "0", "1"}, Case{"scalar_label", "2.000000", "1.000000"},
          Case{"label", "leaf", "wood"}, Case{"class", "Foliage", "\"stem\""}}) {
        const auto label = [&](bool leaf) { return leaf ? c.leaf : c.wood; };
        const std::string text = text_of(tree, std::string("x,y,z,") + c.column + "\n", label);
        const PointCloud cloud = read_text_of(text, "a.csv");
        EXPECT_EQ(cloud.labels.column, c.column);
        expect_labels(tell(cloud), tree, c.column + std::string(" ") + c.leaf);
    }
    // Without a header the user says it.
    const auto one = [](bool leaf) { return leaf ? "1" : "0"; };
    EXPECT_TRUE(read_text_of(text_of(tree, "", one), "a.csv").labels.empty());
    expect_labels(tell(read_text_of(text_of(tree, "", one), "a.csv", nullptr, {{"x", "y", "z", "leaf"}})),
                  tree, "named");
}

TEST(Labels, OfPlyAndPcdAreUsed) {
    const Labelled tree = labelled_tree();
    const std::string count = std::to_string(tree.points.size());
    std::string rows;
    for (size_t i = 0; i < tree.points.size(); i++) {
        char line[100];
        std::snprintf(line, sizeof line, "%.5f %.5f %.5f %d\n", static_cast<double>(tree.points[i].x),
                      -static_cast<double>(tree.points[i].z), static_cast<double>(tree.points[i].y),
                      tree.leaf[i] ? 4 : 9);
        rows += line;
    }
    expect_labels(tell(read_cloud_bytes(
                      "a.ply", "ply\nformat ascii 1.0\nelement vertex " + count +
                                   "\nproperty float x\nproperty float y\nproperty float z\nproperty uchar "
                                   "classification\nend_header\n" +
                                   rows)),
                  tree, "PLY");
    expect_labels(tell(read_cloud_bytes("a.pcd",
                                        "VERSION .7\nFIELDS x y z label\nSIZE 4 4 4 4\nTYPE F F F U\nCOUNT 1 "
                                        "1 1 1\nWIDTH " +
                                            count + "\nHEIGHT 1\nPOINTS " + count + "\nDATA ascii\n" + rows)),
                  tree, "PCD");
}

// The numbers of trees, the classes of an aeroplane's survey, one value alone: nothing is told by them.
TEST(Labels, ThatSayOtherThingsAreNotUsed) {
    const Labelled tree = labelled_tree();
    size_t i = 0;
    for (const auto& [column, value] : std::vector<std::pair<std::string, std::string (*)(size_t)>>{
             {"label", [](size_t n) { return std::to_string(n % 2); }},    // no more wood at the foot
             {"label", [](size_t n) { return std::to_string(n % 5); }},    // too many
             {"classification", [](size_t) { return std::string("1"); }},  // one
             {"label", [](size_t n) { return std::to_string(0.37 * static_cast<double>(n)); }},  // no labels
             {"label", [](size_t) { return std::string("oak"); }},
             {"foliage", [](size_t) { return std::string("1"); }}}) {
        i = 0;
        const auto label = [&, make = value](bool) { return make(i++); };
        const WoodLeaf told = tell(read_text_of(text_of(tree, "x,y,z," + column + "\n", label), "a.csv"));
        EXPECT_FALSE(told.by_labels) << column;
    }
    // Ground below a tree: it has the foot, and does not reach into the crown.
    PointCloud cloud;
    for (const Vec3& p : tree.points) {
        cloud.positions.push_back(p);
        cloud.labels.values.push_back(1);
    }
    Random random(1);
    for (int n = 0; n < 9000; n++) {
        cloud.positions.emplace_back(random.uniform(-3.0, 3.0), random.uniform(-0.1, 0.1),
                                     random.uniform(-3.0, 3.0));
        cloud.labels.values.push_back(2);
    }
    cloud.labels.column = "classification";
    EXPECT_FALSE(tell_wood_from_leaves(cloud).by_labels);
}

TEST(Labels, ABareTreesLabelsSayThatItIsBare) {
    const Labelled tree = labelled_tree();
    const auto none = [](bool) { return "0"; };
    const WoodLeaf told = tell(read_text_of(text_of(tree, "x,y,z,foliage\n", none), "a.csv"));
    EXPECT_FALSE(told.foliage);
    EXPECT_TRUE(told.leaf.empty());
}

TEST(Labels, FollowTheirPoints) {
    PointCloud cloud;
    for (int i = 0; i < 10; i++) {
        cloud.positions.emplace_back(i, 0, 0);
        cloud.labels.values.push_back(static_cast<uint8_t>(i));
    }
    cloud.keep_only({1, 0, 1, 0, 1, 0, 1, 0, 1, 0});
    EXPECT_EQ(cloud.labels.values, (std::vector<uint8_t>{0, 2, 4, 6, 8}));
    // Rows that are left out take their labels with them.
    const PointCloud read = read_text_of("x y z label\n0 0 0 1\nnan 0 0 2\n1 0 0 3\n0 1 1 4\n");
    EXPECT_EQ(read.labels.values, (std::vector<uint8_t>{1, 3, 4}));
}

// Of a palm whose fronds are labelled nobody asked whether they were fronds: it had up to eight times its
// wood.
TEST(Labels, FrondsAreFrondsAndOtherLeavesAreNot) {
    for (const Habit habit : all_habits()) {
        VirtualScanOptions options = scan_options_for(habit);
        options.seed = 7;
        options.points = 40000;
        if (habit != Habit::kPalm) options.leaves = 0.6;
        VirtualScan scan = scan_tree(grow_tree({habit, 0.0, 7}), options);
        scan.cloud.colors.clear();
        for (const uint8_t origin : scan.origin)
            scan.cloud.labels.values.push_back(origin == kFromLeaf ? 1 : 0);
        scan.cloud.labels.column = "leaf";
        const WoodLeaf told = tell_wood_from_leaves(scan.cloud);
        ASSERT_TRUE(told.by_labels) << habit_name(habit);
        EXPECT_EQ(told.fronds, habit == Habit::kPalm) << habit_name(habit);
        EXPECT_EQ(told.warnings.size(), told.fronds ? 2U : 1U);  // the labels' sentence, and the palm's
        // Labels win: no leaf is wood, nor any wood leaf.
        for (size_t i = 0; i < scan.origin.size(); i++)
            ASSERT_EQ(told.leaf[i], scan.cloud.labels.values[i]);
    }
}

}  // namespace
}  // namespace treerec
