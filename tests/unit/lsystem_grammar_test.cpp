// Grammars: their language, their rewriting, and the published examples of The Algorithmic Beauty of Plants
// (ABOP). The lengths and hashes of those are made by another implementation: tests/tools/abop_strings.mjs.
#include "lsystem/grammar.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <functional>
#include <map>

#include "error.h"

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

std::string sentence_of(const std::string& text) {
    return sentence_of([&] { Grammar::parse(text); });
}

std::string rewritten(const std::string& text, int iterations = -1, uint64_t seed = 1) {
    RewriteOptions options;
    options.iterations = iterations;
    options.seed = seed;
    return rewrite(Grammar::parse(text), options);
}

// FNV-1a, as in abop_strings.mjs.
uint64_t hash_of(const std::string& text) {
    uint64_t hash = 0xcbf29ce484222325u;
    for (const char c : text)
        hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
    return hash;
}

// Every number with 6 significant digits.
std::string with_short_numbers(const std::string& text) {
    std::string out;
    for (size_t i = 0; i < text.size();) {
        out += text[i++];
        if (out.back() != '(' && out.back() != ',') continue;
        char* end = nullptr;
        char buffer[32];
        std::snprintf(buffer, sizeof buffer, "%.6g", std::strtod(text.c_str() + i, &end));
        i = static_cast<size_t>(end - text.c_str());
        const auto result = std::to_chars(buffer, buffer + sizeof buffer, std::strtod(buffer, nullptr));
        out.append(buffer, result.ptr);
    }
    return out;
}

void expect_string(const std::string& grammar, size_t length, uint64_t hash) {
    const std::string text = with_short_numbers(rewritten(grammar));
    EXPECT_EQ(text.size(), length) << grammar;
    EXPECT_EQ(hash_of(text), hash) << grammar;
}

TEST(Grammar, AbopFigure124) {
    expect_string("iterations: 5\nangle: 25.7\naxiom: F\nF -> F[+F]F[-F]F", 7811, 0xb24a81ac49750fb1);
    expect_string("iterations: 5\nangle: 20\naxiom: F\nF -> F[+F]F[-F][F]", 9373, 0x33dab45f41d12573);
    expect_string("iterations: 4\nangle: 22.5\naxiom: F\nF -> FF-[-F+F+F]+[+F-F-F]", 11116,
                  0x98381a312c938bf1);
    expect_string("iterations: 7\nangle: 20\naxiom: X\nX -> F[+X]F[-X]+X\nF -> FF", 13956,
                  0x17f771b06bad0b4c);
    expect_string("iterations: 7\nangle: 25.7\naxiom: X\nX -> F[+X][-X]FX\nF -> FF", 12863,
                  0x9b2d0c9ec6ba2c19);
    expect_string("iterations: 5\nangle: 22.5\naxiom: X\nX -> F-[[X]+X]+F[+FX]-X\nF -> FF", 6263,
                  0xe4356ae1d750725a);
}

// Hogeweg and Hesper's signals that run up a branching structure: successors of 000, 001, ... 111.
std::string hogeweg(const std::vector<std::string>& successors, int iterations) {
    std::string text = "#ignore: + - F\niterations: " + std::to_string(iterations) + "\naxiom: F1F1F1\n";
    for (int i = 0; i < 8; i++) {
        const auto bit = [&](int shift) { return static_cast<char>('0' + (i >> shift & 1)); };
        text += std::string() + bit(2) + " < " + bit(1) + " > " + bit(0) + " -> " +
                successors[static_cast<size_t>(i)] + "\n";
    }
    return text + "* < + > * -> -\n* < - > * -> +\n";
}

TEST(Grammar, AbopFigure131) {
    expect_string(hogeweg({"0", "1[+F1F1]", "1", "1", "0", "1F1", "0", "0"}, 30), 6910, 0xbdfa71448c60daaa);
    expect_string(hogeweg({"1", "1[-F1F1]", "1", "1", "0", "1F1", "1", "0"}, 30), 19199, 0x55fe98c79afc5440);
    expect_string(hogeweg({"0", "1", "0", "1[+F1F1]", "0", "1F1", "0", "0"}, 26), 2926, 0x9075c91e61b00b47);
    expect_string(hogeweg({"1", "0", "0", "1F1", "1", "1[+F1F1]", "1", "0"}, 24), 7145, 0x37b8fa45028fca12);
    expect_string(hogeweg({"0", "1[-F1F1]", "1", "1", "0", "1F1", "1", "0"}, 26), 2428, 0x5752b7cfae70727c);
}

TEST(Grammar, AbopFigure26) {
    const std::string grammar = R"(
        #define r1 0.9  # contraction ratio for the trunk
        #define r2 0.6
        #define a0 45
        #define a2 45
        #define d 137.5
        #define wr 0.707
        iterations: 10
        axiom: A(1,10)
        p1: A(l,w) : * -> !(w)F(l)[&(a0)B(l*r2,w*wr)]/(d)A(l*r1,w*wr)
        p2: B(l,w) : * -> !(w)F(l)[-(a2)$C(l*r2,w*wr)]C(l*r1,w*wr)
        p3: C(l,w) : * -> !(w)F(l)[+(a2)$B(l*r2,w*wr)]B(l*r1,w*wr)
    )";
    expect_string(grammar, 52045, 0x233c6c040032b28c);
    const Tree tree = read_lstring(rewritten(grammar));
    EXPECT_EQ(tree.size(), 1024u);
    EXPECT_EQ(tree.check(), std::nullopt);
}

TEST(Grammar, AbopFigure27) {
    expect_string(R"(
        #define r1 0.9
        #define r2 0.7
        #define a1 10
        #define a2 60
        #define wr 0.707
        iterations: 10
        axiom: A(1,10)
        p1: A(l,w) : * -> !(w)F(l)[&(a1)B(l*r1,w*wr)]/(180)[&(a2)B(l*r2,w*wr)]
        p2: B(l,w) : * -> !(w)F(l)[+(a1)$B(l*r1,w*wr)][-(a2)$B(l*r2,w*wr)]
    )",
                  59648, 0x90311e19f8267c7b);
}

TEST(Grammar, AbopFigure28) {
    const std::string grammar = R"(
        #define d1 94.74
        #define d2 132.63
        #define a 18.95
        #define lr 1.109
        #define vr 1.732
        tropism: 0, -1, 0, 0.22
        iterations: 6
        axiom: !(1)F(200)/(45)A
        p1: A : * -> !(vr)F(50)[&(a)F(50)A]/(d1)
                     [&(a)F(50)A]/(d2)[&(a)F(50)A]
        p2: F(l) : * -> F(l*lr)
        p3: !(w) : * -> !(w*vr)
    )";
    expect_string(grammar, 30041, 0xb41229aa8341b89e);
    EXPECT_EQ(Grammar::parse(grammar).turtle.elasticity, 0.22);
}

TEST(Grammar, AbopFigure127) {
    const std::string grammar =
        "iterations: 5\nangle: 30\naxiom: F\n"
        "F -> F[+F]F[-F]F : 0.33\nF -> F[+F]F : 0.33\nF -> F[-F]F : 0.34\n";
    EXPECT_EQ(rewritten(grammar, -1, 7), rewritten(grammar, -1, 7));
    EXPECT_NE(rewritten(grammar, -1, 7), rewritten(grammar, -1, 8));
    // One step of many F: each rule as often as its weight says, within four standard deviations.
    const int count = 30000;
    const std::string many = "axiom: " + std::string(count, 'F') + grammar.substr(grammar.find("\nF ->"));
    std::map<std::string, int> seen;
    const std::string text = rewritten(many, 1);
    for (size_t at = 0; at < text.size();) {
        const std::string_view rest = std::string_view(text).substr(at);
        std::string drawn;
        for (const char* rule : {"F[+F]F[-F]F", "F[+F]F", "F[-F]F"})
            if (drawn.empty() && rest.starts_with(rule)) drawn = rule;
        ASSERT_FALSE(drawn.empty()) << rest.substr(0, 20);
        seen[drawn]++;
        at += drawn.size();
    }
    EXPECT_NEAR(seen["F[+F]F[-F]F"], 0.33 * count, 4 * std::sqrt(0.33 * 0.67 * count));
    EXPECT_NEAR(seen["F[+F]F"], 0.33 * count, 4 * std::sqrt(0.33 * 0.67 * count));
    EXPECT_NEAR(seen["F[-F]F"], 0.34 * count, 4 * std::sqrt(0.34 * 0.66 * count));
}

// ABOP 1.10.1: a parametric word and its first steps, as the book prints them.
TEST(Grammar, AbopParametricDerivation) {
    const std::string grammar = R"(
        axiom: B(2) A(4,4)
        p1: A(x,y) : y <= 3 -> A(x*2, x+y)
        p2: A(x,y) : y > 3 -> B(x) A(x/y, 0)
        p3: B(x) : x < 1 -> C
        p4: B(x) : x >= 1 -> B(x-1)
    )";
    EXPECT_EQ(rewritten(grammar, 0), "B(2)A(4,4)");
    EXPECT_EQ(rewritten(grammar, 1), "B(1)B(4)A(1,0)");
    EXPECT_EQ(rewritten(grammar, 2), "B(0)B(3)A(2,1)");
    EXPECT_EQ(rewritten(grammar, 3), "CB(2)A(4,3)");
    EXPECT_EQ(rewritten(grammar, 4), "CB(1)A(8,7)");
}

// ABOP 1.8: a signal that runs up the axis, and one that runs down from the tip.
TEST(Grammar, AbopSignals) {
    const std::string up = "ignore: + -\naxiom: J[+I]I[-I]I[+I]I\nJ < I -> J\n";
    EXPECT_EQ(rewritten(up, 1), "J[+J]J[-I]I[+I]I");
    EXPECT_EQ(rewritten(up, 2), "J[+J]J[-J]J[+I]I");
    EXPECT_EQ(rewritten(up, 3), "J[+J]J[-J]J[+J]J");
    const std::string down = "ignore: + -\naxiom: I[+I]I[-I]I[+I]J\nI > J -> J\n";
    EXPECT_EQ(rewritten(down, 1), "I[+I]I[-I]J[+I]J");
    EXPECT_EQ(rewritten(down, 3), "J[+I]J[-I]J[+I]J");
}

TEST(Grammar, ContextsSeeThroughBranches) {
    // ABOP 1.8: BC < S > G[H]M matches ABC[DE][SG[HI[JK]L]MNO].
    EXPECT_EQ(rewritten("axiom: ABC[DE][SG[HI[JK]L]MNO]\nBC < S > G[H]M -> X"), "ABC[DE][XG[HI[JK]L]MNO]");
    EXPECT_EQ(rewritten("axiom: ABC[DE][SG[HI[JK]L]MNO]\nBC < S > G[I]M -> X"), "ABC[DE][SG[HI[JK]L]MNO]");
    EXPECT_EQ(rewritten("axiom: S[A][B][C]D\nS > [C]D -> X"), "X[A][B][C]D");
    EXPECT_EQ(rewritten("axiom: S[A][B][C]D\nS > [C][A] -> X"), "S[A][B][C]D");
    EXPECT_EQ(rewritten("axiom: S[A[K]B]D\nS > [A[K]B]D -> X"), "X[A[K]B]D");
    // The end of a branch is the end of a context.
    EXPECT_EQ(rewritten("axiom: S[A]B\nA > B -> X"), "S[A]B");
    EXPECT_EQ(rewritten("axiom: S[A]B\nA < B -> X"), "S[A]B");
    EXPECT_EQ(rewritten("axiom: S[A]B\nS < B -> X"), "S[A]X");
    // Contexts carry numbers; as many as are named.
    EXPECT_EQ(rewritten("axiom: A(1)B(2)C(3)\nA(x) < B(y) > C(z) : x < z -> B(x+10*y+100*z)"),
              "A(1)B(321)C(3)");
    EXPECT_EQ(rewritten("axiom: A(1)B\nA < B -> X"), "A(1)B");
}

TEST(Grammar, RulesWithAContextComeFirst) {
    EXPECT_EQ(rewritten("axiom: AB\nB -> C\nA < B -> D"), "AD");
    EXPECT_EQ(rewritten("axiom: B\nB -> C\nB -> D"), "C");
    EXPECT_EQ(rewritten("axiom: BBBB\nB -> C : 0\nB -> D : 2"), "DDDD");
    EXPECT_EQ(rewritten("axiom: B\nB -> C : 0"), "B");
}

TEST(Grammar, ACutDropsTheRestOfItsBranch) {
    EXPECT_EQ(rewritten("axiom: F[A F[F]F]F\nA -> %", 1), "F[%F[F]F]F");
    EXPECT_EQ(rewritten("axiom: F[A F[F]F]F\nA -> %", 2), "F[]F");
}

TEST(Grammar, Expressions) {
    const auto value = [](const std::string& expression) {
        return rewritten("k = 3\naxiom: A(" + expression + ")", 0);
    };
    EXPECT_EQ(value("1+2*3"), "A(7)");
    EXPECT_EQ(value("(1+2)*k"), "A(9)");
    EXPECT_EQ(value("2^3^2"), "A(512)");
    EXPECT_EQ(value("-2^2"), "A(-4)");
    EXPECT_EQ(value("7 % 4 - 1"), "A(2)");
    EXPECT_EQ(value("10-4-3"), "A(3)");
    EXPECT_EQ(value("2/4/2"), "A(0.25)");
    EXPECT_EQ(value("1<2 && 2<=2 & !(3>4) || 0"), "A(1)");
    EXPECT_EQ(value("1=2 | 1!=1"), "A(0)");
    EXPECT_EQ(value("round(100*sin(30))"), "A(50)");
    EXPECT_EQ(value("min(3, 2) + max(1, 4) + abs(-1) + floor(1.9) + ceil(0.1) + sign(-3)"), "A(8)");
    EXPECT_EQ(value("round(atan2(1, -1))"), "A(135)");
    EXPECT_EQ(value("exp(log(5)) > 4.999"), "A(1)");
    EXPECT_EQ(value("pow(2, 0.5) == sqrt(2)"), "A(1)");
    EXPECT_EQ(value("uniform(2, 3) >= 2"), "A(1)");
    EXPECT_EQ(value("1e3,\n 2"), "A(1000,2)");
    // Random numbers are those of the seed.
    const std::string random = "axiom: A(uniform(0,1), normal(0,1))";
    EXPECT_EQ(rewritten(random, 0, 4), rewritten(random, 0, 4));
    EXPECT_NE(rewritten(random, 0, 4), rewritten(random, 0, 5));
}

TEST(Grammar, SettingsReachTheTurtle) {
    const Grammar grammar = Grammar::parse(
        "angle = 30 # degrees\nstep: 0.5\nradius: 0.02\nthinning: 0.8\niterations: 4\nseed: 9\nleaf: L "
        "K\nleaf_preset: oak\n"
        "tropism: 0, -1, 0, 0.1\naxiom: F");
    EXPECT_EQ(grammar.turtle.angle, 30.0);
    EXPECT_EQ(grammar.turtle.step, 0.5);
    EXPECT_EQ(grammar.turtle.radius, 0.02);
    EXPECT_EQ(grammar.turtle.thinning, 0.8);
    EXPECT_EQ(grammar.turtle.leaf_symbols, "LK");
    EXPECT_EQ(grammar.leaf_preset, "oak");
    EXPECT_EQ(grammar.turtle.tropism, DVec3(0, -1, 0));
    EXPECT_EQ(grammar.turtle.elasticity, 0.1);
    EXPECT_EQ(grammar.iterations, 4);
    EXPECT_EQ(grammar.seed, 9u);
}

TEST(Grammar, StatementsRunOverLines) {
    EXPECT_EQ(rewritten("axiom: A(1,\n2)[\nB]\n  C\n  # why\n\n  D\nA(x,y) -> A(x+\ny)", 1), "A(3)[B]CD");
    EXPECT_EQ(rewritten("\taxiom: A\n\t\tB\n\tA -> C", 1), "CB");
    EXPECT_EQ(sentence_of("axiom: A\nB"),
              "The grammar, line 2, column 2: here the arrow -> of a rule should stand.");
}

TEST(Grammar, IsToldFromAString) {
    EXPECT_TRUE(is_grammar("# a tree\n\n  angle: 3\n  axiom : F"));
    EXPECT_TRUE(is_grammar("axiom=F"));
    EXPECT_FALSE(is_grammar("# axiom: F\nF(1)[+F(2)]"));
    EXPECT_FALSE(is_grammar(""));
}

TEST(Grammar, ErrorsNameThePlace) {
    EXPECT_EQ(
        sentence_of(""),
        "The grammar, line 1, column 1: there is no axiom; write 'axiom: ' and the string to begin with.");
    EXPECT_EQ(sentence_of("axiom: F\nF -> F[+F"), "The grammar, line 2, column 7: this [ is never closed.");
    EXPECT_EQ(sentence_of("axiom: F\nF -> F]"), "The grammar, line 2, column 7: this ] closes no [.");
    EXPECT_EQ(sentence_of("axiom: F\nF F"),
              "The grammar, line 2, column 1: a rule begins with one symbol, and maybe its context: A < B > "
              "C -> D.");
    EXPECT_EQ(sentence_of("axiom: F\nF : x > 1 -> F"),
              "The grammar, line 2, column 5: nothing is called 'x' here.");
    EXPECT_EQ(sentence_of("axiom: F\nF(x) : x > -> F"),
              "The grammar, line 2, column 12: here a number, a name or a ( should stand.");
    EXPECT_EQ(sentence_of("axiom: F(1"), "The grammar, line 1, column 9: this ( is never closed.");
    EXPECT_EQ(sentence_of("axiom: F((1)"), "The grammar, line 1, column 9: this ( is never closed.");
    EXPECT_EQ(sentence_of("axiom: F(min(1))"),
              "The grammar, line 1, column 15: min() takes 2 numbers with a comma between them.");
    EXPECT_EQ(sentence_of("axiom: F(foo(1))"), "The grammar, line 1, column 10: there is no function 'foo'.");
    EXPECT_EQ(sentence_of("axiom: F\naxiom: G"), "The grammar, line 2, column 1: there is an axiom already.");
    EXPECT_EQ(
        sentence_of("angel: 30\naxiom: F"),
        "The grammar, line 1, column 1: there is no setting 'angel'; there are axiom, angle, step, radius, "
        "thinning, iterations, seed, leaf, leaf_preset, ignore and tropism.");
    EXPECT_EQ(sentence_of("radius: -1\naxiom: F"),
              "The grammar, line 1, column 9: the radius must be positive, in metres.");
    EXPECT_EQ(sentence_of("x = 1/0\naxiom: F"), "The grammar, line 1, column 5: this is no finite number.");
    EXPECT_EQ(sentence_of("axiom: F\nF(x,x) -> F"),
              "The grammar, line 2, column 5: 'x' is named twice in this rule.");
    EXPECT_EQ(sentence_of("axiom: F = G"),
              "The grammar, line 1, column 10: here the line should end; what is '='?");
    EXPECT_EQ(sentence_of("axiom: F\n[A < B -> C"), "The grammar, line 2, column 1: this [ is never closed.");
    EXPECT_EQ(sentence_of("axiom: F\nF ->"),
              "The grammar, line 2, column 5: here symbols should stand, or * for none.");
    EXPECT_EQ(sentence_of("axiom: F\nF > G : -> "),
              "The grammar, line 2, column 9: here a number, a name or a ( should stand.");
    EXPECT_EQ(sentence_of("axiom: F(" + std::string(200, '(')),
              "The grammar, line 1, column 110: this expression is too deep.");
    EXPECT_EQ(sentence_of([] { grammar_preset("cactus"); }).substr(0, 37),
              "There is no grammar 'cactus'; there a");
}

TEST(Grammar, ExplosionsAreStopped) {
    const Grammar grammar = Grammar::parse("iterations: 1000\naxiom: F\nF -> FF");
    RewriteOptions options;
    options.most_symbols = 1000;
    EXPECT_EQ(sentence_of([&] { rewrite(grammar, options); }),
              "The grammar grows past 1000 symbols (in step 10 of 1000); lower its iterations.");
    options.most_symbols = 1u << 30;
    options.most_bytes = 1 << 20;
    EXPECT_EQ(sentence_of([&] { rewrite(grammar, options); }),
              "The grammar needs more than 1 MB (in step 18 of 1000); lower its iterations.");
    options.most_bytes = size_t{1} << 40;
    options.most_seconds = 0.0;
    EXPECT_EQ(sentence_of([&] { rewrite(grammar, options); }),
              "The grammar takes longer than 0 seconds (in step 9 of 1000); lower its iterations.");
    const Grammar division = Grammar::parse("axiom: A(1)\nA(x) -> A(1/(x-1))");
    EXPECT_EQ(sentence_of([&] { rewrite(division, {}); }),
              "The grammar, the rule in line 2: a parameter of 'A' is no finite number in step 1.");
    const Grammar weight = Grammar::parse("axiom: A\n\nA -> B : -1");
    EXPECT_EQ(sentence_of([&] { rewrite(weight, {}); }),
              "The grammar, the rule in line 3: its weight is negative or no finite number.");
    class Stop : public Progress {
      public:
        bool cancelled() const override { return true; }
    } stop;
    EXPECT_THROW(rewrite(grammar, {}, &stop), Cancelled);
}

TEST(Grammar, PresetsAreTrees) {
    for (const std::string& name : grammar_preset_names()) {
        const Grammar grammar = Grammar::parse(grammar_preset(name));
        RewriteOptions options;
        options.seed = grammar.seed;
        const LStringTree read = read_lstring_with_leaves(rewrite(grammar, options), grammar.turtle);
        EXPECT_EQ(read.tree.check(), std::nullopt) << name;
        EXPECT_GT(read.tree.size(), 500u) << name;
        EXPECT_LT(read.tree.size(), 20000u) << name;
        EXPECT_GT(read.tree.bounds().size().y, 2.0) << name;
        EXPECT_LT(read.tree.bounds().size().y, 30.0) << name;
        EXPECT_GT(read.tree.bounds().min.y, -0.5) << name << " grows into the ground";
    }
}

}  // namespace
}  // namespace treerec
