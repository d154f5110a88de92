// Where a twig stands, and what the crown leaves of it.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "sketch/crown_sections.h"
#include "tree/tree.h"

namespace treerec {

// A twig of the species at a place on a branch.
struct TwigPlace {
    size_t axis = 0;     // place among the filled branches
    double along = 0.0;  // metres from the branch's tail
    DVec3 way{0.0};      // unit: where the twig goes
    size_t twig = 0;     // place in SketchSpecies::twigs
    double scale = 1.0;
    double spin = 0.0;  // radians about its own direction
};

// By node id of the scion: where it comes to lie with its root on the joint, in metres. Nothing for what
// leaves the crown by `margin` (CrownSections::contains()), and all that grows on it; without a margin all
// stays.
std::vector<std::optional<DVec3>> kept_places(const Tree& scion, const TwigPlace& place, const DVec3& joint,
                                              const CrownSections& crown, std::optional<double> margin);

// Metres of its wood that stay.
double kept_wood(const Tree& scion, const TwigPlace& place, const DVec3& joint, const CrownSections& crown,
                 double margin);

}  // namespace treerec
