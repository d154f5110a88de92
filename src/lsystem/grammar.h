// Parametric, stochastic, context-sensitive L-systems (ABOP, 1.3 to 1.10): a text of settings, constants,
// an axiom and rules, rewritten step by step into an L-string.
//
//   angle: 22.5           settings: angle, step, radius, thinning, iterations, seed, leaf, leaf_preset,
//                         ignore, tropism
//   r = 0.7               a constant
//   axiom: A(1, 0.1)
//   A(l, w) : l > 0.1 -> !(w) F(l) [+A(l*r, w*r)] A(l*0.9, w*0.8)
//   X < B > Y -> C        X stands to the left, Y to the right; both may be several symbols, or * for
//   anything F -> F[+F]F : 0.3     of several rules that apply, one is drawn by these weights A -> * A
//   vanishes
//
// A symbol is one character. A rule holds for a symbol with as many parameters as it names. Of the rules that
// apply, those with a context come first, then the one that was written first; what no rule applies to stays.
// A statement ends with its line, but not inside brackets, nor where the next line is indented more deeply; #
// begins a comment, but for #define and #ignore,
// which mean what they mean in ABOP's listings.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "lsystem/expression.h"
#include "lsystem/lstring.h"
#include "progress.h"

namespace treerec {

struct GrammarModule {
    char symbol = 0;
    std::vector<Expression> parameters;
};

// A symbol with formal parameters: variables[first] and so on.
struct GrammarPattern {
    char symbol = 0;
    int first = 0;
    int count = 0;
};

struct GrammarRule {
    std::vector<GrammarPattern> left;  // from left to right
    std::vector<GrammarPattern> right;
    GrammarPattern strict;
    Expression condition;  // empty: always
    Expression weight;     // empty: certain
    std::vector<GrammarModule> successor;
    int variables = 0;
    int line = 0;
};

struct Grammar {
    // Throws Error with line and column.
    static Grammar parse(std::string_view text);

    std::vector<GrammarModule> axiom;
    std::vector<GrammarRule> rules;  // in the order in which they are tried
    std::array<bool, 128> ignored{};
    int iterations = 1;
    uint64_t seed = 1;
    std::string leaf_preset;  // the leaf rules that suit the tree, by name; empty: any
    LStringOptions turtle;    // its angle, step, radius, ... as the grammar sets them
};

struct RewriteOptions {
    int iterations = -1;  // -1: the grammar's
    uint64_t seed = 1;
    // Where it is stopped with an Error instead of filling the machine.
    size_t most_symbols = 5'000'000;
    size_t most_bytes = size_t{512} << 20;
    double most_seconds = 30.0;
};

// The string after so many steps. The same grammar and seed give the same string. Throws Error where a limit
// is passed or a parameter becomes infinite, and Cancelled.
std::string rewrite(const Grammar& grammar, const RewriteOptions& options, Progress* progress = nullptr);

// Whether the text is a grammar (and not an L-string): one of its lines sets the axiom.
bool is_grammar(std::string_view text);

// Grammars that ship with the library: trees in metres. Throws Error for an unknown name, listing them.
std::string grammar_preset(std::string_view name);
std::vector<std::string> grammar_preset_names();

}  // namespace treerec
