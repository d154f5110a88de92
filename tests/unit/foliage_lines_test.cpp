#include "exchange/foliage_lines.h"

#include <gtest/gtest.h>

#include <string>

#include "error.h"
#include "exchange/skeleton_parsers.h"
#include "geometry/random.h"
#include "scan_samples.h"

namespace treerec {
namespace {

Foliage random_foliage(Random& random, size_t cells, bool colored) {
    Foliage foliage;
    foliage.origin = {random.uniform(-9.0, 9.0), random.uniform(0.0, 9.0), random.uniform(-9.0, 9.0)};
    foliage.edge = random.uniform(0.05, 0.5);
    foliage.reach = random.uniform(0.0, 1.0) < 0.5 ? 0.0 : 1.25;
    foliage.colored = colored;
    for (size_t i = 0; i < cells; i++) {
        FoliageCell cell;
        cell.x = static_cast<uint16_t>(i / 30);
        cell.y = static_cast<uint16_t>(i % 30);
        cell.z = static_cast<uint16_t>(random.below(60000));
        cell.points = static_cast<uint16_t>(1 + random.below(60000));
        if (colored)
            for (uint8_t& channel : cell.color)
                channel = static_cast<uint8_t>(random.below(256));
        foliage.cells.push_back(cell);
    }
    return foliage;
}

Tree small_tree() {
    Tree tree;
    ScanFrame frame;
    frame.up = UpAxis::kZ;
    frame.origin = {470600.0, 3810200.0, 2280.0};
    tree.set_frame(frame);
    NodeId node = tree.add_root({0.25, 0.0, -0.5}, 0.2);
    for (int i = 1; i < 9; i++)
        node = tree.add_child(node, {0.25, 0.5 * i, -0.5}, 0.2 / i);
    return tree;
}

class FoliageLinesFiles : public ::testing::Test {
  protected:
    scan_test::Folder folder_;
};

TEST_F(FoliageLinesFiles, KeepItToTheBit) {
    Random random(4);
    const Tree tree = small_tree();
    for (const size_t cells : {1u, 63u, 64u, 65u, 900u}) {
        for (const bool colored : {false, true}) {
            const Foliage was = random_foliage(random, cells, colored);
            write_treefile(folder_.file("tree.txt"), tree, was);
            SkeletonReport report;
            const Tree read = read_treefile(folder_.file("tree.txt"), {}, &report);
            EXPECT_EQ(read.size(), tree.size());
            EXPECT_EQ(report.foliage.cells, was.cells);
            EXPECT_EQ(report.foliage.edge, was.edge);
            EXPECT_EQ(report.foliage.reach, was.reach);
            EXPECT_EQ(report.foliage.colored, was.colored);
            // The place is told from the root, which is where it was in the scan.
            const DVec3 moved = was.origin - tree.node(tree.root()).position;
            EXPECT_LT(glm::length(report.foliage.origin - moved), 1e-12);
            EXPECT_TRUE(is_skeleton_file(folder_.file("tree.txt"))) << "however long its comments are";
        }
    }
}

TEST_F(FoliageLinesFiles, FilesWithoutAnyAreAsBefore) {
    write_treefile(folder_.file("tree.txt"), small_tree());
    SkeletonReport report;
    read_treefile(folder_.file("tree.txt"), {}, &report);
    EXPECT_TRUE(report.foliage.empty());
}

TEST_F(FoliageLinesFiles, DamageIsSaid) {
    const std::string nodes = "x,y,z,radius,parent_id\n0,0,0,0.1,-1, 0,0,1,0.1,0\n";
    const std::string head = "# treerec foliage 0 0 0 0.12 0 0 2\n";
    const auto sentence = [&](const std::string& comments) -> std::string {
        try {
            parse_treefile(comments + nodes, "tree.txt", {});
        } catch (const Error& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_EQ(sentence(head + "# treerec leaves 1 1 1 5 1 1 2 5\n"), "");
    for (const std::string& damaged :
         {head,                                                     // no cells
          head + "# treerec leaves 1 1 1 5\n",                      // too few
          head + "# treerec leaves 1 1 1 5 1 1 2\n",                // not whole
          head + "# treerec leaves 1 1 1 5 1 1 2 5 1 1 3 5\n",      // too many
          head + "# treerec leaves 1 1 2 5 1 1 1 5\n",              // out of order
          head + "# treerec leaves 1 1 1 0 1 1 2 5\n",              // without points
          head + "# treerec leaves 1 1 1 5 1 1 70000 5\n",          // out of bounds
          head + "# treerec leaves 1 1 1 5 1 1 x 5\n",              // no number
          head + head + "# treerec leaves 1 1 1 5 1 1 2 5\n",       // twice
          std::string("# treerec leaves 1 1 1 5\n"),                // without a head
          std::string("# treerec foliage 0 0 0 0.12 0 0 90000\n"),  // more than there can be
          std::string("# treerec foliage 0 0 0 -1 0 0 1\n# treerec leaves 1 1 1 5\n"),
          std::string("# treerec foliage 0 0 nan 0.12 0 0 1\n# treerec leaves 1 1 1 5\n")})
        EXPECT_NE(sentence(damaged).find("damaged: its foliage"), std::string::npos) << damaged;
}

}  // namespace
}  // namespace treerec
