// L-strings in files, and the commands 'lstring' and 'grow' of the program (which TREEREC_CLI names).
#include <gtest/gtest.h>

#include "cli_runner.h"
#include "error.h"
#include "exchange/lstring_file.h"
#include "exchange/tree_files.h"
#include "lsystem/grammar.h"
#include "random_tree.h"

namespace treerec {
namespace {

namespace fs = std::filesystem;

class LStringFiles : public test::InFolder {};
class LStringCli : public test::Cli {};

ScanFrame utm_frame() {
    ScanFrame frame;
    frame.origin = DVec3(500123.4567890123, 5432109.876543, 231.5);
    frame.metres_per_unit = 0.3048;
    frame.up = UpAxis::kZ;
    frame.tilt = DVec3(0.01, 0.02, -0.13);
    return frame;
}

// Places in the scan within 1e-5 of each segment's length, in order, with their flags.
void expect_same_in_scan(const Tree& a, const Tree& b) {
    const std::vector<NodeId> in_a = a.depth_first(), in_b = b.depth_first();
    ASSERT_EQ(in_a.size(), in_b.size());
    EXPECT_EQ(a.frame().up, b.frame().up);
    EXPECT_EQ(a.frame().metres_per_unit, b.frame().metres_per_unit);
    EXPECT_EQ(a.frame().tilt, b.frame().tilt);
    for (size_t i = 0; i < in_a.size(); i++) {
        const Node &x = a.node(in_a[i]), &y = b.node(in_b[i]);
        const double length =
            x.parent == kNoNode ? 0.0 : glm::distance(x.position, a.node(x.parent).position);
        const double off = glm::distance(a.frame().to_scan(x.position), b.frame().to_scan(y.position)) *
                           a.frame().metres_per_unit;
        // A double is that coarse at these coordinates.
        ASSERT_LE(off, 1e-5 * length + 5e-9);
        ASSERT_NEAR(x.radius, y.radius, 1e-4 * std::min(1.0, x.radius));
        ASSERT_EQ(x.flags, y.flags);
        ASSERT_EQ(x.child_count, y.child_count);
    }
}

TEST_F(LStringFiles, ComeBackInTheirOwnCoordinates) {
    for (uint64_t seed = 1; seed <= 20; seed++) {
        Tree tree = test::random_tree(seed, 400);
        tree.set_frame(utm_frame());
        tree.rebase({1.0, 2.0, 3.0});
        write_lstring_file(path("tree.lstring"), tree);
        EXPECT_TRUE(is_skeleton_file(path("tree.lstring")));
        const Tree back = read_skeleton(path("tree.lstring"));
        expect_same_in_scan(tree, back);
        EXPECT_EQ(back.node(back.root()).position, DVec3(0.0));
        LStringOptions paper;
        paper.dialect = LStringDialect::kPaper;
        write_lstring_file(path("paper.lstring"), tree, paper);
        const LStringTree read = read_lstring_file(path("paper.lstring"));
        ASSERT_EQ(read.tree.size(), tree.size());
    }
}

TEST_F(LStringFiles, HaveShortLinesAndReadTheSame) {
    const Tree tree = test::random_tree(3, 3000);
    const std::string string = write_lstring(tree, tree.root());
    const std::string text = lstring_file_text(string, {}, {});
    std::string_view rest = text;
    size_t longest = 0;
    for (size_t at = 0, end = 0; at < text.size(); at = end + 1) {
        end = text.find('\n', at);
        ASSERT_NE(end, std::string::npos);
        if (at > 0) longest = std::max(longest, end - at);
    }
    EXPECT_LT(longest, 140u);
    EXPECT_EQ(write_lstring(read_lstring(text), 0), write_lstring(read_lstring(string), 0));
    EXPECT_TRUE(
        rest.starts_with("# L-string; treerec 1 up y metres_per_unit 1 origin 0 0 0 dialect turtle\n"));
}

TEST_F(LStringFiles, CarryWhatTheirNumberlessSymbolsMean) {
    LStringOptions options;
    options.angle = 90.0;
    options.step = 2.0;
    options.radius = 0.5;
    options.thinning = 0.5;
    options.leaf_symbols = "L";
    options.tropism = {0, -1, 0};
    options.elasticity = 0.125;
    const std::string text = lstring_file_text("F!+FL~", {}, options);
    const LStringTree read = parse_lstring_file(text, "a file");
    const LStringTree wanted = read_lstring_with_leaves("F!+FL~", options);
    EXPECT_EQ(write_lstring(read.tree, 0), write_lstring(wanted.tree, 0));
    EXPECT_EQ(read.leaves.size(), 2u);
    EXPECT_EQ(read.leaves[0].kind, 'L');
}

TEST_F(LStringFiles, DamagedOnesAreRefused) {
    const auto sentence = [](const std::string& bytes) -> std::string {
        try {
            parse_lstring_file(bytes, "x.lstring");
        } catch (const Error& error) {
            return error.what();
        }
        return "no error";
    };
    EXPECT_EQ(
        sentence("F(1)\nF)"),
        "'x.lstring' holds no L-string that can be read: The L-string, line 2, column 2: ')' is no symbol "
        "of an L-string.");
    EXPECT_EQ(sentence("# L-string; treerec 2 up z metres_per_unit 1\nF"),
              "'x.lstring' was written by a newer version of this program; update to open it.");
    EXPECT_EQ(sentence("# L-string; treerec 1 up z\nF"), "'x.lstring', line 1, is damaged.");
    EXPECT_EQ(sentence("# L-string; treerec 1 up z metres_per_unit 1 origin 1 2\nF"),
              "'x.lstring', line 1: '' is no number.");
    EXPECT_EQ(sentence("# L-string; treerec 1 up z metres_per_unit 1 radius nan\nF"),
              "'x.lstring', line 1: 'nan' is no number.");
    EXPECT_EQ(sentence("# L-string; treerec 1 up z metres_per_unit 1 radius -1\nF"),
              "'x.lstring' holds no L-string that can be read: An L-string's radius must be positive.");
}

TEST_F(LStringCli, ATreeFileGoesThroughLstringAndGrow) {
    Tree tree = test::random_tree(5, 700);
    tree.set_frame(utm_frame());
    write_treefile(path("a.txt"), tree);
    ASSERT_EQ(run("lstring a.txt -o a.lstring").code, 0) << get("stderr.log");
    ASSERT_EQ(run("grow a.lstring -o b.txt -o b.glb -o b.lstring").code, 0) << get("stderr.log");
    expect_same_in_scan(read_treefile(path("a.txt")), read_treefile(path("b.txt")));
    EXPECT_GT(fs::file_size(path("b.glb")), 10000u);
    ASSERT_EQ(run("info b.lstring").code, 0) << get("stderr.log");
    EXPECT_NE(get("stdout.log").find("700"), std::string::npos);
    // On the terminal, and of a branch alone.
    ASSERT_EQ(run("lstring a.txt --node 300 --no-flags").code, 0) << get("stderr.log");
    const std::string branch = get("stdout.log");
    EXPECT_TRUE(branch.starts_with("!(")) << branch;
    EXPECT_EQ(branch.find('@'), std::string::npos);
    // The node, all above it, and the joint below it.
    EXPECT_EQ(read_lstring(branch).size(), read_treefile(path("a.txt")).depth_first(300).size() + 1);
}

TEST_F(LStringCli, GrammarsGrow) {
    put("a.lsys",
        "iterations: 3\nangle: 30\nstep: 0.5\nradius: 0.05\naxiom: X\nX -> F[+X]F[-X]~ : 0.5\nX -> FX : "
        "0.5\nF -> FF\n");
    ASSERT_EQ(run("grow a.lsys --seed 4 -o a.txt -o a.lstring -o a.glb").code, 0) << get("stderr.log");
    ASSERT_EQ(run("grow a.lsys --seed 4 -o b.txt").code, 0) << get("stderr.log");
    ASSERT_EQ(run("grow a.lsys --seed 5 -o c.txt").code, 0) << get("stderr.log");
    ASSERT_EQ(run("grow a.lstring -o d.txt").code, 0) << get("stderr.log");
    EXPECT_EQ(get("a.txt"), get("b.txt"));
    EXPECT_NE(get("a.txt"), get("c.txt"));
    EXPECT_EQ(get("a.txt"), get("d.txt"));
    // In few steps: a slow machine must come to that limit before it comes to the one of seconds.
    put("many.lsys", "iterations: 3\naxiom: F\nF -> " + std::string(300, 'F') + "\n");
    EXPECT_EQ(run("grow many.lsys --iterations 40 -o e.txt").code, 1);
    EXPECT_NE(get("stderr.log").find("grows past 5000000 symbols"), std::string::npos) << get("stderr.log");
    for (const std::string& name : grammar_preset_names())
        EXPECT_EQ(run("grow " + name + " -o " + name + ".ply --quiet").code, 0) << get("stderr.log");
}

TEST_F(LStringCli, WhatDrawsNothingIsRefused) {
    put("empty.lstring", "+(3) A # F\n");
    put("flat.lstring", "F(0)[+F(0)]F(0)");
    put("empty.lsys", "iterations: 3\naxiom: F(1)\nF(x) -> *\n");
    for (const char* name : {"empty.lstring", "flat.lstring", "empty.lsys"}) {
        EXPECT_EQ(run(std::string("grow ") + name + " -o x.glb -o x.lstring").code, 1) << name;
        EXPECT_NE(get("stderr.log").find(name), std::string::npos) << get("stderr.log");
        EXPECT_NE(get("stderr.log").find("draws no wood"), std::string::npos) << get("stderr.log");
        EXPECT_FALSE(fs::exists(path("x.glb")) || fs::exists(path("x.lstring"))) << name;
    }
}

TEST_F(LStringCli, TheDialectIsTheFilesOrAsToldAndNeverGuessed) {
    const Tree tree = test::random_tree(5, 200);
    LStringOptions paper;
    paper.dialect = LStringDialect::kPaper;
    const std::string string = write_lstring(tree, tree.root(), paper);
    put("bare.lstring", string);
    put("headed.lstring", heading(paper) + string);
    put("thesis.lstring", "[+45&60F(0.5)[-30&80F(0.2)]]");
    ASSERT_EQ(run("grow bare.lstring --dialect paper -o a.csv").code, 0) << get("stderr.log");
    ASSERT_EQ(run("grow headed.lstring -o b.csv").code, 0) << get("stderr.log");
    ASSERT_EQ(run("grow headed.lstring --dialect turtle -o c.csv").code, 0) << get("stderr.log");
    EXPECT_EQ(get("a.csv"), get("b.csv"));
    EXPECT_NE(get("a.csv"), get("c.csv"));
    EXPECT_EQ(run("grow thesis.lstring -o d.csv").code, 1);
    EXPECT_NE(get("stderr.log").find("dialect paper"), std::string::npos) << get("stderr.log");
    EXPECT_EQ(run("grow thesis.lstring --dialect paper -o d.csv").code, 0) << get("stderr.log");
    // What the terminal shows reads as a file does.
    ASSERT_EQ(run("lstring b.csv --up y --dialect paper").code, 0) << get("stderr.log");
    EXPECT_TRUE(get("stdout.log").starts_with("# L-string; dialect paper\n"));
    // The command line goes before the heading.
    put("angle.lstring", "# L-string; angle 90\nF+F");
    put("plain.lstring", "F+F");
    ASSERT_EQ(run("grow angle.lstring --angle 30 -o e.csv").code, 0);
    ASSERT_EQ(run("grow plain.lstring --angle 30 -o f.csv").code, 0);
    EXPECT_EQ(get("e.csv"), get("f.csv"));
}

// Without a heading: told by its ending, and by what is in it.
TEST_F(LStringCli, EveryCommandReadsAStringWithoutAHeading) {
    for (const std::string text : {"F(1)[+(30)F(.5)]F(1)\n", "\n# ours\n  F(1)\n[+(30)F(.5)] X F(1)"})
        for (const std::string name : {"bare.lstring", "bare.txt"}) {
            put(name, text);
            ASSERT_EQ(run("info " + name).code, 0) << get("stderr.log");
            EXPECT_NE(get("stdout.log").find("a skeleton"), std::string::npos) << get("stdout.log");
            EXPECT_NE(get("stdout.log").find("nodes          4"), std::string::npos) << get("stdout.log");
            ASSERT_EQ(run("edit " + name + " -c 'prune_below node=1' -o out.csv").code, 0)
                << get("stderr.log");
            EXPECT_EQ(read_skeleton(path("out.csv")).size(), 2u);
            EXPECT_EQ(run("lstring " + name).code, 0) << get("stderr.log");
            EXPECT_EQ(run("reconstruct " + name + " -o out.glb").code, 1);
            EXPECT_NE(get("stderr.log").find("is a skeleton"), std::string::npos) << get("stderr.log");
        }
    // By its ending alone: letters of a grammar, which a turtle skips.
    put("letters.lstring", "AF(1)[+(30)BF(.5)]F(1)\n");
    EXPECT_EQ(run("info letters.lstring").code, 0) << get("stderr.log");
    // What is no string is told as such, and tables stay tables.
    put("points.lstring", "1 2 3\n4 5 6\n");
    EXPECT_EQ(run("info points.lstring").code, 1);
    EXPECT_NE(get("stderr.log").find("L-string"), std::string::npos) << get("stderr.log");
    put("grammar.lstring", "axiom: F\nF -> FF\n");
    EXPECT_EQ(run("info grammar.lstring").code, 1);
    EXPECT_NE(get("stderr.log").find("treerec grow"), std::string::npos) << get("stderr.log");
    for (const char* table : {"1 2 3\n-4 5e0 6\n", "x y z\n1 2 3\n", "FID,x,y,z\n1,2,3,4\n", ""}) {
        put("points.txt", table);
        EXPECT_FALSE(is_skeleton_file(path("points.txt"))) << table;
    }
}

TEST_F(LStringCli, EveryCommandTakesTheDialectOfAString) {
    put("paper.lstring", "[+(45)&(60)F(0.5)[-(30)&(80)F(0.2)]]");
    put("headed.lstring", "# L-string; dialect paper\n[+(45)&(60)F(0.5)[-(30)&(80)F(0.2)]]");
    ASSERT_EQ(run("grow headed.lstring -o right.csv").code, 0) << get("stderr.log");
    for (const std::string command : {"edit paper.lstring -c 'smooth_paths rounds=0'",
                                      "lighten paper.lstring --angle 0 --distance 0 --deviation 0"}) {
        ASSERT_EQ(run(command + " --dialect paper -o told.csv").code, 0) << command << get("stderr.log");
        ASSERT_EQ(run(command + " -o misread.csv").code, 0) << command << get("stderr.log");
        EXPECT_EQ(get("told.csv"), get("right.csv")) << command;
        EXPECT_NE(get("misread.csv"), get("right.csv")) << command;
    }
    ASSERT_EQ(run("info paper.lstring --dialect paper --json").code, 0) << get("stderr.log");
    const std::string told = get("stdout.log");
    ASSERT_EQ(run("info headed.lstring --json").code, 0) << get("stderr.log");
    EXPECT_EQ(told.substr(told.find("height")), get("stdout.log").substr(get("stdout.log").find("height")));
    EXPECT_EQ(run("info paper.lstring --dialect latin").code, 2);
}

TEST_F(LStringCli, AGrammarHasItsBounds) {
    put("many.lsys", "iterations: 12\naxiom: F\nF -> FF\n");
    EXPECT_EQ(run("grow many.lsys --most-nodes 1000 -o a.csv").code, 1);
    EXPECT_NE(get("stderr.log").find("more than 1000 nodes"), std::string::npos) << get("stderr.log");
    EXPECT_EQ(run("grow many.lsys --most-nodes 5000 -o a.csv").code, 0) << get("stderr.log");
    put("long.lsys", "iterations: 10000\naxiom: F\nF -> FF : 0.01\nF -> F : 0.99\n");
    EXPECT_EQ(run("grow long.lsys --most-seconds 0.2 -o b.csv").code, 1);
    EXPECT_NE(get("stderr.log").find("takes longer than"), std::string::npos) << get("stderr.log");
}

TEST_F(LStringCli, WrongCommandLinesAreTold) {
    put("a.lstring", "F[");
    put("b.lstring", "F(1)[+F(1)]");
    for (const auto& [words, code] :
         std::vector<std::pair<std::string, int>>{{"grow", 2},
                                                  {"grow b.lstring", 2},
                                                  {"grow b.lstring -o x.xyz", 2},
                                                  {"grow b.lstring -o x.txt --iterations 3", 2},
                                                  {"grow b.lstring -o x.txt --dialect french", 2},
                                                  {"grow b.lstring -o x.txt --leaves lettuce", 2},
                                                  {"grow a.lstring -o x.txt", 1},
                                                  {"grow nothing.lstring -o x.txt", 1},
                                                  {"lstring", 2},
                                                  {"lstring nothing.txt -o x.lstring", 1},
                                                  {"lstring b.lstring --accuracy 5 -o x.lstring", 2}}) {
        EXPECT_EQ(run(words).code, code) << words;
        EXPECT_GT(get("stderr.log").size(), 20u) << words;
        EXPECT_FALSE(fs::exists(path("x.txt")) || fs::exists(path("x.lstring"))) << words;
    }
}

}  // namespace
}  // namespace treerec
