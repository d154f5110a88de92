// Kinds of trees that a sketch can become: each with its twigs (papers/003, 4.1 and table 1).
#pragma once

#include <string>
#include <vector>

#include "tree/tree.h"

namespace treerec {

struct SpeciesTwig {
    std::string name;     // of the twig library: "maple_long"
    Tree scion;           // edit/scion.h, metres
    double length = 0.0;  // metres along its longest path
    double radius = 0.0;  // metres at its root
};

// How twigs follow one another along a branch (papers/003, 4.1).
enum class TwigArrangement : uint8_t {
    kAlternate,  // one at a place, as the ginkgo's
    kOpposite,   // two, as the maple's
    kClustered,  // several from one place, as the magnolia's
};

struct SketchSpecies {
    std::string name;      // also its leaf preset, and that of bark and leaf pictures: "maple"
    std::string title;     // "Maple"
    double height = 10.0;  // metres, of a grown tree
    TwigArrangement arrangement = TwigArrangement::kAlternate;
    std::vector<SpeciesTwig> twigs;  // the shortest first
};

// "ginkgo", "magnolia", "maple", "poplar".
std::vector<std::string> sketch_species_names();
// Throws Error for another name, listing these. What it returns stays.
const SketchSpecies& sketch_species(const std::string& name);

}  // namespace treerec
