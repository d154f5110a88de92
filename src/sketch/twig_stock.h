// Twigs of one's own that a sketch is made with, in place of a species': from a library, or from a tree with
// its angles and taper.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sketch/species.h"
#include "tree/tree.h"

namespace treerec {

struct TwigStock {
    // A twig as it is saved, and what that means.
    struct Twig {
        std::string string;  // lsystem/lstring.h
        Tree scion;
    };
    std::string title;    // whose twigs these are, for a list
    double height = 0.0;  // metres of the tree that they are from; 0: as tall as the species usually is
    TwigArrangement arrangement = TwigArrangement::kAlternate;
    std::vector<Twig> twigs;     // the shortest first
    std::vector<double> angles;  // SketchSpecies::angles; empty: a species'
    double internode = 0.0;      // SketchSpecies::internode
    std::optional<WoodTaper> taper;
};

// From L-strings, any number up to 200 and in any order, as a library holds them. Throws Error, with a
// sentence that tells which, where one is no branch, or none that a sketch can be made with.
TwigStock stock_of_twigs(const std::vector<std::string>& strings, const std::string& title);

// From a tree, as one that was scanned: up to four well-shaped branches of each of three sizes, and, as
// BranchStatistics measures them, the angles and internodes of its twigs and how thick its trunk and branches
// are. Twigs are as long as those of sketch_species() on a tree of that height, as far as the tree has such.
// Linear in its nodes, but for sorting. Throws Error where it has no side branches.
TwigStock stock_of_tree(const Tree& tree, const std::string& title);

// What fills a crown: these twigs, in three sizes, with leaves and bark of a preset (leaf_preset()). Throws
// Error for an unknown one.
SketchSpecies species_of(const TwigStock& stock, const std::string& preset);

// One line of JSON, UTF-8, and back to the last bit:
//   {"title": "...", "height": m, "arrangement": "alternate", "angles": [degrees], "internode": m,
//    "taper": {"height": m, "base": m ("foot" in older ones), "trunk": [11 shares], "intercept", "slope",
//    "profile": [11 shares], "least": m}, "twigs": ["L-string", ...]}
// All but twigs may be missing. Reading throws Error, of `who`.
std::string twig_stock_json(const TwigStock& stock);
TwigStock parse_twig_stock(std::string_view json, const std::string& who = "The twigs");

}  // namespace treerec
