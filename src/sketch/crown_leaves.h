// How large leaves are in a crown, how many are to stand in it, and on how much wood.
#pragma once

#include "foliage/leaf_rules.h"
#include "sketch/crown_sections.h"
#include "sketch/species.h"
#include "tree/tree.h"

namespace treerec {

// All heights are the tree's, metres.

// How the species' twigs are scaled for a tree of that height: a young tree has shorter shoots.
double twig_growth(const SketchSpecies& species, double height);
// By how much leaf_rules.h shrinks lengths on small trees, 0..1.
double shrunk(double height);
// Of a card, metres; single leaves keep their size.
double leaf_length(const LeafRules& rules, double height);
// Metres by which leaves stand out from wood: so far twigs stay from the crown's surface.
double leaf_margin(const CrownSections& crown, const LeafRules& rules, double height);
// The share of the species' twigs that is near enough to a tip to bear leaves, 0..1.
double bearing_share(const SketchSpecies& species, double height);
// Metres of the species' twigs that bear as many leaves as are to stand in the crown.
double wanted_wood(const CrownSections& crown, const SketchSpecies& species, double height);

// Has the tree's leaves fill the crown as far as its wood allows: who draws an outline sees it full, where a
// grown crown of the species lets more sky through.
void fill_with_leaves(Tree& tree);

}  // namespace treerec
