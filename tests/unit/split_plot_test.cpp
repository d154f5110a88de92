// Plots that are cut into trees: the same ones whatever the tiles, with nothing lost of where they stood.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>

#include "cli_runner.h"
#include "geometry/parallel.h"
#include "grown_plots.h"
#include "pipeline/split_plot.h"
#include "scan_samples.h"

namespace treerec {
namespace {

using namespace grown_plots;

const DVec3 kOnMap(470600.0, 3810200.0, 2280.0);  // UTM

// Z up, on a map.
PointCloud on_map(PointCloud cloud) {
    for (Vec3& p : cloud.positions)
        p = Vec3(p.x, -p.z, p.y);
    cloud.frame = {};
    cloud.frame.origin = kOnMap;
    return cloud;
}

DVec3 on_map(const DVec3& tree) {
    return kOnMap + DVec3(tree.x, -tree.z, tree.y);
}

const GrownPlot& sample_plot() {
    static const GrownPlot plot =
        make_plot({.trees = 7, .row = false, .overlap = 0.1, .ground = true, .points = 5000, .seed = 4});
    return plot;
}

class SplitPlot : public test::InFolder {
  protected:
    std::string plot(const std::string& name = "plot.ply") const {
        write_cloud(path(name), on_map(sample_plot().cloud));
        return path(name);
    }
    // Every file's bytes.
    std::map<std::string, std::string> files(const std::string& folder) const {
        std::map<std::string, std::string> all;
        for (const auto& entry : test::fs::directory_iterator(path(folder))) {
            const std::string name = entry.path().filename().string();
            all[name] = get(folder + "/" + name);
        }
        return all;
    }
    std::string failure(const std::string& scan, const SplitOptions& options = {}) const {
        try {
            split_plot(scan, path("trees"), options);
        } catch (const Error& error) {
            EXPECT_FALSE(test::fs::exists(path("trees"))) << error.what();
            EXPECT_FALSE(test::fs::exists(path("trees.part"))) << error.what();
            return error.what();
        }
        return {};
    }
};

// A virtual scanner's dust lies up to some metres around the plot.
SplitOptions in_tiles(double edge) {
    SplitOptions options;
    options.tile = edge;
    options.overlap = 6.0;
    return options;
}

std::optional<size_t> nearest(const SplitReport& report, const DVec3& foot, double most) {
    std::optional<size_t> found;
    for (size_t t = 0; t < report.trees.size(); t++) {
        const double away = glm::length(DVec2(report.trees[t].foot - foot));
        if (away > most) continue;
        most = away;
        found = t;
    }
    return found;
}

TEST_F(SplitPlot, TheTreesAreThoseThatWereGrownWhateverTheTiles) {
    const std::string scan = plot();
    std::vector<SplitReport> reports;
    size_t before = 0;
    for (const double edge : {500.0, 14.0, 6.0}) {
        SCOPED_TRACE(edge);
        reports.push_back(split_plot(scan, path("trees"), in_tiles(edge)));
        const SplitReport& report = reports.back();
        EXPECT_GT(report.tiles, before);
        before = report.tiles;
        EXPECT_EQ(report.trees.size(), sample_plot().feet.size());
        for (const DVec3& foot : sample_plot().feet) {
            const auto found = nearest(report, on_map(foot), 0.5);
            ASSERT_TRUE(found) << foot.x << " " << foot.z;
            EXPECT_NEAR(report.trees[*found].foot.z, on_map(foot).z, 0.3);
        }
    }
    EXPECT_EQ(reports[0].tiles, 1U);
    EXPECT_GE(reports[2].tiles, 9U);
    for (const SplitReport& report : reports)
        for (size_t t = 0; t < report.trees.size(); t++) {
            const SplitTree& whole = reports[0].trees[t];
            EXPECT_NEAR(report.trees[t].tree.height, whole.tree.height, 0.3) << t;
            const auto points = static_cast<double>(whole.tree.points);
            EXPECT_NEAR(static_cast<double>(report.trees[t].tree.points), points, 0.15 * points) << t;
        }
}

// Each point of a tree's cloud is one of the scan's, to the digit, and most are those of the tree that was
// grown there.
TEST_F(SplitPlot, TreesKeepTheirPlace) {
    const SplitReport report = split_plot(plot(), path("trees"), in_tiles(20.0));
    size_t right = 0, all = 0;
    for (size_t tree = 0; tree < sample_plot().feet.size(); tree++) {
        const auto found = nearest(report, on_map(sample_plot().feet[tree]), 0.5);
        ASSERT_TRUE(found);
        const PointCloud cloud = read_cloud(path("trees/" + report.trees[*found].name + ".ply"));
        EXPECT_EQ(cloud.size(), report.trees[*found].tree.points);
        std::map<std::array<long, 3>, uint32_t> owners;
        const auto key = [](const DVec3& p) {
            return std::array{std::lround(1e3 * p.x), std::lround(1e3 * p.y), std::lround(1e3 * p.z)};
        };
        for (size_t i = 0; i < sample_plot().cloud.size(); i++)
            owners[key(on_map(DVec3(sample_plot().cloud.positions[i])) - kOnMap)] = sample_plot().owner[i];
        size_t known = 0;
        for (const Vec3& p : cloud.positions) {
            const auto owner = owners.find(key(cloud.frame.to_scan(DVec3(p)) - kOnMap));
            known += owner != owners.end();
            right += owner != owners.end() && owner->second == tree;
        }
        all += cloud.size();
        // Rounding moves some into the next millimetre.
        EXPECT_GT(known, cloud.size() * 9 / 10);
    }
    EXPECT_GT(right, all * 8 / 10);
}

TEST_F(SplitPlot, NeitherThreadsNorTheOrderOfThePointsMatter) {
    split_plot(plot(), path("a"), in_tiles(20.0));
    PointCloud cloud = on_map(sample_plot().cloud);
    std::reverse(cloud.positions.begin(), cloud.positions.end());
    // plot.json names the scan.
    write_cloud(path("plot.ply"), cloud);
    set_thread_count(1);
    split_plot(path("plot.ply"), path("b"), in_tiles(20.0));
    set_thread_count(0);
    EXPECT_GT(files("a").size(), 8U);
    EXPECT_EQ(files("a"), files("b"));
}

TEST_F(SplitPlot, ALasFileIsReadInPieces) {
    const SplitReport whole = split_plot(plot("plot.las"), path("a"), in_tiles(20.0));
    SplitOptions options = in_tiles(20.0);
    options.piece = 10007;
    const SplitReport pieces = split_plot(path("plot.las"), path("b"), options);
    EXPECT_EQ(pieces.points, whole.points);
    ASSERT_EQ(pieces.trees.size(), whole.trees.size());
    for (size_t t = 0; t < whole.trees.size(); t++) {
        EXPECT_LT(glm::distance(pieces.trees[t].foot, whole.trees[t].foot), 0.02);
        EXPECT_NEAR(static_cast<double>(pieces.trees[t].tree.points),
                    static_cast<double>(whole.trees[t].tree.points), 30.0);
    }
    // Cut off: as the reader of whole files says.
    const std::string bytes = get("plot.las");
    put("cut.las", bytes.substr(0, bytes.size() - 100));
    EXPECT_NE(failure(path("cut.las"), options).find("is cut off"), std::string::npos);
}

// ground.exr as a program that knows the format reads it: of one channel, without compression.
struct ExrHeights {
    size_t width = 0, depth = 0;
    std::vector<float> values;
};

ExrHeights read_exr(const std::string& bytes) {
    const auto number = [&](size_t at) {
        uint32_t value = 0;
        std::memcpy(&value, bytes.data() + at, 4);
        return value;
    };
    EXPECT_EQ(number(0), 20000630U);
    const size_t window = bytes.find("dataWindow") + 11 + 6 + 4;
    ExrHeights map{number(window + 8) + 1, number(window + 12) + 1, {}};
    const size_t end = bytes.find("screenWindowWidth") + 18 + 6 + 4 + 4 + 1;
    for (size_t y = 0; y < map.depth; y++) {
        uint64_t row = 0;
        std::memcpy(&row, bytes.data() + end + 8 * y, 8);
        EXPECT_EQ(number(row), y);
        EXPECT_EQ(number(row + 4), 4 * map.width);
        for (size_t x = 0; x < map.width; x++) {
            float value = 0.0F;
            std::memcpy(&value, bytes.data() + row + 8 + 4 * x, 4);
            map.values.push_back(value);
        }
    }
    EXPECT_EQ(bytes.size(), end + map.depth * (8 + 8 + 4 * map.width));
    return map;
}

TEST_F(SplitPlot, TheGroundIsThatOfTheScan) {
    split_plot(plot(), path("trees"), in_tiles(20.0));
    const ExrHeights map = read_exr(get("trees/ground.exr"));
    const auto json = nlohmann::json::parse(get("trees/plot.json"));
    const auto& ground = json["ground"];
    ASSERT_EQ(map.width, ground["width"].get<size_t>());
    ASSERT_EQ(map.depth, ground["depth"].get<size_t>());
    ScanFrame frame;
    frame.up = parse_up_axis(json["frame"]["up"].get<std::string>());
    for (int axis = 0; axis < 3; axis++)
        frame.origin[axis] = json["frame"]["origin"][static_cast<size_t>(axis)];
    Bounds feet;
    for (const DVec3& foot : sample_plot().feet)
        feet.add(foot);
    size_t pixels = 0, near = 0;
    double most = 0.0;
    for (size_t z = 0; z < map.depth; z++)
        for (size_t x = 0; x < map.width; x++) {
            const DVec3 p(ground["first_pixel_m"][0].get<double>() + 0.5 * static_cast<double>(x),
                          static_cast<double>(map.values[z * map.width + x]),
                          ground["first_pixel_m"][1].get<double>() + 0.5 * static_cast<double>(z));
            const DVec3 scan = frame.to_scan(p) - kOnMap;
            const DVec3 grown(scan.x, scan.z, -scan.y);
            if (grown.x < feet.min.x - 3.0 || grown.x > feet.max.x + 3.0 || grown.z < feet.min.z - 3.0 ||
                grown.z > feet.max.z + 3.0)
                continue;
            pixels++;
            const double off = std::abs(grown.y - ground_at({grown.x, grown.z}));
            near += off < 0.05;
            most = std::max(most, off);
        }
    EXPECT_GT(pixels, 400U);
    EXPECT_GT(near, pixels * 95 / 100);
    // Where a stout stem stands on it.
    EXPECT_LT(most, 0.2);
}

TEST_F(SplitPlot, ATableTellsOfEachTree) {
    const SplitReport report = split_plot(plot(), path("trees"), {});
    std::istringstream table(get("trees/trees.csv"));
    std::string line;
    std::getline(table, line);
    EXPECT_EQ(line, kSplitColumns);
    size_t rows = 0;
    for (; std::getline(table, line); rows++)
        EXPECT_TRUE(line.starts_with(report.trees[rows].name + "," + report.trees[rows].name + ".ply,470"))
            << line;
    EXPECT_EQ(rows, report.trees.size());
    const size_t with_dbh = static_cast<size_t>(std::count_if(
        report.trees.begin(), report.trees.end(), [](const SplitTree& t) { return t.tree.dbh > 0.0; }));
    EXPECT_GE(with_dbh, rows - 2);
}

TEST_F(SplitPlot, OneTreeAloneIsAPlotOfOne) {
    GrowOptions grow;
    grow.height = 9.0;
    VirtualScanOptions scan;
    scan.stray = 0.0;
    const Tree tree = grow_tree(grow);
    write_cloud(path("tree.ply"), scan_tree(tree, scan).cloud);
    const SplitReport report = split_plot(path("tree.ply"), path("trees"), {});
    ASSERT_EQ(report.trees.size(), 1U);
    EXPECT_NEAR(report.trees[0].tree.height, tree.bounds().size().y, 0.5);
    EXPECT_LT(glm::length(report.trees[0].foot), 0.5);
    EXPECT_FALSE(report.ground);
    EXPECT_FALSE(test::fs::exists(path("trees/ground.exr")));
}

TEST_F(SplitPlot, WhatIsNoPlotIsToldInASentence) {
    EXPECT_NE(failure(path("none.ply")).find("none.ply"), std::string::npos);
    EXPECT_NE(failure(put("empty.xyz", "")).find("is empty"), std::string::npos);
    EXPECT_NE(failure(put("words.xyz", "no cloud at all\n")), "");
    Random random(3);
    PointCloud meadow;
    meadow.frame.up = UpAxis::kZ;
    for (int i = 0; i < 20000; i++) {
        const DVec2 p(random.uniform(0.0, 30.0), random.uniform(0.0, 30.0));
        meadow.positions.emplace_back(p.x, p.y, ground_at(p) + 0.01 * random.normal());
    }
    write_cloud(path("meadow.ply"), meadow);
    SplitOptions options = in_tiles(20.0);
    options.orient.up = UpAxis::kZ;
    EXPECT_NE(failure(path("meadow.ply"), options).find("No tree was found"), std::string::npos);
}

TEST_F(SplitPlot, WhatIsNotOfThisKindStays) {
    test::fs::create_directories(path("trees"));
    put("trees/thesis.txt", "years of work");
    EXPECT_THROW(split_plot(plot(), path("trees"), {}), Error);
    EXPECT_EQ(get("trees/thesis.txt"), "years of work");
    test::fs::create_directories(path("other.part"));
    put("other.part/thesis.txt", "years of work");
    EXPECT_THROW(split_plot(path("plot.ply"), path("other"), {}), Error);
    EXPECT_EQ(get("other.part/thesis.txt"), "years of work");
}

TEST_F(SplitPlot, ARunTakesThePlaceOfAnOlderOne) {
    split_plot(plot(), path("trees"), {});
    put("trees/tree_0099.ply", "of the older one");
    const auto made = files("trees");
    // What somebody has put there is nobody's to remove.
    const std::vector<std::string> kept = {"tree_0001_pruned.ply", "tree_1.ply", "notes.txt",
                                           "a/tree_0002.ply"};
    test::fs::create_directories(path("trees/a"));
    for (const std::string& name : kept)
        put("trees/" + name, "years of work");
    split_plot(path("plot.ply"), path("trees"), {});
    EXPECT_FALSE(test::fs::exists(path("trees/tree_0099.ply")));
    EXPECT_FALSE(test::fs::exists(path("trees.part")));
    for (const std::string& name : kept) {
        EXPECT_EQ(get("trees/" + name), "years of work") << name;
        test::fs::remove(path("trees/" + name));
    }
    test::fs::remove(path("trees/a"));
    auto again = files("trees");
    again["tree_0099.ply"] = "of the older one";
    EXPECT_EQ(again, made);
}

TEST_F(SplitPlot, ItStopsWhenAskedToAndLeavesNothing) {
    plot();
    test::StopAfter soon{std::chrono::milliseconds(150)};
    EXPECT_THROW(split_plot(path("plot.ply"), path("trees"), {}, &soon), Cancelled);
    EXPECT_FALSE(test::fs::exists(path("trees")));
    EXPECT_FALSE(test::fs::exists(path("trees.part")));
}

// A forest plot of a mobile scanner: what a small overlap changes are trees without a clear stem.
TEST_F(SplitPlot, ARealPlotsTreesStayWhereTheyAre) {
    if (scan_test::scans_folder().empty()) GTEST_SKIP() << "without TREEREC_SCANS";
    const std::string scan = scan_test::scans_folder() + "spanner_MLS_plot.laz";
    SplitReport whole;
    try {
        whole = split_plot(scan, path("a"), in_tiles(200.0));
    } catch (const Error& error) {
        if (std::string(error.what()).find("LASzip") == std::string::npos) throw;
        GTEST_SKIP() << error.what();
    }
    const SplitReport tiles = split_plot(scan, path("b"), in_tiles(14.0));
    EXPECT_EQ(tiles.tiles, 4U);
    EXPECT_GE(whole.trees.size(), 24U);
    EXPECT_NEAR(static_cast<double>(tiles.trees.size()), static_cast<double>(whole.trees.size()), 2.0);
    size_t same = 0;
    for (const SplitTree& tree : whole.trees)
        same += nearest(tiles, tree.foot, 0.3).has_value();
    EXPECT_GE(same, whole.trees.size() - 3);
}

using SplitPlotCli = test::Cli;

TEST_F(SplitPlotCli, TheProgramSaysWhatItDid) {
    write_cloud(path("plot.ply"), on_map(sample_plot().cloud));
    const test::Outcome done = run("split plot.ply trees/ --tile 20");
    EXPECT_EQ(done.code, 0) << done.error;
    EXPECT_NE(done.out.find("7 trees of "), std::string::npos) << done.out;
    EXPECT_NE(done.error.find("Trees"), std::string::npos);
    const test::Outcome tree = run("reconstruct trees/tree_0001.ply --one-tree -o out/a.txt --quiet");
    EXPECT_EQ(tree.code, 0) << tree.error;
    EXPECT_EQ(run("split plot.ply").code, 2);
    EXPECT_EQ(run("split plot.ply trees --tile 0").code, 2);
    put("file", "a file");
    EXPECT_EQ(run("split plot.ply file").code, 2);
    const test::Outcome none = run("split none.ply other");
    EXPECT_EQ(none.code, 1);
    EXPECT_NE(none.error.find("none.ply"), std::string::npos);
}

}  // namespace
}  // namespace treerec
