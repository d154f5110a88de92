// Sketches with twigs of one's own: of a library, and of a tree with its angles and taper.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <memory>

#include "edit/graft/scion.h"
#include "edit/graft/twig_library.h"
#include "file_bytes.h"
#include "geometry/quantile.h"
#include "lsystem/lstring.h"
#include "pipeline/sketch_report.h"
#include "sketch/fill.h"
#include "sketch/read_sketch.h"
#include "sketch/read_twigs.h"
#include "sketch/sketch.h"
#include "sketch/twig_stock.h"
#include "steady_sketches.h"
#include "synth/grow.h"

namespace treerec {

namespace {

std::string sentence_of(const std::function<void()>& call) {
    try {
        call();
    } catch (const Error& error) {
        return error.what();
    }
    return {};
}

// Branches all around a trunk, each with twigs that leave it at so many degrees, and these with shoots: its
// wood is `stout` times as thick as usual.
Tree tree_with_angle(double degrees, double stout) {
    Tree tree;
    NodeId trunk = tree.add_root(DVec3(0.0), 0.1 * stout, kTrunkFlag);
    const auto line = [&](NodeId from, const DVec3& way, double length, double radius, int steps) {
        std::vector<NodeId> made{from};
        const DVec3 base = tree.node(from).position;
        for (int i = 1; i <= steps; i++) {
            const double share = static_cast<double>(i) / steps;
            made.push_back(
                tree.add_child(made.back(), base + way * (length * share), radius * (1.0 - 0.8 * share)));
        }
        return made;
    };
    const double off = degrees * kPi / 180.0;
    for (int i = 1; i <= 24; i++) {
        const double y = 0.4 * i;
        trunk = tree.add_child(trunk, DVec3(0.0, y, 0.0), 0.1 * stout * (1.0 - 0.9 * i / 24.0), kTrunkFlag);
        if (i < 6 || i == 24) continue;
        const DVec3 out(std::cos(2.4 * i), 0.6, std::sin(2.4 * i));
        const double reach = 0.35 * (10.0 - y) + 0.5;
        const std::vector<NodeId> side_branch = line(
            trunk, glm::normalize(out), reach, std::min(0.012 * stout * reach, tree.node(trunk).radius), 8);
        for (size_t k = 3; k < side_branch.size(); k++) {
            const DMat3 frame = frame_about(glm::normalize(out));
            const double roll = 2.4 * static_cast<double>(k) + i;
            const DVec3 side = frame[0] * std::cos(roll) + frame[2] * std::sin(roll);
            const DVec3 way = frame[1] * std::cos(off) + side * std::sin(off);
            const double length = 0.3 + 0.1 * static_cast<double>(k % 5);
            const double thick = std::min(0.006 * stout * length, 0.9 * tree.node(side_branch[k]).radius);
            const std::vector<NodeId> twig = line(side_branch[k], way, length, thick, 4);
            for (size_t s = 1; s < 4; s++) {
                const DVec3 shoot = glm::normalize(way + (s % 2 == 0 ? 0.7 : -0.7) * frame[1]);
                line(twig[s], shoot, 0.4 * length, 0.5 * tree.node(twig[s]).radius, 2);
            }
        }
    }
    return tree;
}

// Degrees, of the side branches that are no shorter than that on what grows from the trunk.
double usual_angle(const Tree& tree, double shortest) {
    const BranchStatistics statistics(tree);
    std::vector<double> angles;
    const std::vector<Branch>& branches = statistics.list().branches;
    for (size_t i = 0; i < branches.size(); i++) {
        if (branches[i].order == 0) continue;
        for (const SideBranch& side : statistics.sides(static_cast<int32_t>(i)))
            if (branches[static_cast<size_t>(side.branch)].length >= shortest)
                angles.push_back(side.angle * 180.0 / kPi);
    }
    return quantile(angles, 0.5);
}

Sketch with_stock(uint64_t seed, TwigStock stock) {
    Sketch sketch = drawn_sketch(seed);
    sketch.twigs = std::make_shared<const TwigStock>(std::move(stock));
    return sketch;
}

double overlap_of(const Sketch& sketch) {
    const SketchedTree made = sketch_tree(sketch, {});
    const std::vector<OutlinePart> parts =
        outline_parts(made.tree, leaf_preset(made.species), made.species, 1, {});
    return measure_crown_overlap(made, sketch, parts, 256).overlap.iou;
}

Tree grown(const std::string& habit, uint64_t seed) {
    GrowOptions options;
    options.habit = parse_habit(habit);
    options.seed = seed;
    return grow_tree(options);
}

TwigStock some_library() {
    std::vector<std::string> strings;
    for (const char* name : {"maple_long", "oak", "apple", "maple_short", "birch", "poplar_medium"})
        strings.emplace_back(find_library_twig(name).string);
    return stock_of_twigs(strings, "Mine");
}

}  // namespace

TEST(OwnTwigs, AReasonableLibraryFillsTheOutline) {
    for (uint64_t seed = 1; seed <= 3; seed++)
        EXPECT_GE(overlap_of(with_stock(seed, some_library())), 0.85) << seed;
}

TEST(OwnTwigs, ThoseOfATreeFillTheOutline) {
    // A forked tree's twigs are long and bare below: they leave more of a small crown open.
    for (const auto& [habit, least] :
         {std::pair("broadleaf", 0.85), {"conifer", 0.85}, {"birch", 0.85}, {"forked", 0.82}}) {
        const Tree tree = grown(habit, 3);
        for (uint64_t seed = 1; seed <= 2; seed++)
            EXPECT_GE(overlap_of(with_stock(seed, stock_of_tree(tree, habit))), least)
                << habit << " " << seed;
    }
}

TEST(OwnTwigs, ATreeGivesWellShapedOnesOfSeveralSizes) {
    for (const std::string& habit : habit_names()) {
        const Tree tree = grown(habit, 5);
        if (habit == "palm") {
            EXPECT_NE(sentence_of([&] { stock_of_tree(tree, ""); }).find("no side branches"),
                      std::string::npos);
            continue;
        }
        const TwigStock stock = stock_of_tree(tree, habit);
        EXPECT_GE(stock.twigs.size(), 4u) << habit;
        EXPECT_LE(stock.twigs.size(), 12u);
        EXPECT_NEAR(stock.height, tree.bounds().max.y - tree.node(tree.root()).position.y, 1e-9);
        const double shortest = scion_length(stock.twigs.front().scion);
        const double longest = scion_length(stock.twigs.back().scion);
        EXPECT_GT(longest, 1.5 * shortest) << habit;
        EXPECT_LE(longest, 0.36 * stock.height) << habit;
        for (const TwigStock::Twig& twig : stock.twigs) {
            EXPECT_FALSE(twig.scion.check());
            EXPECT_LE(twig.scion.size(), 1000u);
        }
        const SketchSpecies species = species_of(stock, "oak");
        EXPECT_EQ(species.twigs.front().size, 0);
        EXPECT_EQ(species.twigs.back().size, 2);
    }
}

TEST(OwnTwigs, TheMadeTreeHasTheAnglesOfItsSource) {
    for (const double degrees : {28.0, 50.0, 80.0}) {
        const Tree source = tree_with_angle(degrees, 1.0);
        const TwigStock stock = stock_of_tree(source, "");
        EXPECT_NEAR(stock.angles[stock.angles.size() / 2], degrees, 2.0);
        const double shortest = scion_length(stock.twigs.front().scion);
        double mean = 0.0;
        for (uint64_t seed = 1; seed <= 6; seed++) {
            Sketch sketch = with_stock(seed, stock);
            sketch.height = stock.height;
            mean += usual_angle(sketch_tree(sketch, {}).tree, 0.7 * shortest) / 6.0;
        }
        EXPECT_NEAR(mean, degrees, 8.0);
    }
}

TEST(OwnTwigs, TheMadeTreeTapersAsItsSource) {
    for (const double stout : {0.6, 1.0, 1.8}) {
        const Tree source = tree_with_angle(50.0, stout);
        const TwigStock stock = stock_of_tree(source, "");
        ASSERT_TRUE(stock.taper);
        for (uint64_t seed = 1; seed <= 6; seed++) {
            Sketch sketch = with_stock(seed, stock);
            const SketchedTree made = sketch_tree(sketch, {});
            const double times = sketch.height / stock.height;
            EXPECT_NEAR(made.tree.node(made.tree.root()).radius, 0.1 * stout * times, 1e-9);
            const BranchStatistics statistics(made.tree);
            // Half-way up it is as thin as there.
            EXPECT_NEAR(statistics.profile(0)[5], stock.taper->trunk[5], 0.12) << seed;
            const WoodTaper taper = stock.taper->at_height(sketch.height);
            double off = 0.0, count = 0.0;
            for (size_t i = 0; i < statistics.list().branches.size(); i++) {
                const Branch& branch = statistics.list().branches[i];
                const std::span<const NodeId> nodes = statistics.list().nodes_of(branch);
                if (branch.order != 1 || made.stroke_of_node[static_cast<size_t>(nodes[0])] < 0) continue;
                // The branch's own wood: a twig may be what goes on from it.
                const int32_t stroke = made.stroke_of_node[static_cast<size_t>(nodes[0])];
                double length = 0.0;
                for (const NodeId id : made.tree.depth_first())
                    if (made.stroke_of_node[static_cast<size_t>(id)] == stroke)
                        length += glm::distance(made.tree.node(id).position,
                                                made.tree.node(made.tree.node(id).parent).position);
                const double law = taper.branches.base_radius(length);
                const double there = made.tree.node(branch.attach).radius;
                off += statistics.base_radius(static_cast<int32_t>(i)) / std::min(law, 0.75 * there);
                count += 1.0;
            }
            ASSERT_GT(count, 0.0);
            EXPECT_NEAR(off / count, 1.0, 0.15) << seed;
        }
        // A radius that was told stays.
        SketchOptions options;
        options.trunk_radius = 0.2;
        const SketchedTree made = sketch_tree(with_stock(1, stock), options);
        EXPECT_NEAR(made.tree.node(made.tree.root()).radius, 0.2, 1e-9);
    }
}

TEST(OwnTwigs, TaperScalesWithTheTree) {
    const TwigStock stock = stock_of_tree(tree_with_angle(50.0, 1.0), "");
    const WoodTaper twice = stock.taper->at_height(2.0 * stock.height);
    EXPECT_NEAR(twice.stem_base, 2.0 * stock.taper->stem_base, 1e-12);
    for (const double length : {0.5, 1.0, 3.0})
        EXPECT_NEAR(twice.branches.base_radius(2.0 * length), 2.0 * stock.taper->branches.base_radius(length),
                    1e-9);
}

TEST(OwnTwigs, ThoseOfOneSizeAreAllUsed) {
    const TwigStock stock = some_library();
    const SketchSpecies species = species_of(stock, "oak");
    std::vector<int> used(species.twigs.size(), 0);
    for (uint64_t pick = 0; pick < 60; pick++)
        for (double room = 0.1; room < 4.0; room *= 1.05) {
            const auto chosen = choose_twig(species, room, 0.001, 1.0, true, pick);
            if (!chosen) continue;
            used[chosen->twig]++;
            EXPECT_GE(chosen->scale, 0.7 - 1e-12);
            EXPECT_LE(chosen->scale, 1.3 + 1e-12);
        }
    for (const int count : used)
        EXPECT_GT(count, 0);
}

TEST(OwnTwigs, AreSavedWithTheSketch) {
    for (const bool of_tree : {false, true}) {
        Sketch sketch =
            with_stock(2, of_tree ? stock_of_tree(grown("broadleaf", 2), "My oak") : some_library());
        sketch.number_strokes();
        sketch.species = "oak";
        SketchOptions options;
        options.depth = SketchDepth::kPaper;
        options.crown = SketchCrown::kAlpha;
        options.trunk_radius = 0.125;
        options.density = 1.5;
        const std::string text = sketch_json(sketch, options);
        SketchOptions told;
        const Sketch read = parse_sketch_json(text, "It", &told);
        EXPECT_EQ(told.depth, options.depth);
        EXPECT_EQ(told.crown, options.crown);
        EXPECT_EQ(told.trunk_radius, 0.125);
        EXPECT_EQ(told.density, 1.5);
        ASSERT_TRUE(read.twigs);
        EXPECT_EQ(twig_stock_json(*read.twigs), twig_stock_json(*sketch.twigs));
        EXPECT_EQ(sketch_json(read, told), text);
        // The trunk's radius at its base had another name.
        std::string old = text;
        if (const size_t at = old.find("\"base\""); at != std::string::npos) old.replace(at, 6, "\"foot\"");
        EXPECT_EQ(old != text, of_tree);
        EXPECT_EQ(twig_stock_json(*parse_sketch_json(old, "It", &told).twigs), twig_stock_json(*read.twigs));
        const SketchedTree a = sketch_tree(sketch, {}), b = sketch_tree(read, {});
        ASSERT_EQ(a.tree.size(), b.tree.size());
        for (const NodeId id : a.tree.depth_first())
            ASSERT_EQ(a.tree.node(id).position, b.tree.node(id).position);
        EXPECT_EQ(a.species, "oak");
        // Another seed keeps the twigs, and gives another tree.
        sketch.seed++;
        EXPECT_NE(sketch_tree(sketch, {}).tree.bounds().max, a.tree.bounds().max);
    }
}

TEST(OwnTwigs, AnOldFileLoadsAsBefore) {
    const std::string old =
        R"j({"format": "treerec sketch", "version": 1, "strokes": [{"points": [[0, 0], [1, 1]]}]})j";
    SketchOptions options;
    const Sketch sketch = parse_sketch_json(old, "It", &options);
    EXPECT_FALSE(sketch.twigs);
    EXPECT_EQ(options.density, 1.0);
    EXPECT_EQ(options.depth, SketchDepth::kTrue);
    EXPECT_EQ(sketch_json(sketch).find("density"), std::string::npos);
}

TEST(OwnTwigs, NonsenseGetsASentence) {
    const auto library = [](std::vector<std::string> strings) {
        return sentence_of([&] { stock_of_twigs(strings, ""); });
    };
    EXPECT_NE(library({}).find("has no twigs"), std::string::npos);
    EXPECT_NE(library({"F(1)", "F(1"}).find("Twig 2 of the library is no branch"), std::string::npos);
    EXPECT_NE(library({"!(0.01)"}).find("Twig 1"), std::string::npos);
    EXPECT_NE(library({"!(0.01)F(100)"}).find("100 m long"), std::string::npos);
    EXPECT_NE(library({"!(0.00001)F(0.001)"}).find("0.001 m long"), std::string::npos);
    EXPECT_NE(library({"!(1)F(1)"}).find("too thick"), std::string::npos);
    EXPECT_NE(library(std::vector<std::string>(201, "F(1)")).find("201 twigs"), std::string::npos);
    EXPECT_NE(sentence_of([] { stock_of_tree(Tree(), ""); }).find("no tree"), std::string::npos);
    const Tree pole = read_lstring("!(.1)F(3)F(3)");
    EXPECT_NE(sentence_of([&] { stock_of_tree(pole, ""); }).find("no side branches"), std::string::npos);
    EXPECT_FALSE(sentence_of([] {
                     sketch_tree(with_stock(1, some_library()), {});
                     Sketch sketch = with_stock(1, some_library());
                     sketch.species = "baobab";
                     sketch_tree(sketch, {});
                 }).empty());
    const auto stock = [](const std::string& json) { return sentence_of([&] { parse_twig_stock(json); }); };
    EXPECT_EQ(stock(R"j({"twigs": ["!(.01)F(1)"]})j"), "");
    for (const char* bad :
         {"", "[]", "{}", R"j({"twigs": 3})j", R"j({"twigs": []})j", R"j({"twigs": [3]})j",
          R"j({"twigs": ["!(.01)F(1)"], "angles": [50, 40]})j",
          R"j({"twigs": ["!(.01)F(1)"], "angles": [500]})j",
          R"j({"twigs": ["!(.01)F(1)"], "arrangement": "heap"})j",
          R"j({"twigs": ["!(.01)F(1)"], "height": -1})j", R"j({"twigs": ["!(.01)F(1)"], "taper": {}})j",
          R"j({"twigs": ["!(.01)F(1)"], "title": 7})j"})
        EXPECT_FALSE(stock(bad).empty()) << bad;
    const std::string head = R"j({"format": "treerec sketch", "version": 1, "strokes": [], )j";
    for (const char* bad : {R"j("density": 9})j", R"j("density": "a"})j", R"j("trunk_radius": -1})j",
                            R"j("depth": "deep"})j", R"j("crown": 3})j", R"j("twigs": []})j"})
        EXPECT_FALSE(sentence_of([&] { parse_sketch_json(head + bad); }).empty()) << bad;
}

TEST(OwnTwigs, ALibraryOfGodotIsRead) {
    const std::string path = (std::filesystem::temp_directory_path() / "own_twigs_test.tres").string();
    write_file(path,
               "[gd_resource type=\"Resource\" script_class=\"TwigLibrary\" format=3]\n\n"
               "[sub_resource type=\"Resource\" id=\"a\"]\ntitle = \"One\nlstring = \\\"F(9)\\\"\n\"\n"
               "lstring = \"!(.01)F(1)[+(30)F(.5)]\nF(.5)\"\n\n"
               "[sub_resource type=\"Resource\" id=\"b\"]\nlstring = \"FF\"\ndialect = 1\n\n"
               "[resource]\ntwigs = [SubResource(\"a\"), SubResource(\"b\")]\n");
    const std::vector<std::string> strings = read_twig_strings(path);
    EXPECT_EQ(strings,
              (std::vector<std::string>{"!(.01)F(1)[+(30)F(.5)]\nF(.5)", "# L-string; dialect paper\nFF"}));
    write_file(path, "[gd_resource type=\"Resource\" format=3]\n\n[resource]\n");
    EXPECT_NE(sentence_of([&] { read_twig_strings(path); }).find("no twigs"), std::string::npos);
    write_file(path, "RSRC....");
    EXPECT_NE(sentence_of([&] { read_twig_strings(path); }).find("binary"), std::string::npos);
    write_file(path, "!(.01)F(1)");
    EXPECT_EQ(read_twig_strings(path).size(), 1u);
    std::filesystem::remove(path);
}

}  // namespace treerec
