// Kinds of trees that a sketch can become: each with its twigs (Ma and Liu 2020, 4.1 and table 1).
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "foliage/leaf_rules.h"
#include "sketch/branch_statistics.h"
#include "tree/tree.h"

namespace treerec {

struct SpeciesTwig {
    std::string name;     // of the twig library: "maple_long"
    Tree scion;           // edit/graft/scion.h, metres
    double length = 0.0;  // metres along its longest path
    double radius = 0.0;  // metres at its root
    int size = 0;         // those of one size stand for one another
};

// How twigs follow one another along a branch (Ma and Liu 2020, 4.1).
enum class TwigArrangement : uint8_t {
    kAlternate,  // one at a place, as the ginkgo's
    kOpposite,   // two, as the maple's
    kClustered,  // several from one place, as the magnolia's
};

// How thick wood is, as it was measured on a tree.
struct WoodTaper {
    double height = 0.0;             // metres, of that tree
    double stem_base = 0.0;          // metres: the trunk's radius at its base
    std::array<double, 11> trunk{};  // over the base's, at 0, 0.1 .. 1 of its length
    RadiusLaw branches;

    // The same of a tree of the same shape that is so high.
    WoodTaper at_height(double metres) const;
    // At each point of a trunk that is `stem_base` thick there; at least `least`. Metres.
    std::vector<double> trunk_radii(const std::vector<DVec3>& points, double base, double least) const;
};

struct SketchSpecies {
    std::string name;      // also its leaf preset, and that of bark and leaf pictures: "maple"
    std::string title;     // "Maple"
    double height = 10.0;  // metres, of a grown tree
    TwigArrangement arrangement = TwigArrangement::kAlternate;
    std::vector<SpeciesTwig> twigs;  // the shortest first
    LeafRules leaves;
    // Degrees off the branch, ascending and in equal shares of the twigs; by Ma and Liu 2020, 4.2, step 2.
    std::vector<double> angles{30.0, 70.0};
    // Whether angles are those off the branch where the twig stands, and not off its whole course.
    bool own = false;
    double internode = 0.0;          // metres from twig to twig at least; 0: as the crown has room
    std::optional<WoodTaper> taper;  // nothing: equation 2

    // The angle that so large a share (0..1) of the twigs is below. Degrees.
    double angle_at(double share) const;
};

// "ginkgo", "magnolia", "maple", "poplar".
std::vector<std::string> sketch_species_names();
// Throws Error for another name, listing these. What it returns stays.
const SketchSpecies& sketch_species(const std::string& name);

}  // namespace treerec
