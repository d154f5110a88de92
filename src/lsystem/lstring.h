// Trees as strings of turtle commands, and back.
//
// The symbols are those of The Algorithmic Beauty of Plants (ABOP, Prusinkiewicz and Lindenmayer 1990, table
// 1.1 and 2.3), angles in degrees, relative to the turtle's own frame, lengths and radii in metres:
//
//   F(length)           wood; its end becomes a node          f(length)  the same, but a guess (kGuessFlag)
//   +(a) -(a)           turn left, right                      &(a) ^(a)  pitch down, up
//   \(a) /(a)           roll left, right                      |          turn around
//   $                   roll until left is level              [ ]        a branch
//   !(radius)           of what follows; before any wood also the root's own
//   ~(size) ~x(size)    a leaf (of kind x), pointing along the heading
//   {...}               a leaf outlined by its moves (ABOP 4.1)     %    cuts off the rest of its branch
//   @(flags)            1 trunk + 2 measured radius, of what follows; other programs skip it
//
// Without a parameter F, f, +, ... take the options' values and ! thins by the options' ratio. Other letters
// and digits are skipped, as a turtle skips the symbols of a grammar. Blanks are skipped, # begins a comment.
// A first line such as "# L-string; dialect paper angle 30" is a heading: it says how the rest is read.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "progress.h"
#include "tree/tree.h"

namespace treerec {

enum class LStringDialect {
    kTurtle,  // as above
    // Chen 2025, algorithms 4 and 6: + and - set the yaw, & and ^ the pitch, both absolute (+ is yaw
    // atan2(z, x), & pitch above the ground); no radii, no rolls. A number may follow a symbol without
    // brackets.
    kPaper,
};

// "turtle" or "paper". Throws Error for another name.
LStringDialect parse_lstring_dialect(std::string_view name);

struct LStringOptions {
    LStringDialect dialect = LStringDialect::kTurtle;
    // Reading: the string is of that dialect, whatever its heading says. Without that, and without a heading,
    // a turtle refuses numbers that stand as in the paper, +45: it would skip them as other symbols.
    bool dialect_is_told = false;
    // Reading: what a heading says goes before the numbers below (with_heading()).
    bool heeds_heading = true;

    // Reading: what a symbol without a parameter means.
    double angle = 25.0;    // degrees
    double step = 0.1;      // metres
    double radius = 0.01;   // metres, until a ! says otherwise
    double thinning = 0.7;  // of a bare !
    double taper = 0.8;     // in the paper's dialect, which has no radii: of each node (algorithm 8)
    // Letters that are leaves, as if a ~ stood before them: "L".
    std::string leaf_symbols;
    DVec3 skyward{0.0, 1.0, 0.0};  // against gravity, in the string's own axes; for $
    DVec3 tropism{0.0};            // ABOP 2.3: what each F bends the heading towards
    double elasticity = 0.0;       // how much
    // Seeded variation of every F (Chen 2025, algorithm 6): its direction by up to angle_spread degrees in
    // yaw and in pitch, its length by up to the share length_spread.
    double angle_spread = 0.0;
    double length_spread = 0.0;
    uint64_t seed = 1;
    size_t most_nodes = size_t{1} << 24;

    // Writing: how far a node read back may lie off, relative to the length of its own segment, and a radius
    // relative to itself. Numbers are written as short as this allows. At least 1e-12.
    double accuracy = 1e-5;
    double radius_accuracy = 1e-4;
    bool flags = true;  // write trunk and measured flags
};

// heading: from the stalk to the tip. size: the parameter, metres; 0 where none was given. For an outline the
// distance from its start to its farthest point.
struct LStringLeaf {
    NodeId node = kNoNode;  // the node at or below the leaf
    DVec3 position{0.0};
    DVec3 heading{0.0};
    DVec3 up{0.0};
    double size = 0.0;
    char kind = 0;  // the letter behind ~, the leaf symbol, '{' for an outline; 0 for a plain ~
};

struct LStringTree {
    Tree tree;  // root at the origin, ids depth-first
    std::vector<LStringLeaf> leaves;
};

// The options with what the text's heading says in place of theirs, but for a dialect that is told; the same
// where there is no heading. Unknown words of it are skipped. who: begins a sentence about it, "The
// L-string". Throws Error.
LStringOptions with_heading(std::string_view text, const LStringOptions& options,
                            const std::string& who = "The L-string");
// Whether the text begins with a heading.
bool has_heading(std::string_view text);
// What a heading says of the options where they are not as usual: " dialect paper angle 30".
std::string heading_words(const LStringOptions& options);
// The line itself, or nothing where all is as usual.
std::string heading(const LStringOptions& options);

// The tree that the string draws: its root at the origin, its axis along +Y, +Z its up. A continuation
// without brackets is the first child of its node, branches in brackets follow in their order. Throws Error
// with line and column for what is no such string, and Cancelled.
Tree read_lstring(std::string_view text, const LStringOptions& options = {},
                  const Progress* progress = nullptr);
LStringTree read_lstring_with_leaves(std::string_view text, const LStringOptions& options = {},
                                     const Progress* progress = nullptr);

// The string of `from` and all above it; the node itself becomes the root, the tree's axes the string's.
// Errors do not add up along a branch: each segment is aimed from where the reader's turtle will stand.
// Throws Error where there is no such node.
std::string write_lstring(const Tree& tree, NodeId from, const LStringOptions& options = {},
                          const Progress* progress = nullptr);

// Throws Error for a tree without wood: nothing was drawn, or without length. who: "The L-string".
void require_wood(const Tree& tree, const std::string& who);

// "line 3, column 7", both from 1, of the byte at `offset`.
std::string place_in_text(std::string_view text, size_t offset);

}  // namespace treerec
