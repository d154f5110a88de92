// Leaf rules as text: what an edit says of some wood, and what a tree keeps of it (Tree::leaf_rules()).
//
//     oak                          the leaves of a preset
//     maple leaf_size=0.2 curl=40  of a preset, with changes
//     droop=60                     the tree's own, with changes, whatever its own are
//     oak sprig=F[+F]F[-F]F        a string of turtle commands at each place where a leaf would stand
//     default                      the tree's own
//
// The names are those of LeafRules, but for `internode`, which counts from node to node, however many leaves
// one bears; `whorl_size` and `petiole_length`; `sprig` and its `sprig_dialect`, turtle or paper; and `look`,
// the preset whose pictures the leaves show. How far leaves follow a scan is the tree's affair: a preset
// follows it no further than the tree's own do.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "foliage/leaf_rules.h"
#include "lsystem/lstring.h"
#include "tree/tree.h"

namespace treerec {

// What leaves some wood of a tree bears.
struct LeafKind {
    std::string text;  // of the rule; empty for the tree's own
    // The preset that says what they look like; empty: as the tree's own do.
    std::string look;
    LeafRules rules;
};

// One way to write each rule: its words in order, single blanks, numbers as short as they can be; empty for
// "default". Throws Error for what is no rule, saying which word is wrong and what would be right.
std::string plain_leaf_rule(std::string_view text);

// Throws Error as plain_leaf_rule() does.
LeafKind make_leaf_kind(std::string_view text, const LeafRules& own);

// The tree's own kind of leaves and those of Tree::leaf_rules(), each in its number's place. Throws Error
// where the tree names one that is none.
std::vector<LeafKind> leaf_kinds(const Tree& tree, const LeafRules& own);

// The twig that a string of turtle commands draws, to be drawn at every leaf's place; a turn without a number
// is 45 degrees. dialect: whatever its first line says; nothing: as that says, or a turtle's. Throws Error
// for what is no such string, or draws no wood.
std::shared_ptr<const LeafSprig> read_sprig(std::string_view string,
                                            std::optional<LStringDialect> dialect = std::nullopt);

}  // namespace treerec
