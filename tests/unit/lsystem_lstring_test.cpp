// Trees as L-strings and back.
#include "lsystem/lstring.h"

#include <gtest/gtest.h>

#include <functional>

#include "error.h"
#include "random_tree.h"
#include "tree/branches.h"

namespace treerec {
namespace {

std::string sentence_of(const std::function<void()>& call) {
    try {
        call();
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

std::string sentence_of(const std::string& text, const LStringOptions& options = {}) {
    return sentence_of([&] { read_lstring(text, options); });
}

// How far the nodes of `read` lie from those of `tree` above `from`, against the length of the branch and
// of the segment itself, whichever is shorter.
void expect_same(const Tree& tree, NodeId from, const Tree& read, double accuracy, double radius_accuracy,
                 bool flags) {
    ASSERT_EQ(read.check(), std::nullopt);
    const std::vector<NodeId> order = tree.depth_first(from);
    ASSERT_EQ(read.size(), order.size());
    for (size_t i = 0; i < order.size(); i++) {
        const Node& node = tree.node(order[i]);
        const NodeId id = static_cast<NodeId>(i);
        const Node& back = read.node(id);
        const double length = i == 0 ? 0.0 : glm::distance(node.position, tree.node(node.parent).position);
        ASSERT_LE(glm::distance(back.position, node.position - tree.node(from).position),
                  accuracy * length + 1e-11)
            << "node " << order[i] << " at the end of " << length << " m";
        if (radius_accuracy > 0.0) {
            ASSERT_LE(std::abs(back.radius - node.radius), radius_accuracy * std::min(1.0, node.radius));
        }
        if (flags) {
            ASSERT_EQ(back.flags, node.flags) << "node " << order[i];
        }
        ASSERT_EQ(back.child_count, node.child_count);
        if (i > 0) {
            ASSERT_EQ(order[back.parent], node.parent) << "node " << order[i];
        }
    }
}

void expect_round_trip(const Tree& tree, NodeId from, LStringOptions options = {}) {
    const std::string text = write_lstring(tree, from, options);
    const bool turtle = options.dialect == LStringDialect::kTurtle;
    expect_same(tree, from, read_lstring(text, options), options.accuracy,
                turtle ? options.radius_accuracy : 0.0, turtle && options.flags);
}

// Every flag at random, for all but the root's guess.
void shuffle_flags(Tree& tree, Random& random) {
    for (const NodeId id : tree.depth_first())
        for (const NodeFlag flag : {kTrunkFlag, kMeasuredRadiusFlag, kGuessFlag})
            tree.set_flag(id, flag, random.below(2) == 0);
}

// Trees that break turtles: straight down, collinear, hairpins, right angles, many branches at one node.
Tree degenerate_tree(uint64_t seed) {
    Random random(seed);
    const DVec3 axes[] = {{0, -1, 0}, {0, 1, 0}, {1, 0, 0}, {0, 0, -1}, {0, 0, 1}, {-1, 0, 0}};
    Tree tree;
    std::vector<NodeId> ids{tree.add_root({random.uniform(-1e3, 1e3), 0.0, random.uniform(-1e3, 1e3)},
                                          random.uniform(1e-4, 3.0))};
    const uint32_t nodes = random.below(40);
    for (uint32_t i = 0; i < nodes; i++) {
        const NodeId parent =
            random.below(3) ? ids.back() : ids[random.below(static_cast<uint32_t>(ids.size()))];
        const DVec3 axis = axes[seed % 3 == 0 ? 0 : random.below(6)];
        const DVec3 off =
            random.below(4) ? DVec3(0.0) : std::pow(10.0, random.uniform(-12, -3)) * random.direction();
        const double length =
            random.below(6) ? random.uniform(0.1, 2.0) : std::pow(10.0, random.uniform(-9, 4));
        ids.push_back(tree.add_child(parent, tree.node(parent).position + length * (axis + off),
                                     std::pow(10.0, random.uniform(-4.0, 0.5))));
    }
    shuffle_flags(tree, random);
    return tree;
}

TEST(LString, TreesComeBackFromTheirStrings) {
    for (uint64_t seed = 1; seed <= 1500; seed++) {
        Random random(seed);
        Tree tree = test::random_tree(seed, 1 + static_cast<int>(random.below(300)));
        expect_round_trip(tree, tree.root());
        expect_round_trip(tree, tree.depth_first()[random.below(static_cast<uint32_t>(tree.size()))]);
        if (HasFatalFailure()) FAIL() << "seed " << seed;
    }
}

TEST(LString, WildTreesComeBackFromTheirStrings) {
    for (uint64_t seed = 1; seed <= 3000; seed++) {
        Random random(seed);
        Tree tree = test::wild_tree(seed, 1 + static_cast<int>(random.below(60)));
        shuffle_flags(tree, random);
        expect_round_trip(tree, tree.root());
        const Tree odd = degenerate_tree(seed);
        expect_round_trip(odd, odd.root());
        if (HasFatalFailure()) FAIL() << "seed " << seed;
    }
}

TEST(LString, EveryAccuracyIsKept) {
    for (const double accuracy : {1e-2, 1e-3, 1e-7, 1e-10}) {
        for (uint64_t seed = 1; seed <= 100; seed++) {
            const Tree tree = test::random_tree(seed, 200);
            LStringOptions options;
            options.accuracy = accuracy;
            options.radius_accuracy = accuracy;
            expect_round_trip(tree, tree.root(), options);
        }
    }
}

TEST(LString, ThePapersDialectComesBackToo) {
    LStringOptions options;
    options.dialect = LStringDialect::kPaper;
    for (uint64_t seed = 1; seed <= 500; seed++) {
        const Tree tree = test::random_tree(seed, 100);
        expect_round_trip(tree, tree.root(), options);
        const Tree odd = degenerate_tree(seed);
        expect_round_trip(odd, odd.root(), options);
        if (HasFatalFailure()) FAIL() << "seed " << seed;
    }
}

TEST(LString, DeepTreesDoNotOverflowTheStack) {
    for (const bool forked : {false, true}) {
        std::vector<NodeId> parents{kNoNode};
        std::vector<DVec3> positions{DVec3(0.0)};
        Random random(5);
        NodeId tip = 0;
        for (int i = 1; i < 300000; i++) {
            parents.push_back(tip);
            positions.push_back(positions[tip] + 0.01 * random.direction());
            // Where it forks, the second child goes on, so that brackets lie in brackets.
            if (!forked || i % 2 == 0) tip = static_cast<NodeId>(i);
        }
        const std::vector<double> radii(parents.size(), 0.01);
        const Tree tree =
            Tree::from_arrays(parents, positions, radii, std::vector<uint8_t>(parents.size(), 0));
        expect_round_trip(tree, tree.root());
        LStringOptions paper;
        paper.dialect = LStringDialect::kPaper;
        expect_round_trip(tree, tree.root(), paper);
    }
}

TEST(LString, NumbersAreAsShortAsTheAccuracyAllows) {
    Tree tree;
    const NodeId root = tree.add_root({5.0, 1.0, 2.0}, 0.125);
    const NodeId fork = tree.add_child(root, {5.0, 3.0, 2.0}, 0.1);
    tree.add_child(fork, {5.0, 4.5, 2.0}, 0.05);
    const NodeId side = tree.add_child(fork, {4.0, 4.0, 2.0}, 0.03);
    tree.add_child(side, {4.0, 4.0, 2.5}, 0.03);
    EXPECT_EQ(write_lstring(tree, root),
              "!(0.125)!(0.1)F(2)[+(45)!(0.03)F(1.41421)^(90)F(0.5)]!(0.05)F(1.5)");
    EXPECT_EQ(write_lstring(tree, side), "!(0.03)^(90)F(0.5)");
    // A straight stem stays free of corrections.
    Tree stem;
    NodeId at = stem.add_root(DVec3(0.0), 0.1);
    for (int i = 1; i <= 100; i++)
        at = stem.add_child(at, DVec3(0.0, i / 3.0, 0.0), 0.1);
    EXPECT_EQ(write_lstring(stem, stem.root()).find_first_of("+-&^/\\|"), std::string::npos);
}

TEST(LString, StraightDownIsATurnAround) {
    Tree tree;
    const NodeId root = tree.add_root(DVec3(0.0), 0.1);
    tree.add_child(root, {0.0, -2.0, 0.0}, 0.1);
    EXPECT_EQ(write_lstring(tree, root), "!(0.1)|F(2)");
}

TEST(LString, OneNode) {
    Tree tree;
    tree.add_root({1.0, 2.0, 3.0}, 0.25, kTrunkFlag | kMeasuredRadiusFlag);
    EXPECT_EQ(write_lstring(tree, tree.root()), "!(0.25)@(3)");
    const Tree back = read_lstring("!(0.25)@(3)");
    ASSERT_EQ(back.size(), 1u);
    EXPECT_EQ(back.node(0).radius, 0.25);
    EXPECT_EQ(back.node(0).flags, kTrunkFlag | kMeasuredRadiusFlag);
    EXPECT_EQ(read_lstring("").size(), 1u);
}

void expect_at(const Tree& tree, NodeId id, const DVec3& place) {
    EXPECT_LT(glm::distance(tree.node(id).position, place), 1e-12)
        << id << ": " << tree.node(id).position.x << " " << tree.node(id).position.y << " "
        << tree.node(id).position.z;
}

TEST(LString, SymbolsTurnAsInAbop) {
    // H is up, U points at the viewer, so L is the viewer's left: -X.
    expect_at(read_lstring("+(90)F(1)"), 1, {-1, 0, 0});
    expect_at(read_lstring("-(90)F(1)"), 1, {1, 0, 0});
    expect_at(read_lstring("&(90)F(1)"), 1, {0, 0, -1});
    expect_at(read_lstring("^(90)F(1)"), 1, {0, 0, 1});
    // Rolled left, up leans to the left; rolled right, to the right.
    expect_at(read_lstring("\\(90)^(90)F(1)"), 1, {-1, 0, 0});
    expect_at(read_lstring("/(90)^(90)F(1)"), 1, {1, 0, 0});
    expect_at(read_lstring("|F(1)"), 1, {0, -1, 0});
    expect_at(read_lstring("+(90)|F(1)"), 1, {1, 0, 0});
    // After | left is the other side, up stays.
    expect_at(read_lstring("|+(90)F(1)"), 1, {1, 0, 0});
    expect_at(read_lstring("|^(90)F(1)"), 1, {0, 0, 1});
    // $: left becomes level and up looks to the sky, whatever the roll was.
    expect_at(read_lstring("^(90)\\(37)$+(90)F(1)"), 1, {1, 0, 0});
    expect_at(read_lstring("^(90)\\(37)$^(90)F(1)"), 1, {0, 1, 0});
    LStringOptions sideways;
    sideways.skyward = {1, 0, 0};
    expect_at(read_lstring("$+(90)F(1)", sideways), 1, {0, 0, 1});
}

TEST(LString, SymbolsWithoutNumbersTakeTheOptions) {
    LStringOptions options;
    options.angle = 90.0;
    options.step = 2.0;
    options.radius = 0.5;
    options.thinning = 0.5;
    const Tree tree = read_lstring("F [ + F(1) ] ! F # the end\n", options);
    ASSERT_EQ(tree.size(), 4u);
    expect_at(tree, 1, {0, 2, 0});
    expect_at(tree, 2, {0, 4, 0});  // what goes on comes first
    expect_at(tree, 3, {-1, 2, 0});
    EXPECT_EQ(tree.node(0).radius, 0.5);
    EXPECT_EQ(tree.node(2).radius, 0.25);
    EXPECT_EQ(tree.node(3).radius, 0.5);
}

TEST(LString, BranchesComeAfterWhatGoesOn) {
    const Tree tree = read_lstring("[F(1)][F(2)]F(3)[[F(4)]F(5)]F(6)");
    std::vector<double> heights;
    for (const NodeId id : tree.depth_first())
        heights.push_back(tree.node(id).position.y);
    // What goes on inside the second bracket is still a branch, after the first.
    EXPECT_EQ(heights, (std::vector<double>{0, 3, 9, 7, 8, 1, 2}));
}

TEST(LString, AGapIsAGuess) {
    const Tree tree = read_lstring("F(1)f(2)F(3)");
    ASSERT_EQ(tree.size(), 4u);
    EXPECT_FALSE(tree.node(1).is_guess());
    EXPECT_TRUE(tree.node(2).is_guess());
    EXPECT_FALSE(tree.node(3).is_guess());
    LStringOptions plain;
    plain.flags = false;
    EXPECT_EQ(write_lstring(tree, 0, plain), "!(0.01)F(1)F(2)F(3)");
}

TEST(LString, LeavesAreReported) {
    LStringOptions options;
    options.leaf_symbols = "L";
    const LStringTree read = read_lstring_with_leaves("F(1)[+(90)~(0.1)][~k(0.2)]F(1)L~F(1)J(3)", options);
    ASSERT_EQ(read.tree.size(), 4u);
    ASSERT_EQ(read.leaves.size(), 4u);
    EXPECT_EQ(read.leaves[0].node, 1);
    EXPECT_EQ(read.leaves[0].size, 0.1);
    EXPECT_LT(glm::distance(read.leaves[0].heading, DVec3(-1, 0, 0)), 1e-12);
    EXPECT_EQ(read.leaves[1].kind, 'k');
    EXPECT_EQ(read.leaves[1].size, 0.2);
    EXPECT_EQ(read.leaves[2].kind, 'L');
    EXPECT_EQ(read.leaves[2].position.y, 2.0);
    EXPECT_EQ(read.leaves[3].kind, 0);
}

TEST(LString, AnOutlineIsALeaf) {
    // ABOP, figure 1.26: a leaf of six edges.
    LStringOptions options;
    options.angle = 22.5;
    options.step = 0.1;
    const LStringTree read = read_lstring_with_leaves("F(1)[{-f+f+f-|-f+f+f}]F(1)", options);
    EXPECT_EQ(read.tree.size(), 3u);
    ASSERT_EQ(read.leaves.size(), 1u);
    EXPECT_EQ(read.leaves[0].kind, '{');
    EXPECT_EQ(read.leaves[0].node, 1);
    // Its tip: three steps at -22.5, 0 and 22.5 degrees.
    EXPECT_NEAR(read.leaves[0].size, 0.1 * (1.0 + 2.0 * std::cos(kPi / 8)), 1e-12);
}

TEST(LString, ACutEndsItsBranch) {
    EXPECT_EQ(read_lstring("F[F%F[F]F]F").size(), 4u);
    EXPECT_EQ(read_lstring("FF%F[F]F").size(), 3u);
}

TEST(LString, TropismBends) {
    LStringOptions options;
    options.tropism = {0, -1, 0};
    options.elasticity = 0.2;
    const Tree tree = read_lstring("-(90)F(1)F(1)", options);
    // By e * |H x T| = 0.2 radians after the first.
    expect_at(tree, 2, {1.0 + std::cos(0.2), -std::sin(0.2), 0.0});
}

TEST(LString, ThePapersAnglesAreAbsolute) {
    LStringOptions options;
    options.dialect = LStringDialect::kPaper;
    options.radius = 0.5;
    const Tree tree = read_lstring("[&(90)F(2)[+(90)&(0)F(1)F][-90^30F(1)]]", options);
    ASSERT_EQ(tree.size(), 5u);
    expect_at(tree, 1, {0, 2, 0});
    expect_at(tree, 2, {0, 2, 1});
    expect_at(tree, 3, {0, 2, 2});  // F alone goes as far as the last one
    expect_at(tree, 4, {0, 1.5, -std::sqrt(0.75)});
    EXPECT_NEAR(tree.node(1).radius, 0.4, 1e-12);
    EXPECT_NEAR(tree.node(3).radius, 0.5 * 0.8 * 0.8 * 0.8, 1e-12);
    EXPECT_EQ(sentence_of("F(1)~", options),
              "The L-string, line 1, column 5: '~' is no symbol of the paper's L-strings.");
    EXPECT_EQ(parse_lstring_dialect("paper"), LStringDialect::kPaper);
    EXPECT_EQ(sentence_of([] { parse_lstring_dialect("french"); }),
              "There is no dialect 'french' of L-strings; there are turtle and paper.");
}

TEST(LString, VariationIsSeededAndBounded) {
    for (const LStringDialect dialect : {LStringDialect::kTurtle, LStringDialect::kPaper}) {
        LStringOptions options;
        options.dialect = dialect;
        const std::string text = write_lstring(test::random_tree(3, 200), 0, options);
        const Tree plain = read_lstring(text, options);
        options.angle_spread = 8.0;
        options.length_spread = 0.2;
        options.seed = 7;
        const Tree one = read_lstring(text, options);
        EXPECT_EQ(write_lstring(one, 0), write_lstring(read_lstring(text, options), 0));
        options.seed = 8;
        EXPECT_NE(write_lstring(one, 0), write_lstring(read_lstring(text, options), 0));
        ASSERT_EQ(one.size(), plain.size());
        double longest = 0.0;
        for (NodeId id = 1; id < one.id_end(); id++) {
            const auto length = [&](const Tree& tree) {
                return glm::distance(tree.node(id).position, tree.node(tree.node(id).parent).position);
            };
            EXPECT_LE(std::abs(length(one) / length(plain) - 1.0), 0.2 + 1e-9);
            longest = std::max(longest, std::abs(length(one) / length(plain) - 1.0));
        }
        EXPECT_GT(longest, 0.15);
    }
}

TEST(LString, ErrorsNameThePlace) {
    EXPECT_EQ(sentence_of("F(1)\n  F(x)"), "The L-string, line 2, column 5: here a number should stand.");
    EXPECT_EQ(sentence_of("F(1)]"), "The L-string, line 1, column 5: this ] closes no [.");
    EXPECT_EQ(sentence_of("F[F\n[F]"), "The L-string, line 1, column 2: this [ is never closed.");
    EXPECT_EQ(sentence_of("F(1"), "The L-string, line 1, column 2: this ( is never closed.");
    EXPECT_EQ(sentence_of("F(1;2)"), "The L-string, line 1, column 4: here a ) or a comma should stand.");
    EXPECT_EQ(sentence_of("F*F"), "The L-string, line 1, column 2: '*' is no symbol of an L-string.");
    EXPECT_EQ(sentence_of("!(0)F"), "The L-string, line 1, column 1: a radius must be positive.");
    EXPECT_EQ(sentence_of("F}"), "The L-string, line 1, column 2: this } closes no {.");
    EXPECT_EQ(sentence_of("F{"), "The L-string, line 1, column 2: this { is never closed.");
    EXPECT_EQ(sentence_of("F(9e11)F(9e11)"),
              "The L-string, line 1, column 8: the turtle leaves all bounds here.");
    EXPECT_EQ(sentence_of("F(1e999)"), "The L-string, line 1, column 3: here a number should stand.");
    EXPECT_EQ(sentence_of("@(9)"), "The L-string, line 1, column 1: flags are a number from 0 to 7.");
    EXPECT_EQ(sentence_of(std::string((1 << 21) + 1, '[')),
              "The L-string, line 1, column 2097153: too many brackets lie in brackets.");
    LStringOptions few;
    few.most_nodes = 3;
    EXPECT_EQ(read_lstring("FF", few).size(), 3u);
    EXPECT_EQ(sentence_of("FFF", few), "The L-string, line 1, column 3: the tree gets more than 3 nodes.");
    EXPECT_EQ(sentence_of([] { write_lstring(test::random_tree(1, 5), 9999); }),
              "There is no node 9999 in this tree.");
}

TEST(LString, HearsACancel) {
    class Stop : public Progress {
      public:
        bool cancelled() const override { return true; }
    } stop;
    std::string text;
    for (int i = 0; i < 20000; i++)
        text += "F(1)";
    EXPECT_THROW(read_lstring(text, {}, &stop), Cancelled);
    EXPECT_THROW(write_lstring(test::random_tree(1, 20000), 0, {}, &stop), Cancelled);
}

LStringOptions paper_dialect() {
    LStringOptions options;
    options.dialect = LStringDialect::kPaper;
    return options;
}

TEST(LString, AHeadingSaysHowItIsRead) {
    for (uint64_t seed = 1; seed <= 200; seed++) {
        const Tree tree = test::random_tree(seed, 60);
        const std::string string = write_lstring(tree, tree.root(), paper_dialect());
        const std::string text = heading(paper_dialect()) + string;
        ASSERT_TRUE(has_heading(text));
        // Whoever reads it need not know.
        const Tree told = read_lstring(text), known = read_lstring(string, paper_dialect());
        ASSERT_EQ(write_lstring(told, 0), write_lstring(known, 0));
        expect_same(tree, tree.root(), told, 1e-5, 0.0, false);
        // Who insists gets what was asked for, and who says nothing a turtle's.
        LStringOptions turtle;
        turtle.dialect_is_told = true;
        ASSERT_EQ(write_lstring(read_lstring(text, turtle), 0), write_lstring(read_lstring(string), 0));
        ASSERT_NE(write_lstring(read_lstring(string), 0), write_lstring(known, 0));
    }
    LStringOptions options;
    options.angle = 90.0;
    options.step = 0.3;
    options.radius = 0.02;
    options.thinning = 0.5;
    options.leaf_symbols = "L";
    options.tropism = {0, -1, 0};
    options.elasticity = 0.25;
    const LStringOptions back = with_heading(heading(options) + "F", {});
    EXPECT_EQ(heading(back), heading(options));
    EXPECT_EQ(heading({}), "");
    const std::string text = heading(options) + "F+F!F";
    options.heeds_heading = false;
    EXPECT_EQ(write_lstring(read_lstring(text), 0), write_lstring(read_lstring(text, options), 0));
    EXPECT_EQ(sentence_of("# L-string; radius x\nF"), "The L-string, line 1: 'x' is no number.");
    EXPECT_EQ(sentence_of("# L-string; dialect french\nF"),
              "There is no dialect 'french' of L-strings; there are turtle and paper.");
}

// The paper's +45 would be a turn by the usual angle, and two symbols to skip.
TEST(LString, NumbersWithoutBracketsAreNotMisread) {
    for (const char* text : {"+45F(1)", "F(1)[-.5F(1)]", "& 30F", "^9F"})
        EXPECT_NE(sentence_of(text).find("dialect paper"), std::string::npos) << text;
    EXPECT_EQ(sentence_of("F(1)-45F"),
              "The L-string, line 1, column 5: a number without brackets, as the paper's dialect writes it. "
              "Read the string as dialect paper, or write -(45).");
    EXPECT_EQ(sentence_of("F1+(45)2F0"), "no error");
    LStringOptions turtle;
    turtle.dialect_is_told = true;
    EXPECT_EQ(sentence_of("+45F(1)", turtle), "no error");
    EXPECT_EQ(sentence_of("+45F(1)", paper_dialect()), "no error");
}

TEST(LString, WhatDrawsNothingIsTold) {
    const auto told = [](const std::string& text) {
        return sentence_of([&] { require_wood(read_lstring(text), "The L-string"); });
    };
    for (const char* text : {"", "+(3)", "AB", "{F(1)F(1)}", "%F(1)", "# F(1)"})
        EXPECT_EQ(
            told(text),
            "The L-string draws no wood: there is no F in it outside of leaves. F(0.5) draws half a metre.")
            << text;
    EXPECT_EQ(told("F(0)[F(0)]F(0)"), "The L-string draws no wood: every F in it has a length of 0.");
    EXPECT_EQ(told("F(0)F(0.001)"), "no error");
}

}  // namespace
}  // namespace treerec
